"""Calibration of the parameters of a case by measured data."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from ..case.studies.calibration import CalibrationTable
from ..errors import CaseError, ComputationError
from ..inference import (
    Fit,
    Identifiability,
    JointNormal,
    Observations,
    Posterior,
    fit,
    identify,
    require_emcee,
    sample_posterior,
)
from .candidate_run import Runner
from .measurement import Measurement
from .problem import Problem
from .settling import Suggestion, suggestions, undetermined

_FAR = 0.1
"""Distance from the optimum, in standard errors, from which on it is reported."""
_UNLIKELY = 1e-3
"""Probability of residuals from which on they are reported as too large."""
_OTHER = 1.5
"""Factor of the scatter from which on the weight of priors is reported as not right."""


@dataclass(frozen=True)
class Calibration:
    """Parameters of a case as data determine them.

    Attributes
    ----------
    table : CalibrationTable
    measurements : tuple of Measurement
    fit : Fit
    identifiability : Identifiability
    suggestions : tuple of Suggestion
        Measurements that would determine what these do not.
    posterior : Posterior or None
    runs : int
        Number of runs of the case.
    seconds : float
        Wall time.
    """

    table: CalibrationTable
    measurements: tuple[Measurement, ...]
    fit: Fit
    identifiability: Identifiability
    suggestions: tuple[Suggestion, ...]
    posterior: Posterior | None
    runs: int
    seconds: float

    @property
    def estimated(self) -> bool:
        """True if the deviations are known but for a common factor, which the scatter gives."""
        return self.table.deviations == "estimated"

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations of the measurements, as given or by the scatter [SI], shape (n,)."""
        return self.fit.observations.deviations * self._factor

    @property
    def _factor(self) -> float:
        """Factor of the given deviations."""
        return self.fit.scatter if self.estimated else 1.0

    @property
    def normal(self) -> JointNormal:
        """Distribution of the parameters, by the given deviations or by the scatter."""
        return self.fit.scattered if self.estimated else self.fit.uncertainty

    @property
    def values(self) -> dict[str, float]:
        """Values of the parameters by name, in the units of their start."""
        return dict(zip(self.table.parameters, map(float, self.fit.values), strict=True))

    def intervals(self, level: float | None = None) -> dict[str, tuple[float, float]]:
        """Confidence intervals by name; infinite for parameters that are not determined."""
        found = self.normal.intervals(level or self.table.confidence)
        pairs = ((float(low), float(high)) for low, high in found)
        return dict(zip(self.table.parameters, pairs, strict=True))

    @property
    def standard_errors(self) -> dict[str, float]:
        """Standard errors by name, relative ones of logarithmic parameters."""
        errors = map(float, self.normal.standard_errors)
        return dict(zip(self.table.parameters, errors, strict=True))

    @property
    def overrides(self) -> tuple[str, ...]:
        """Changes ``KEY=VALUE`` that give the case the calibrated values."""
        return self.table.overrides(self.values)

    @property
    def at_bounds(self) -> tuple[str, ...]:
        """Names of parameters that a bound keeps from fitting better."""
        short = dict(zip(self.fit.space.names, self.table.parameters, strict=True))
        return tuple(short[name] for name in self.fit.at_bounds)

    def notes(self) -> list[str]:
        """Sentences on what the data do not determine, and on a fit that is not good."""
        found = [] if self.fit.converged else [f"the fit has {self.fit.message}"]
        off = self.fit.distance / self._factor
        if self.fit.converged and off > _FAR:
            found.append(
                f"the search ended {off:.2g} standard errors from the optimum by the derivatives "
                "there: the predictions are not smooth (such as a maximum whose place changes), "
                "and the intervals are rough"
            )
        found += [f"{name} ended at a bound" for name in self.at_bounds]
        found += undetermined(self.identifiability, self.suggestions)
        p_value = self.fit.p_value
        if self.estimated:
            found += self._weighed_priors()
        elif p_value < _UNLIKELY:
            found.append(
                f"the residuals are larger than the deviations explain (reduced chi² "
                f"{self.fit.reduced_chi2:.3g}, p = {p_value:.1g}): the model or the deviations "
                'are not right; deviations = "estimated" takes them from the scatter'
            )
        if self.posterior is not None and self.posterior.warning:
            found.append(self.posterior.warning)
        return found

    def _weighed_priors(self) -> list[str]:
        """Sentence if priors were weighed against deviations of another size than the scatter."""
        factor, priors = self._factor, len(self.fit.space.prior_jacobian)
        if not priors or 1 / _OTHER < factor < _OTHER:
            return []
        return [
            f"the scatter is {factor:.3g} times the given deviations, against which the priors "
            "were weighed: multiply the deviations by this factor"
        ]


def solve(problem: Problem, runner: Runner) -> Calibration:
    """Find the parameters that fit the measurements best, and their uncertainty.

    Raises
    ------
    CaseError
        If the measurements do not fit the case.
    ComputationError
        If a run with the first values fails.
    """
    table = problem.table
    if table.posterior is not None:
        require_emcee()  # before anything is computed
    began, order = time.perf_counter(), problem.order
    model = problem.in_order(order).model(runner)
    values = np.concatenate([one.values for one in problem.measurements])
    given = Observations(values, *problem.weights)
    observations = given.ordered(order)
    start = problem.space.start
    if reason := (model.failure(start) if not np.isfinite(model.predict(start)).all() else ""):
        raise ComputationError(f"calibrate: the run with the first values failed: {reason}")
    estimated = table.deviations == "estimated"
    search = table.tolerance, table.max_evaluations, problem.noise(model), estimated
    found = fit(problem.space, observations, model, *search)
    try:
        scatter = found.scatter if estimated else 1.0
    except ValueError as error:
        raise CaseError(f'calibrate.deviations: found "estimated", but {error}') from None
    identified = identify(problem.space, found.jacobian / scatter, found.noise)
    further = suggestions(problem.space, model, found.values, identified)
    posterior = None
    if table.posterior is not None:
        chosen, best = table.posterior, found.values
        posterior = sample_posterior(
            found,
            lambda points: model.neighbours(best, points),
            chosen.steps,
            chosen.walkers or 0,
            chosen.seed,
            estimated,
        )
    seconds, back = time.perf_counter() - began, np.argsort(order)
    return Calibration(
        table,
        tuple(problem.measurements),
        replace(
            found,
            observations=given,
            predicted=found.predicted[back],
            jacobian=found.jacobian[back],
        ),
        identified,
        further,
        posterior,
        model.runs,
        seconds,
    )
