"""Bounded weighted least squares with normal errors and priors.

With the weighted Jacobian J of the observations and the rows P of the priors, the covariance is
``(JᵀJ + PᵀP)⁻¹``. Directions that neither determines have no distribution: the parameters that take
part in them have infinite intervals.

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
from .parameters import ForwardModel, Observations, ParameterSpace

NOISE = 1e-5
"""Noise of derivatives relative to the largest ones, by which they count as zero."""
AT_BOUND = 1e-3
"""Distance to a bound, relative to the distance of both, up to which a parameter is held by it."""
_ROOM = 0.25  # largest step relative to the distance of the bounds


def forward_jacobian(
    space: ParameterSpace, model: ForwardModel, internal: np.ndarray, predicted: np.ndarray
) -> np.ndarray:
    """Jacobian by forward differences, or backward ones at upper bounds: p predictions.

    Parameters
    ----------
    internal : ndarray, shape (p,)
        Internal coordinates of a point within the bounds.
    predicted : ndarray, shape (n,)
        Prediction there.

    Returns
    -------
    ndarray, shape (n, p)
        Derivatives with respect to the internal coordinates.
    """
    steps = steps_within(space, model.step)
    steps = np.where(internal + steps > space.bounds[1], -steps, steps)
    moved = _moved(space, model, internal, np.diag(steps))
    return _finite(space, (moved - predicted).T / steps)


def central_jacobian(
    space: ParameterSpace, model: ForwardModel, internal: np.ndarray, predicted: np.ndarray
) -> np.ndarray:
    """Jacobian of second order: 2 p predictions; parameters as in `forward_jacobian`.

    Differences are central, or one-sided with two steps into the interior at bounds::

        f' ≈ (4 f(z + h) - f(z + 2 h) - 3 f(z))/(2 h)
    """
    steps = steps_within(space, model.step)
    below = internal - steps < space.bounds[0]
    above = internal + steps > space.bounds[1]
    central = ~(below | above)
    steps = np.where(above, -steps, steps)
    offsets = np.concatenate([np.diag(steps), np.diag(np.where(central, -steps, 2 * steps))])
    one, two = np.split(_moved(space, model, internal, offsets), 2)
    centred, sided = one - two, 4 * one - two - 3 * predicted
    return _finite(space, np.where(central[:, None], centred, sided).T / (2 * steps))


def principal_directions(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Singular values of a Jacobian (n, p), and all p directions, also those without effect.

    Returns
    -------
    singular_values : ndarray, shape (p,)
        In descending order, with zeros where n < p.
    directions : ndarray, shape (p, p)
        Orthonormal right singular vectors, in columns.
    """
    triangle = np.linalg.qr(rows, mode="r")
    _, found, transposed = np.linalg.svd(triangle, full_matrices=True)
    singular_values = np.zeros(rows.shape[1])
    singular_values[: len(found)] = found
    return singular_values, transposed.T


def without_effect(singular_values: np.ndarray, noise: float = NOISE) -> np.ndarray:
    """True for singular values within the noise of the derivatives, shape (p,)."""
    return singular_values <= noise * singular_values.max(initial=0.0)


def distance_to_optimum(
    space: ParameterSpace,
    internal: np.ndarray,
    rows: np.ndarray,
    residuals: np.ndarray,
    noise: float,
) -> float:
    """Length of the Gauss-Newton step within the bounds, in standard errors.

    Parameters
    ----------
    internal : ndarray, shape (p,)
        Internal coordinates of a point within the bounds.
    rows : ndarray, shape (n, p)
        Weighted Jacobian there, of observations and priors.
    residuals : ndarray, shape (n,)
        Weighted residuals there.
    noise : float
        Relative noise of the derivatives.
    """
    (lower, upper), slope = space.bounds, rows.T @ residuals
    to_bound = np.where(slope > 0, internal - lower, upper - internal)
    held = (to_bound < AT_BOUND * space.widths) & (slope != 0)
    singular_values, directions = principal_directions(rows[:, ~held])
    seen = ~without_effect(singular_values, noise)
    inside = directions[:, seen].T @ slope[~held] / singular_values[seen]
    return float(np.hypot(np.linalg.norm(rows[:, held] @ to_bound[held]), np.linalg.norm(inside)))


def steps_within(space: ParameterSpace, step: float) -> np.ndarray:
    """Steps of finite differences, of which two fit between the bounds to one side, shape (p,)."""
    return np.minimum(step, _ROOM * space.widths)


def _moved(
    space: ParameterSpace, model: ForwardModel, internal: np.ndarray, offsets: np.ndarray
) -> np.ndarray:
    """Predictions at points moved by offsets (m, p), shape (m, n)."""
    others = list(space.admissible(internal + offsets))
    return np.array(model.neighbours(space.admissible(internal), others), dtype=float)


def _finite(space: ParameterSpace, jacobian: np.ndarray) -> np.ndarray:
    failed = ~np.isfinite(jacobian).all(axis=0)
    if failed.any():
        names = ", ".join(np.array(space.names)[failed])
        raise ComputationError(
            f"derivatives with respect to {names}: predictions beside the point could not be "
            "computed; narrow the bounds, or start elsewhere"
        )
    return jacobian


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
