"""Arithmetic expressions with units in named variables: parser, checked dimensions, derivatives."""

from .dimensions import Dimension
from .expression import Expression, parse_expression

__all__ = ["Dimension", "Expression", "parse_expression"]
