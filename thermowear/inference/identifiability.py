"""Parameters, and combinations of them, that observations determine.

Along an undetermined direction n of the internal coordinates, a function ``Σ a_i z_i`` with a·n = 0
is constant. The reduced row echelon form of all such a, logarithmic parameters first, has the
fewest parameters in each row. With coefficient 1 of its first logarithmic parameter, a row is the
logarithm of a product of powers such as ``k · mu^1.00``; a linear parameter b adds an exponential,
``k · 20.1^b``. A row of linear parameters alone is a sum, ``x + 2.00 y``.

The singular value s of a direction of the weighted Jacobian in internal coordinates is the number
of standard deviations by which the predictions change along it per unit: 1/s is the standard
deviation of the parameters. A direction is *structurally* unidentifiable if s is within the noise
of the derivatives, and *practically* if 1/s exceeds the distance of the bounds along it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .fit import NOISE, PART, JointNormal, principal_directions, without_effect
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


_EQUAL = 1e-3
"""Relative difference of changes that derivatives by differences do not tell apart."""


@dataclass(frozen=True)
class Identifiability:
    """Directions of the internal coordinates in the order of their singular values.

    Attributes
    ----------
    space : ParameterSpace
    singular_values : ndarray, shape (p,)
        Changes of the predictions per unit, in standard deviations, descending.
    directions : ndarray, shape (p, p)
        Orthonormal directions, in columns.
    structural, practical : ndarray of bool, shape (p,)
        Directions without effect, and others that are not determined within the bounds.
    combinations : tuple of Combination
        Combinations of the undetermined parameters that are determined.
    """

    space: ParameterSpace
    singular_values: np.ndarray
    directions: np.ndarray
    structural: np.ndarray
    practical: np.ndarray
    combinations: tuple[Combination, ...]

    @property
    def normal(self) -> JointNormal:
        """Distribution of the identified directions about zero, without priors."""
        return _normal(self)

    @property
    def null(self) -> np.ndarray:
        """Undetermined directions, shape (p, m)."""
        return self.directions[:, self.structural | self.practical]

    @property
    def identified(self) -> bool:
        """True if all parameters are determined."""
        return not self.null.size

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the parameters that are not determined."""
        return _taking_part(self.space, self.normal.undetermined)


def identify(space: ParameterSpace, jacobian: np.ndarray, noise: float = NOISE) -> Identifiability:
    """Identifiability by observations with a weighted Jacobian (n, p), without priors."""
    singular_values, directions = principal_directions(jacobian)
    structural = without_effect(singular_values, noise)
    practical = ~structural & (singular_values * space.reach(directions) < 1)
    found = Identifiability(space, singular_values, directions, structural, practical, ())
    return Identifiability(
        space, singular_values, directions, structural, practical, combinations(found.normal)
    )


@dataclass(frozen=True)
class Settling:
    """Further measurement and its effect.

    Attributes
    ----------
    name : str
    change : float
        Relative change of the measured values (root mean square) along an undetermined direction,
        per unit of the internal coordinate that changes most.
    """

    name: str
    change: float


def settling(
    direction: np.ndarray, sensitivities: Mapping[str, tuple[np.ndarray, np.ndarray]]
) -> list[Settling]:
    """Rank further measurements by the change along an undetermined direction.

    Parameters
    ----------
    direction : ndarray, shape (p,)
    sensitivities : dict
        By name, values (m,) that a measurement would have, and their derivatives (m, p) with
        respect to the internal coordinates.

    Returns
    -------
    list of Settling
        In descending order of the change; equal ones, but for rounding, in the given order.
    """
    unit = direction / np.abs(direction).max()
    found = []
    for name, (values, jacobian) in sensitivities.items():
        size, change = np.linalg.norm(values), np.linalg.norm(np.asarray(jacobian) @ unit)
        relative = change / size if size else np.inf if change else 0.0
        found.append(Settling(name, float(relative)))
    ranked = sorted(found, key=lambda candidate: -candidate.change)
    changes = np.array([candidate.change for candidate in ranked])
    lower = changes[1:] < (1 - _EQUAL) * changes[:-1]
    rank = dict(zip((one.name for one in ranked), (0, *np.cumsum(lower)), strict=False))
    return sorted(found, key=lambda candidate: rank[candidate.name])


def _normal(found: Identifiability) -> JointNormal:
    kept = ~(found.structural | found.practical)
    factor = found.directions[:, kept] / found.singular_values[kept]
    return JointNormal(found.space, np.zeros(len(found.space)), factor, found.null)


def _taking_part(space: ParameterSpace, chosen: np.ndarray) -> tuple[str, ...]:
    return tuple(name for name, part in zip(space.names, chosen, strict=True) if part)
