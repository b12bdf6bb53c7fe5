"""Recursive-descent parser: text to a tree of consistent dimensions, with a whitelist of names.

::

    sum      = product { ("+" | "-") product }
    product  = signed { ("*" | "/") signed }
    signed   = { "+" | "-" } power
    power    = atom [ ("^" | "**") signed ]
    atom     = number [ unit ] | variable | function "(" sum { "," sum } ")" | "(" sum ")"

A unit is written as in the case file, ``W/(m^2 K)``, and is matched greedily: it ends before a
variable, a function or a number. A quantity with a compound unit after a ``/`` needs parentheses.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from .tokens import Dimension, Token, fault, tokens, unit_end
from .tree import EXTREMES, FUNCTIONS, KNOWN, Expression, Node, evaluate, variables

Units = Callable[[str, float], tuple[float, Dimension]]
"""Map from the text of a unit, and the number before it, to SI factor and dimension.

It raises `ValueError` if the unit is invalid.
"""

_DEEPEST = 30
"""Largest nesting depth of parentheses, signs and powers."""
_LARGEST_EXPONENT = 100.0


def parse_expression(
    text: str, known: Mapping[str, Dimension], unit: str, units: Units
) -> Expression:
    """Parse an expression and check the units in it.

    Parameters
    ----------
    text : str
    known : mapping of str to Dimension
        Variables that may occur.
    unit : str
        Unit of the value; empty for a dimensionless number.
    units : callable
        Map from the text of a unit, and the number before it, to its SI factor and dimension.

    Raises
    ------
    ValueError
        One-line message with the position of the fault in the text.
    """
    found = _ExpressionParser(text, known, units).parse()
    dimension = units(unit, 1.0)[1] if unit else Dimension()
    if not found.dimension.same(dimension):
        needed = unit or "a dimensionless number"
        raise fault(found.start, f"the value has the unit {found.dimension}; needs {needed}")
    return Expression(text, found.node, variables(found.node))


class _Parsed(NamedTuple):
    """Parsed part of an expression, with the position of its first character.

    `literal` is ``"plain"`` or ``"compound"`` for a quantity with a unit without parentheses.
    """

    node: Node
    dimension: Dimension
    start: int
    literal: str = ""

    @property
    def constant(self) -> float | None:
        """Value of a constant."""
        return self.node if isinstance(self.node, float) else None


class _ExpressionParser:
    """Parser of one expression, see `parse_expression`."""

    def __init__(self, text: str, variables: Mapping[str, Dimension], units: Units):
        self._text, self._variables, self._units = text, variables, units
        self._tokens = tokens(text)
        self._at = 0
        self._depth = 0

    def parse(self) -> _Parsed:
        """Parse the whole expression."""
        if self._next.kind == "end":
            raise ValueError("is empty; needs an expression")
        result = self._sum()
        if self._next.kind != "end":
            raise fault(self._next.start, self._out_of_place())
        return result

    @property
    def _next(self) -> Token:
        return self._tokens[self._at]

    def _out_of_place(self) -> str:
        token = self._next
        if token.kind == "end":
            return "the expression ends too early"
        if token.text == ")":
            return "')' closes no parenthesis"
        return f"found {token.text!r}; needs an operator or the end"

    def _accept(self, *signs: str) -> Token | None:
        """Consume and return the next token if it is one of the given signs."""
        token = self._next
        if token.kind != "sign" or token.text not in signs:
            return None
        self._at += 1
        return token

    def _deeper(self, parse: Callable[[], _Parsed]) -> _Parsed:
        """Parse a nested part, with a limit of depth."""
        if self._depth == _DEEPEST:
            raise fault(self._next.start, f"nested too deeply; at most {_DEEPEST} levels")
        self._depth += 1
        result = parse()
        self._depth -= 1
        return result

    def _sum(self) -> _Parsed:
        first = self._product()
        terms, nodes = [first], [first.node]
        while (sign := self._accept("+", "-")) is not None:
            term = self._product()
            if not term.dimension.same(first.dimension):
                raise fault(
                    sign.start,
                    f"{sign.text!r} between the units {first.dimension} and {term.dimension}",
                )
            terms.append(term)
            nodes.append(term.node if sign.text == "+" else ("-", term.node))
        if len(terms) == 1:
            return first
        return self._folded(("+", *nodes), first.dimension, terms, first.start)

    def _product(self) -> _Parsed:
        first = self._signed()
        factors, nodes, dimension = [first], [first.node], first.dimension
        while (sign := self._accept("*", "/")) is not None:
            factor, divides = self._signed(), sign.text == "/"
            if divides and factor.literal == "compound":
                raise fault(
                    factor.start, "'/' before a quantity with a compound unit needs parentheses"
                )
            dimension = dimension.times(factor.dimension, -1.0 if divides else 1.0)
            factors.append(factor)
            nodes.append(("/", factor.node) if divides else factor.node)
        if len(factors) == 1:
            return first
        return self._folded(("*", *nodes), dimension, factors, first.start)

    def _signed(self) -> _Parsed:
        sign = self._accept("+", "-")
        if sign is None:
            return self._power()
        operand = self._deeper(self._signed)
        node = operand.node if sign.text == "+" else ("-", operand.node)
        found = self._folded(node, operand.dimension, [operand], sign.start)
        return found._replace(literal=operand.literal)

    def _power(self) -> _Parsed:
        base = self._atom()
        sign = self._accept("^")
        if sign is None:
            return base
        if base.literal:
            raise fault(sign.start, "a power of a quantity needs parentheses round the quantity")
        exponent = self._deeper(self._signed)
        if not exponent.dimension.none:
            raise fault(
                exponent.start, f"an exponent must be dimensionless, found {exponent.dimension}"
            )
        number = exponent.constant
        if number is not None and abs(number) > _LARGEST_EXPONENT:
            raise fault(exponent.start, f"an exponent is at most {_LARGEST_EXPONENT:g} in size")
        if number is None and not base.dimension.none:
            raise fault(
                base.start,
                f"a variable power must be of something dimensionless, found {base.dimension}",
            )
        dimension = base.dimension.to(number if number is not None else 0.0)
        parts = [base, exponent]
        return self._folded(("^", base.node, exponent.node), dimension, parts, base.start)

    def _atom(self) -> _Parsed:
        token = self._next
        if token.kind == "number":
            return self._quantity()
        if token.kind == "name":
            return self._named()
        if self._accept("(") is not None:
            inner = self._deeper(self._sum)
            self._close(token)
            return _Parsed(inner.node, inner.dimension, token.start)
        if token.kind == "end" or token.text == ")":
            raise fault(token.start, "the expression ends too early; needs a number or a variable")
        raise fault(token.start, f"found {token.text!r}; needs a number or a variable")

    def _close(self, opened: Token) -> None:
        if self._accept(")") is None:
            if self._next.kind == "end":
                raise fault(opened.start, "'(' is not closed")
            raise fault(self._next.start, self._out_of_place())

    def _quantity(self) -> _Parsed:
        """Parse a number and its unit."""
        token = self._next
        number = float(token.text)
        if not np.isfinite(number):
            raise fault(token.start, "a number must be finite")
        self._at += 1
        start, end = self._next.start, unit_end(self._text, token.end, self._variables)
        if end <= start:
            return _Parsed(number, Dimension(), token.start)
        try:
            factor, dimension = self._units(self._text[start:end], number)
        except ValueError as error:
            raise fault(start, str(error)) from None
        if not np.isfinite(number * factor):
            raise fault(token.start, "a number must be finite in SI, too")
        literal = "plain" if self._next.end == end else "compound"
        while self._next.start < end:
            self._at += 1
        return _Parsed(number * factor, dimension, token.start, literal)

    def _named(self) -> _Parsed:
        token = self._next
        self._at += 1
        opened = self._accept("(")
        if opened is not None:
            return self._call(token, opened)
        if token.text in self._variables:
            return _Parsed(token.text, self._variables[token.text], token.start)
        known = ", ".join(self._variables)
        if token.text in KNOWN:
            raise fault(token.start, f"{token.text!r} is a function; its argument is missing")
        raise fault(
            token.start,
            f"{token.text!r} is not a variable; known: {known} (a unit needs a number before it)",
        )

    def _call(self, token: Token, opened: Token) -> _Parsed:
        name = token.text
        if name in self._variables:
            raise fault(token.start, f"{name!r} is a variable, not a function")
        if name not in KNOWN:
            raise fault(token.start, f"{name!r} is not a function; known: {', '.join(KNOWN)}")
        arguments = [self._deeper(self._sum)]
        while self._accept(",") is not None:
            arguments.append(self._deeper(self._sum))
        self._close(opened)
        first, *others = arguments
        if name in EXTREMES and not others:
            raise fault(token.start, f"{name} has at least two arguments")
        if name in FUNCTIONS and others:
            raise fault(token.start, f"{name} has one argument, found {len(arguments)}")
        for other in others:
            if not other.dimension.same(first.dimension):
                raise fault(
                    other.start, f"{name} of the units {first.dimension} and {other.dimension}"
                )
        power = FUNCTIONS[name].power if name in FUNCTIONS else 1.0
        if power is None and not first.dimension.none:
            raise fault(
                first.start,
                f"the argument of {name} must be dimensionless, found {first.dimension}",
            )
        dimension = first.dimension.to(power or 0.0)
        node = (name, *(argument.node for argument in arguments))
        return self._folded(node, dimension, arguments, token.start)

    def _folded(
        self, node: Node, dimension: Dimension, parts: list[_Parsed], start: int
    ) -> _Parsed:
        """Fold a part without variables to a constant, which must be finite."""
        if any(part.constant is None for part in parts):
            return _Parsed(node, dimension, start)
        with np.errstate(all="ignore"):
            value = float(evaluate(node, {}, "")[0])
        if not np.isfinite(value):
            raise fault(start, f"the value of this part is {value:g}: not a finite number")
        return _Parsed(value, dimension, start)
