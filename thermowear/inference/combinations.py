"""Combinations of parameters that data determine although the parameters are undetermined.

Along an undetermined direction n of the internal coordinates, a function ``Σ a_i z_i`` with a·n = 0
is constant. The reduced row echelon form of all such a, logarithmic parameters first, has the
fewest parameters in each row. With coefficient 1 of its first logarithmic parameter, a row is the
logarithm of a product of powers such as ``k · mu^1.00``; a linear parameter b adds an exponential,
``k · 20.1^b``. A row of linear parameters alone is a sum, ``x + 2.00 y``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .joint_normal import PART, JointNormal
from .parameters import ParameterSpace

_NEGLIGIBLE = 5e-3  # change of a logarithm, or relative one of a sum, within the bounds
_PIVOT = 1e-3
_FULL = 10.0  # exponents of the base in plain digits: e^-10 … e^10


@dataclass(frozen=True)
class Combination:
    """Combination of parameters that the data determine.

    Attributes
    ----------
    space : ParameterSpace
    coefficients : ndarray, shape (p,)
        Coefficients of ln(value) for logarithmic parameters, of the value for others; the first one
        that is not zero, in the order of `text`, is 1.
    deviation : float
        Standard deviation of the sum: relative one of a product.
    """

    space: ParameterSpace
    coefficients: np.ndarray
    deviation: float

    @property
    def product(self) -> bool:
        """True for a product of powers and exponentials, False for a sum of values."""
        return bool(np.any(self.space.log & (self.coefficients != 0)))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters in the combination."""
        return tuple(self.space.names[i] for i in np.flatnonzero(self.coefficients))

    @property
    def text(self) -> str:
        """Formula in short names."""
        order = [int(i) for i in _order(self.space) if self.coefficients[i] != 0]
        terms = [(self.space.short_names[i], float(self.coefficients[i]), i) for i in order]
        if not self.product:
            return _sum_text([(name, factor) for name, factor, _ in terms])
        (first, *_), *others = terms
        factors = [
            f"{name}^{_number(c)}" if self.space.log[i] else _exponential(name, c)
            for name, c, i in others
        ]
        return " · ".join([first, *factors])

    def value(self, values) -> np.ndarray:
        """Value of the combination at values of the parameters, shape (…, p)."""
        values = np.asarray(values, dtype=float)
        logs = np.log(np.where(self.space.log, values, 1.0))
        total = np.where(self.space.log, logs, values) @ self.coefficients
        return np.exp(total) if self.product else total


def combinations(normal: JointNormal) -> tuple[Combination, ...]:
    """All independent combinations of the undetermined parameters that are determined."""
    involved = np.array([i for i in _order(normal.space) if normal.undetermined[i]], dtype=int)
    if not len(involved):
        return ()
    left, _, _ = np.linalg.svd(normal.null[involved], full_matrices=True)
    rows = _echelon(left[:, normal.null.shape[1] :].T / normal.space.scale[involved])
    return tuple(_combination(normal, involved, row) for row in rows)


def _combination(normal: JointNormal, involved: np.ndarray, row: np.ndarray) -> Combination:
    """Combination of a row of the echelon form, without negligible terms."""
    space = normal.space
    coefficients = np.zeros(len(space))
    coefficients[involved] = row
    reach = np.abs(coefficients) * space.widths * space.scale
    product = np.any(space.log[involved] & (np.abs(row) > 0))
    coefficients[reach < _NEGLIGIBLE * (1.0 if product else reach.max())] = 0.0
    deviation = np.linalg.norm((coefficients * space.scale) @ normal.factor)
    return Combination(space, coefficients, float(deviation))


def _order(space: ParameterSpace) -> np.ndarray:
    """Indices of the logarithmic parameters, then of the others."""
    return np.argsort(~space.log, kind="stable")


def _echelon(rows: np.ndarray) -> np.ndarray:
    """Reduced row echelon form of independent rows, with pivots 1."""
    rows = rows.copy()
    done = 0
    for column in range(rows.shape[1]):
        if done == len(rows):
            break
        sizes = np.abs(rows[done:, column]) / np.linalg.norm(rows[done:], axis=1)
        best = done + int(np.argmax(sizes))
        if sizes[best - done] < _PIVOT:
            continue
        rows[[done, best]] = rows[[best, done]]
        rows[done] /= rows[done, column]
        others = np.arange(len(rows)) != done
        rows[others] -= np.outer(rows[others, column], rows[done])
        done += 1
    rows[np.abs(rows) < PART * np.abs(rows).max(axis=1, keepdims=True)] = 0.0
    return rows


def _number(number: float) -> str:
    return f"{number:.2f}" if 0.1 <= abs(number) < 100 else f"{number:.3g}"


def _exponential(name: str, coefficient: float) -> str:
    if abs(coefficient) > _FULL or abs(coefficient) < 0.01:
        return f"exp({coefficient:.3g} {name})"
    return f"{np.exp(coefficient):.3g}^{name}"


def _sum_text(terms: list[tuple[str, float]]) -> str:
    (first, _), *others = terms
    signs = [f" {'-' if c < 0 else '+'} {_number(abs(c))} {name}" for name, c in others]
    return first + "".join(signs)
