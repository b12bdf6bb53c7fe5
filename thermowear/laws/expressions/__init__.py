"""Arithmetic expressions with units in named variables: parser, checked dimensions, derivatives."""

from .parser import Dimension, parse_expression
from .region import Region, parse_region
from .tree import Expression
