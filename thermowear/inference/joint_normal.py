"""Normal distribution of parameters in internal coordinates, as a calibration leaves it.

With the weighted Jacobian J of the observations and the rows P of the priors, the covariance is
``(JᵀJ + PᵀP)⁻¹``. Directions that neither determines have no distribution: the parameters that take
part in them have infinite intervals.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import stats

from .jacobian import NOISE, principal_directions, without_effect
from .parameters import ParameterSpace

PART = 1e-3
"""Component of a parameter in a direction of unit length from which on it takes part in it."""
_SMALL = 1e-2  # change along an undetermined direction, relative to the distance of the bounds
_ROUNDING = 1e-12


@dataclass(frozen=True)
class JointNormal:
    """Normal distribution of p parameters about a point.

    Attributes
    ----------
    space : ParameterSpace
    mean : ndarray, shape (p,)
        Internal coordinates of the mean.
    factor : ndarray, shape (p, r)
        Factor F of the covariance ``F Fᵀ`` of the determined directions.
    null : ndarray, shape (p, m)
        Orthonormal directions that are not determined.
    degrees_of_freedom : float
        Degrees of freedom of Student's t distribution; infinite if deviations are known.
    """

    space: ParameterSpace
    mean: np.ndarray
    factor: np.ndarray
    null: np.ndarray
    degrees_of_freedom: float = np.inf

    @classmethod
    def from_jacobian(
        cls,
        space: ParameterSpace,
        mean: np.ndarray,
        jacobian: np.ndarray,
        noise: float = NOISE,
        degrees_of_freedom: float = np.inf,
    ) -> JointNormal:
        """Distribution after observations with a weighted Jacobian (n, p), and the priors."""
        singular_values, directions = principal_directions(jacobian)
        seen = ~without_effect(singular_values, noise)
        informed = singular_values[seen, None] * directions[:, seen].T
        rows = np.concatenate([informed, space.prior_jacobian])
        singular_values, directions = principal_directions(rows)
        found = ~without_effect(singular_values, _ROUNDING)
        factor = directions[:, found] / singular_values[found]
        return cls(space, np.asarray(mean), factor, directions[:, ~found], degrees_of_freedom)

    @classmethod
    def from_covariance(
        cls, space: ParameterSpace, mean: np.ndarray, covariance: np.ndarray
    ) -> JointNormal:
        """Distribution with a covariance (p, p) of the internal coordinates."""
        variances, directions = np.linalg.eigh(np.asarray(covariance, dtype=float))
        if not np.isfinite(variances).all() or variances[0] < -_ROUNDING * abs(variances[-1]):
            raise ValueError("the covariance of the parameters is not positive semidefinite")
        factor = directions * np.sqrt(np.maximum(variances, 0.0))
        return cls(space, np.asarray(mean, dtype=float), factor, np.zeros((len(space), 0)))

    @property
    def size(self) -> int:
        """Number p of parameters."""
        return len(self.space)

    @cached_property
    def undetermined(self) -> np.ndarray:
        """True for parameters that take part in a direction that is not determined, shape (p,).

        Parameters that change less than their deviation along it, within the bounds, are left out.
        """
        change = np.abs(self.null) @ self.space.reach(self.null)
        small = np.minimum(np.linalg.norm(self.factor, axis=1), _SMALL * self.space.widths)
        return (np.linalg.norm(self.null, axis=1) > PART) & (change > small)

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations of the internal coordinates, infinite if not determined, (p,)."""
        return np.where(self.undetermined, np.inf, np.linalg.norm(self.factor, axis=1))

    @property
    def standard_errors(self) -> np.ndarray:
        """Standard errors, relative ones of logarithmic parameters, shape (p,)."""
        return self.deviations * self.space.scale

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of the internal coordinates, (p, p); inf and NaN where not determined."""
        covariance = self.factor @ self.factor.T
        covariance[self.undetermined] = covariance[:, self.undetermined] = np.nan
        np.fill_diagonal(covariance, self.deviations**2)
        return covariance

    @property
    def correlation(self) -> np.ndarray:
        """Correlation of the internal coordinates, shape (p, p); NaN where not determined."""
        with np.errstate(invalid="ignore", divide="ignore"):
            correlation = self.covariance / np.outer(self.deviations, self.deviations)
        np.fill_diagonal(correlation, np.where(self.undetermined, np.nan, 1.0))
        return correlation

    def quantile(self, level: float) -> float:
        """Half-width of an interval in standard deviations."""
        if not 0 < level < 1:
            raise ValueError(f"level {level:g} of an interval; must be between 0 and 1")
        return float(stats.t.ppf((1 + level) / 2, self.degrees_of_freedom))

    def intervals(self, level: float = 0.95) -> np.ndarray:
        """Intervals of the values, shape (p, 2); asymmetric for logarithmic parameters."""
        reach = self.quantile(level) * self.deviations
        return self.space.values(np.stack([self.mean - reach, self.mean + reach])).T

    def ppf(self, quantiles: np.ndarray) -> np.ndarray:
        """Values for independent quantiles in (0, 1), both of shape (n, p).

        The coordinates are ``mean + L Φ⁻¹(q)`` with the Cholesky factor L of the covariance: a
        quantile moves its parameter, and those after it by their correlation. Values may lie
        beyond the bounds.
        """
        if self.null.size:
            names = ", ".join(np.array(self.space.names)[self.undetermined])
            raise ValueError(f"{names}: not determined, so that they have no distribution")
        return self.space.values(self.mean + stats.norm.ppf(quantiles) @ self.cholesky.T)

    @cached_property
    def cholesky(self) -> np.ndarray:
        """Lower triangular factor of the covariance, also of a singular one, shape (p, p)."""
        rows = np.zeros((max(self.factor.shape[::-1]), self.size))
        rows[: self.factor.shape[1]] = self.factor.T
        triangle = np.linalg.qr(rows, mode="r")
        signs = np.where(np.diag(triangle) < 0, -1.0, 1.0)
        return (signs[:, None] * triangle).T
