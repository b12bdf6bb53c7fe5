"""Extent of the unit after a number, in the notation of the case file: ``W/(m^2 K)``."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from .tokens import Token, fault


def unit_end(tokens: Sequence[Token], start: int, variables: Collection[str]) -> int:
    """Index of the token after the unit that begins at a token; the same index without unit.

    Parameters
    ----------
    tokens : sequence of Token
        Tokens of the expression; the last one is its end.
    start : int
        Index of the token after the number.
    variables : collection of str
        Names that end a unit, as a name followed by ``(`` does.

    Raises
    ------
    ValueError
        If the exponent of a unit is not a number.
    """
    return _Extent(tokens, variables).after(start)


class _Extent:
    def __init__(self, tokens: Sequence[Token], variables: Collection[str]):
        self._tokens, self._variables = tokens, variables

    def after(self, start: int) -> int:
        """Index after a unit, which may begin with ``/`` or ``1/``; the start if there is none."""
        at = start
        if self._is(at, "1") and self._is(at + 1, "/"):
            at += 1
        if self._is(at, "/"):
            end_of_factor = self._factor(at + 1)
            return start if end_of_factor is None else self._rest(end_of_factor)
        first = self._factor(at, parenthesised=False)
        return start if first is None else self._rest(first)

    def _rest(self, at: int) -> int:
        """Index after further factors: juxtaposed, or after ``*`` and ``/``."""
        while True:
            signed = self._is(at, "*") or self._is(at, "/")
            end_of_factor = self._factor(at + 1 if signed else at, parenthesised=signed)
            if end_of_factor is None:
                return at
            at = end_of_factor

    def _factor(self, at: int, parenthesised: bool = True) -> int | None:
        """Index after one name or parenthesis with its exponent; None if there is none."""
        token = self._tokens[at]
        if token.kind == "name" and not self._ends_unit(at):
            return self._exponent(at + 1)
        if not (parenthesised and self._is(at, "(")):
            return None
        inner = self._factor(at + 1)
        if inner is None:
            return None
        end = self._rest(inner)
        return self._exponent(end + 1) if self._is(end, ")") else None

    def _ends_unit(self, at: int) -> bool:
        return self._tokens[at].text in self._variables or self._is(at + 1, "(")

    def _exponent(self, at: int) -> int:
        """Index after the exponent of a unit, or the same index without exponent."""
        if not self._is(at, "^"):
            return at
        end = at + 1
        if self._is(end, "("):
            end_of_factor = self._number(end + 1)
            if end_of_factor is not None and self._is(end_of_factor, "/"):
                end_of_factor = self._number(end_of_factor + 1)
            if end_of_factor is not None and self._is(end_of_factor, ")"):
                return end_of_factor + 1
        else:
            end_of_factor = self._number(end)
            if end_of_factor is not None:
                return end_of_factor
        raise fault(self._tokens[at].start, "the exponent of a unit must be a number")

    def _number(self, at: int) -> int | None:
        """Index after a signed number; None if there is none."""
        if self._is(at, "-") or self._is(at, "+"):
            at += 1
        return at + 1 if self._tokens[at].kind == "number" else None

    def _is(self, at: int, text: str) -> bool:
        return at < len(self._tokens) and self._tokens[at].text == text
