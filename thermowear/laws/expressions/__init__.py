"""Arithmetic expressions with units in named variables: parser, checked dimensions, derivatives."""

from .parser import parse_expression
from .region import Region, parse_region
from .tokens import Dimension
from .tree import Expression
