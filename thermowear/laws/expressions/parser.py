"""Parser of expressions: text to tokens, and these to a tree of consistent dimensions.

Units are in the notation of the case file, ``W/(m^2 K)``::

    unit     = [ [ "1" ] "/" factor | name ] { ( "*" | "/" ) factor | name }
    factor   = name | "(" factor { ( "*" | "/" ) factor | name } ")" [ exponent ]
    name     = a word with an optional exponent, no variable and no function

All repetitions in them are possessive: the time is proportional to the length of the text.

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

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .tree import EXTREMES, FUNCTIONS, KNOWN, Expression, Node, evaluate, variables

LONGEST = 1000
"""Largest number of characters of an expression."""
NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_TOKEN = re.compile(
    rf"(?P<number>{NUMBER})"
    r"|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<sign>\*\*|[-+*/^(),])"
    r"|(?P<space>\s+)",
    re.ASCII,
)
_SIGNED = rf"[-+]?\s*{NUMBER}"
_EXPONENT = rf"(?:\s*(?:\^|\*\*)\s*(?:{_SIGNED}|\(\s*{_SIGNED}\s*(?:/\s*{_SIGNED}\s*)?\)))?+"
_LEVELS = 2
"""Largest nesting depth of parentheses in a unit."""
_POWER = re.compile(r"\s*(?:\^|\*\*)")
_SAME = 1e-9
_SHOWN = 6  # digits of an exponent in messages
_NAME_AT_END = re.compile(r"(?<![\w.])[A-Za-z_]\w*\Z", re.ASCII)


@dataclass(frozen=True)
class Token:
    """Token of an expression.

    Attributes
    ----------
    kind : str
        ``"number"``, ``"name"``, ``"sign"`` or ``"end"``.
    text : str
        Text; both notations of a power become ``"^"``.
    start, end : int
        Positions of the first character and after the last one, from 0.
    """

    kind: str
    text: str
    start: int
    end: int


def fault(position: int, text: str) -> ValueError:
    """Error for a fault at a position, counted from 0."""
    return ValueError(f"at character {position + 1}: {text}")


def tokens(text: str) -> list[Token]:
    """Split an expression into tokens; the last one marks the end.

    Raises
    ------
    ValueError
        If it is too long, or contains an invalid character.
    """
    if len(text) > LONGEST:
        raise ValueError(f"has {len(text)} characters; an expression has at most {LONGEST}")
    found, position = [], 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise fault(position, _unknown(text[position]))
        kind = match.lastgroup or ""
        if kind != "space":
            written = "^" if match[0] == "**" else match[0]
            found.append(Token(kind, written, position, match.end()))
        position = match.end()
    return [*found, Token("end", "", len(text), len(text))]


def _unknown(character: str) -> str:
    if character.isascii():
        return f"{character!r} cannot stand in an expression"
    return (
        f"{character!r} (U+{ord(character):04X}) cannot stand in an expression; write it in ASCII"
    )


def unit_end(text: str, start: int, variables: Collection[str]) -> int:
    """Position after the unit that begins at a position; the same position without unit.

    Raises
    ------
    ValueError
        If the exponent of a unit is not a number.
    """
    found = _pattern(tuple(variables)).match(text, start)
    if found is None:
        return start
    power = _POWER.match(text, found.end())
    if power is not None and _NAME_AT_END.search(found[0]):
        raise fault(power.end() - len(power[0].lstrip()), "the exponent of a unit must be a number")
    return found.end()


@lru_cache
def _pattern(variables: tuple[str, ...]) -> re.Pattern[str]:
    name = rf"(?!(?:{'|'.join(variables)})\b)[A-Za-z_]\w*+(?!\s*\(){_EXPONENT}"
    factor = name
    for _ in range(_LEVELS):
        factors = rf"(?:\s*[*/]\s*{factor}|\s*{name})*+"
        factor = rf"(?:{name}|\(\s*{factor}{factors}\s*\){_EXPONENT})"
    factors = rf"(?:\s*[*/]\s*{factor}|\s*{name})*+"
    return re.compile(rf"\s*(?:(?:1\s*)?/\s*{factor}|{name}){factors}", re.ASCII)


@dataclass(frozen=True)
class Dimension:
    """Dimension of a quantity.

    Attributes
    ----------
    powers : tuple of (str, float)
        SI base unit and its exponent, sorted by name; exponents of 0 are left out.
    """

    powers: tuple[tuple[str, float], ...] = ()

    @classmethod
    def of(cls, powers: Mapping[str, float]) -> Dimension:
        """Dimension with given exponents of SI base units."""
        kept = {unit: float(power) for unit, power in powers.items() if abs(power) > _SAME}
        return cls(tuple(sorted(kept.items())))

    @property
    def none(self) -> bool:
        """True if the quantity is dimensionless."""
        return not self.powers

    def times(self, other: Dimension, power: float = 1.0) -> Dimension:
        """Dimension of the product with another quantity, raised to a power."""
        powers = dict(self.powers)
        for unit, exponent in other.powers:
            powers[unit] = powers.get(unit, 0.0) + power * exponent
        return Dimension.of(powers)

    def to(self, power: float) -> Dimension:
        """Dimension of the quantity raised to a power."""
        return Dimension().times(self, power)

    def same(self, other: Dimension) -> bool:
        """Equality up to rounding of the exponents."""
        return self.times(other, -1.0).none

    def __str__(self) -> str:
        """Text in SI base units, such as ``kg/(m s^2)``."""
        above = [_written(unit, power) for unit, power in self.powers if power > 0]
        below = [_written(unit, -power) for unit, power in self.powers if power < 0]
        if not below:
            return " ".join(above) or "1"
        under = below[0] if len(below) == 1 else f"({' '.join(below)})"
        return f"{' '.join(above) or '1'}/{under}"


def _written(unit: str, power: float) -> str:
    return unit if abs(power - 1) <= _SAME else f"{unit}^{power:.{_SHOWN}g}"


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
