"""Posterior distribution of the parameters by an ensemble sampler, beyond the normal approximation.

Affine-invariant ensemble sampler (Goodman and Weare, Commun. Appl. Math. Comput. Sci. 5 (2010) 65)
of the package emcee, which is needed for this alone. Points outside the bounds have no probability.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ComputationError
from .fit import Fit, JointNormal
from .parameters import Observations, ParameterSpace
from .propagation import quantiles

Predictions = Callable[[Sequence[np.ndarray]], Sequence[np.ndarray]]
"""Predictions (n,) at each of several points, perhaps in parallel; NaN where they fail."""
ENOUGH = 50
"""Number of autocorrelation times from which on their estimate is reliable (emcee)."""
_BURN_IN = 5  # autocorrelation times that are left out at the start
_LEAST = 1e-24  # smallest sum of squares, as data without errors have
_SPREAD = 0.1  # part of the bounds that walkers cover along undetermined directions


@dataclass(frozen=True)
class Posterior:
    """Sample of the posterior distribution.

    Attributes
    ----------
    space : ParameterSpace
    values : ndarray, shape (n, p)
        Values of the parameters, without the burn-in.
    acceptance : float
        Mean fraction of accepted moves.
    autocorrelation : ndarray, shape (p,)
        Autocorrelation times [steps].
    steps : int
        Steps of each walker, with the burn-in.
    """

    space: ParameterSpace
    values: np.ndarray
    acceptance: float
    autocorrelation: np.ndarray
    steps: int

    def intervals(self, level: float = 0.95) -> np.ndarray:
        """Intervals between equal tails, shape (p, 2)."""
        ends = (1 - level) / 2, (1 + level) / 2
        return quantiles(self.values, ends, stratified=False).T

    @property
    def warning(self) -> str:
        """Sentence if the chains are too short for reliable intervals, else empty."""
        longest = float(np.max(self.autocorrelation))
        if self.steps >= ENOUGH * longest:
            return ""
        return (
            f"posterior: {self.steps} steps are less than {ENOUGH} autocorrelation times of "
            f"{longest:.0f} steps; its intervals are not reliable"
        )


def log_posterior(
    space: ParameterSpace,
    observations: Observations,
    predictions: Predictions,
    estimated: bool = False,
) -> Callable[[np.ndarray], np.ndarray]:
    """Logarithm of the posterior density but for a constant, of points (m, p), shape (m,).

    If the deviations are estimated, their common factor f is integrated out with the prior 1/f
    (Jeffreys): n observations with the sum of squares S have the density ``S^(-n/2)``.
    """

    def density(internal: np.ndarray) -> np.ndarray:
        result = np.full(len(internal), -np.inf)
        inside = np.flatnonzero(space.contains(internal))
        if len(inside):
            predicted = np.array(predictions(list(space.admissible(internal[inside]))))
            sums = np.sum(observations.residuals(predicted) ** 2, axis=1)
            if estimated:
                sums = len(observations) * np.log(np.maximum(sums, _LEAST))
            sums += np.sum(space.prior_residuals(internal[inside]) ** 2, axis=1)
            result[inside] = np.where(np.isfinite(sums), -sums / 2, -np.inf)
        return result

    return density


def sample_posterior(
    fit: Fit,
    predictions: Predictions,
    steps: int = 2000,
    walkers: int = 0,
    seed: int = 0,
    estimated: bool = False,
) -> Posterior:
    """Sample the posterior distribution from a fit on.

    Parameters
    ----------
    predictions : callable
        Predictions at several points; a step of the sampler asks for half of the walkers twice.
    steps : int
        Steps of each walker.
    walkers : int
        Number of walkers, even, two for each parameter at least; by default four, at least 16.
    estimated : bool
        True if the deviations of the observations are known but for a common factor.

    Raises
    ------
    ComputationError
        If emcee is not installed.
    """
    emcee = require_emcee()
    space = fit.space
    walkers = walkers or max(16, 4 * len(space))
    density = log_posterior(space, fit.observations, predictions, estimated)
    sampler = emcee.EnsembleSampler(walkers, len(space), density, vectorize=True)
    legacy = np.random.RandomState(np.random.MT19937(seed))  # as emcee needs
    normal = fit.scattered if estimated else fit.uncertainty
    start = emcee.State(_start(normal, walkers, seed), random_state=legacy.get_state())
    sampler.run_mcmc(start, steps)
    times = np.nan_to_num(sampler.get_autocorr_time(tol=0), nan=np.inf)
    left_out = int(min(_BURN_IN * times.max(), steps / 2))
    chain = sampler.get_chain(discard=left_out, flat=True)
    return Posterior(
        space, space.admissible(chain), float(sampler.acceptance_fraction.mean()), times, steps
    )


def _start(normal: JointNormal, walkers: int, seed: int) -> np.ndarray:
    """Points about a mean, as its covariance has them, within the bounds, shape (walkers, p)."""
    rng, mean = np.random.default_rng(seed), normal.mean
    (lower, upper), widths = normal.space.bounds, normal.space.widths
    spread = np.concatenate([normal.factor, _SPREAD * widths[:, None] * normal.null], axis=1)
    points = mean + rng.standard_normal((walkers, spread.shape[1])) @ spread.T
    uniform = lower + rng.random((walkers, len(widths))) * widths
    close = np.clip(mean + _SPREAD * (uniform - mean), lower, upper)
    return np.where((points > lower) & (points < upper), points, close)


def require_emcee() -> Any:
    """Package of the sampler.

    Raises
    ------
    ComputationError
        If it is not installed.
    """
    try:
        import emcee
    except ImportError:
        raise ComputationError(
            "the posterior needs the package emcee: install python3-emcee or `pip install emcee`"
        ) from None
    return emcee
