"""Arithmetic expressions with units in named variables: parser, checked dimensions, derivatives."""

from .parser import parse_expression
from .tokens import Dimension
from .tree import Expression
