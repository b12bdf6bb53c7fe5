"""Arithmetic expressions with units in named variables: parser, checked dimensions, derivatives."""

from .dimensions import Dimension
from .parser import parse_expression
from .tree import Expression
