"""Bounded weighted least squares with normal errors and priors.

The weighted residuals of observations and priors are minimised in internal coordinates by a trust
region reflective method (Branch, Coleman and Li, SIAM J. Sci. Comput. 21 (1999) 1; scipy). Only
predictions and finite differences of them are needed.

With the weighted Jacobian ``J = U S Vᵀ`` and the residuals r, the optimum is a Gauss-Newton step of
``|Uᵀ r|`` standard errors away: the search ends once that is small, as further runs of the model
would not change the parameters by more than a small part of their uncertainty.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy import stats
from scipy.optimize import least_squares

from ..errors import ComputationError
from .forward import ForwardModel
from .jacobian import AT_BOUND, NOISE, central_jacobian, distance_to_optimum, forward_jacobian
from .joint_normal import JointNormal
from .observations import Observations
from .parameters import ParameterSpace

_LEAST = 1e-12  # smallest scatter, relative to the deviations, for residuals that are zero
_STALLED = 1e-3  # change of the parameters, relative to the tolerance, that ends the search
_ROUNDING = 1e-15
_NEAR = 5
_ENDINGS = {
    0: "not converged: the largest number of evaluations was reached",
    1: "converged: the gradient is small",
    2: "converged: the sum of squares does not change any more",
    3: "converged: the parameters do not change any more",
    4: "converged: neither the sum of squares nor the parameters change any more",
    _NEAR: "converged: the optimum is within the tolerance",
}


@dataclass(frozen=True)
class Fit:
    """Parameters that fit observations best, and their uncertainty.

    Attributes
    ----------
    space : ParameterSpace
    observations : Observations
    internal : ndarray, shape (p,)
        Internal coordinates of the optimum.
    predicted : ndarray, shape (n,)
        Predictions there.
    jacobian : ndarray, shape (n, p)
        Derivatives of the weighted residuals with respect to the internal coordinates.
    converged : bool
    message : str
        Reason for the end of the iteration.
    evaluations : int
        Number of predictions, without those for derivatives.
    noise : float
        Relative noise of the derivatives, by which directions count as undetermined.
    """

    space: ParameterSpace
    observations: Observations
    internal: np.ndarray
    predicted: np.ndarray
    jacobian: np.ndarray
    converged: bool = True
    message: str = ""
    evaluations: int = 0
    noise: float = NOISE

    @property
    def values(self) -> np.ndarray:
        """Values of the parameters, shape (p,)."""
        return self.space.admissible(self.internal)

    @property
    def residuals(self) -> np.ndarray:
        """Weighted residuals of the observations, shape (n,)."""
        return self.observations.residuals(self.predicted)

    @cached_property
    def uncertainty(self) -> JointNormal:
        """Distribution of the parameters for known deviations of the observations."""
        return JointNormal.from_jacobian(self.space, self.internal, self.jacobian, self.noise)

    @cached_property
    def scattered(self) -> JointNormal:
        """Distribution for deviations known but for the factor `scatter`, by Student's t."""
        rows, free = self.jacobian / self.scatter, len(self.observations) - self.determined
        return JointNormal.from_jacobian(self.space, self.internal, rows, self.noise, free)

    @property
    def scatter(self) -> float:
        """Common factor of the deviations by the residuals; priors do not count as residuals.

        Raises
        ------
        ValueError
            If there are no more observations than parameters that are determined.
        """
        free = len(self.observations) - self.determined
        if free <= 0:
            raise ValueError(
                f"{len(self.observations)} observations determine {self.determined} parameters: "
                "none is left to estimate the scatter"
            )
        return max(float(np.sqrt(np.sum(self.residuals**2) / free)), _LEAST)

    @property
    def determined(self) -> int:
        """Number of independent combinations of the parameters that are determined."""
        return self.uncertainty.factor.shape[1]

    @property
    def chi2(self) -> float:
        """Sum of squares of the weighted residuals of observations and priors."""
        priors = self.space.prior_residuals(self.internal)
        return float(np.sum(self.residuals**2) + np.sum(priors**2))

    @property
    def degrees_of_freedom(self) -> int:
        """Number of observations and priors less the number of determined parameters."""
        return len(self.observations) + len(self.space.prior_jacobian) - self.determined

    @property
    def reduced_chi2(self) -> float:
        """Sum of squares per degree of freedom; NaN without any."""
        return self.chi2 / self.degrees_of_freedom if self.degrees_of_freedom else np.nan

    @property
    def p_value(self) -> float:
        """Probability of a larger sum of squares if model and deviations are correct."""
        free = self.degrees_of_freedom
        return float(stats.chi2.sf(self.chi2, free)) if free else np.nan

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of the internal coordinates, shape (p, p), see `JointNormal`."""
        return self.uncertainty.covariance

    @property
    def correlation(self) -> np.ndarray:
        """Correlation of the internal coordinates, shape (p, p)."""
        return self.uncertainty.correlation

    @property
    def standard_errors(self) -> np.ndarray:
        """Standard errors, relative ones of logarithmic parameters, shape (p,)."""
        return self.uncertainty.standard_errors

    def intervals(self, level: float = 0.95) -> np.ndarray:
        """Intervals of the values for known deviations, shape (p, 2)."""
        return self.uncertainty.intervals(level)

    @property
    def distance(self) -> float:
        """Distance from the optimum by the derivatives to both sides, in standard errors.

        Large where predictions have kinks, such as a maximum whose place changes.
        """
        rows = np.concatenate([self.jacobian, self.space.prior_jacobian])
        priors = self.space.prior_residuals(self.internal)
        residuals = np.concatenate([self.residuals, priors])
        return distance_to_optimum(self.space, self.internal, rows, residuals, self.noise)

    @property
    def at_bounds(self) -> tuple[str, ...]:
        """Names of parameters that a bound keeps from fitting better."""
        slope = self.jacobian.T @ self.residuals
        slope += self.space.prior_jacobian.T @ self.space.prior_residuals(self.internal)
        (lower, upper), near = self.space.bounds, AT_BOUND * self.space.widths
        held = (self.internal - lower < near) & (slope > 0)
        held |= (upper - self.internal < near) & (slope < 0)
        return tuple(name for name, at in zip(self.space.names, held, strict=True) if at)


def fit(
    space: ParameterSpace,
    observations: Observations,
    model: ForwardModel,
    tolerance: float = 1e-6,
    max_evaluations: int = 100,
    noise: float = NOISE,
    estimated: bool = False,
) -> Fit:
    """Fit parameters to observations.

    Parameters
    ----------
    tolerance : float
        Distance from the optimum in standard errors at which the search ends.
    max_evaluations : int
        Largest number of predictions, without those for derivatives.
    noise : float
        Relative noise of the derivatives.
    estimated : bool
        True if deviations are known but for a common factor: standard errors of the tolerance are
        those by the scatter.

    Raises
    ------
    ComputationError
        If predictions at the start, or beside an accepted point, cannot be computed.
    """
    problem = _LeastSquares(space, observations, model, tolerance, noise, estimated)
    start = space.internal(space.start)
    if not np.isfinite(problem.residuals(start)).all():
        raise ComputationError("the predictions at the start of the fit could not be computed")
    stalled = _STALLED * tolerance
    try:
        found = least_squares(
            problem.residuals,
            start,
            jac=problem.jacobian,
            bounds=space.bounds,
            method="trf",
            ftol=max(stalled * tolerance, _ROUNDING),
            xtol=max(stalled, _ROUNDING),
            gtol=None,
            max_nfev=max_evaluations,
        )
        internal, status = found.x, found.status
    except _NearOptimum as near:
        internal, status = near.internal, _NEAR
    predicted = problem.predicted(internal)
    jacobian = central_jacobian(space, model, internal, predicted)
    return Fit(
        space,
        observations,
        internal,
        predicted,
        jacobian / observations.deviations[:, None],
        status > 0,
        _ENDINGS[status],
        len(problem.known),
        noise,
    )


class _NearOptimum(Exception):
    """End of a search at internal coordinates near the optimum."""

    def __init__(self, internal: np.ndarray):
        super().__init__()
        self.internal = internal


@dataclass(frozen=True)
class _LeastSquares:
    """Residuals and Jacobian of a fit; each point is predicted once."""

    space: ParameterSpace
    observations: Observations
    model: ForwardModel
    tolerance: float
    noise: float
    estimated: bool
    known: dict[bytes, np.ndarray] = field(default_factory=dict)

    def predicted(self, internal: np.ndarray) -> np.ndarray:
        key = internal.tobytes()
        if key not in self.known:
            predicted = self.model.predict(self.space.admissible(internal))
            self.known[key] = np.asarray(predicted, dtype=float)
        return self.known[key]

    def residuals(self, internal: np.ndarray) -> np.ndarray:
        """Weighted residuals of observations and priors, shape (n + m,)."""
        observed = self.observations.residuals(self.predicted(internal))
        return np.concatenate([observed, self.space.prior_residuals(internal)])

    def jacobian(self, internal: np.ndarray) -> np.ndarray:
        """Derivatives of the residuals, shape (n + m, p).

        Raises
        ------
        _NearOptimum
            If the optimum is within the tolerance.
        """
        rows = forward_jacobian(self.space, self.model, internal, self.predicted(internal))
        rows = rows / self.observations.deviations[:, None]
        rows = np.concatenate([rows, self.space.prior_jacobian])
        residuals = self.residuals(internal)
        distance = distance_to_optimum(self.space, internal, rows, residuals, self.noise)
        if distance < self.tolerance * self._factor(residuals):
            raise _NearOptimum(internal.copy())
        return rows

    def _factor(self, residuals: np.ndarray) -> float:
        """Factor of the standard errors: the search ends by Bates and Watts' relative offset."""
        if not self.estimated:
            return 1.0
        count = len(self.observations)
        return float(np.sqrt(np.sum(residuals[:count] ** 2) / max(count - len(self.space), 1)))
