"""Parameters, and combinations of them, that observations determine.

The singular value s of a direction of the weighted Jacobian in internal coordinates is the number
of standard deviations by which the predictions change along it per unit: 1/s is the standard
deviation of the parameters. A direction is *structurally* unidentifiable if s is within the noise
of the derivatives, and *practically* if 1/s exceeds the distance of the bounds along it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .combinations import Combination, combinations
from .jacobian import NOISE, principal_directions, without_effect
from .joint_normal import JointNormal
from .parameters import ParameterSpace

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
