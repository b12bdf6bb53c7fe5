"""Table ``calibrate``: parameters to be found from observations."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from ..values.percentages import Percentage
from ..values.section import KeyFault, Number, Section, UserFile
from .scalars import Scalar, ScalarKey, SpreadKey

_NAME = re.compile(r"[^\W\d]\w*")
ROUNDING = 1e-12
"""Smallest standard deviation, relative to the value: the search has errors of this size."""
_IN_BRACES = re.compile(r"\{([^{}]*)\}")


class PriorTable(Section):
    """Normal prior of a parameter, of its logarithm on a logarithmic scale.

    Attributes
    ----------
    value : Scalar
        Mean of the normal distribution.
    deviation : Spread
        Standard deviation: a quantity, a number or a percentage.
    """

    value: ScalarKey
    deviation: SpreadKey


class ParameterTable(Section):
    """Parameter to be found.

    Attributes
    ----------
    key : str or None
        Path of the key of the case that has its value; None if `CalibrationTable.set` uses it.
    start : Scalar
        First value of the search.
    lower : Scalar
        Lower bound.
    upper : Scalar
        Upper bound.
    scale : str
        ``"log"`` for parameters that are uncertain by a factor.
    prior : PriorTable or None
        Knowledge of the value from elsewhere, as one more measurement.
    """

    key: str | None = None
    start: ScalarKey
    lower: ScalarKey
    upper: ScalarKey
    scale: Literal["linear", "log"] = "linear"
    prior: PriorTable | None = None

    @model_validator(mode="after")
    def _in_one_unit(self):
        try:
            low, high = (bound.in_unit_of(self.start) for bound in (self.lower, self.upper))
        except ValueError as error:
            raise KeyFault("upper", f"{error}, the unit of start") from None
        if not low < high:
            raise KeyFault("upper", "must be greater than lower")
        if not low <= self.start.number <= high:
            raise KeyFault("start", "must lie between lower and upper")
        if self.scale == "log" and not low > 0.0:
            raise KeyFault("lower", "must be greater than 0 on a logarithmic scale")
        if self.prior is not None:
            self._check_prior(self.prior)
        return self

    def _check_prior(self, prior: PriorTable) -> None:
        try:
            mean = prior.value.in_unit_of(self.start)
            deviation = prior.deviation.of(replace(self.start, number=mean))
        except ValueError as error:
            raise KeyFault("prior", f"{error}, the unit of start") from None
        if not deviation > 0.0:
            raise KeyFault("prior.deviation", "must be greater than 0; a percentage of 0 is 0")
        if deviation < ROUNDING * max(abs(mean), abs(self.start.number)):
            raise KeyFault("prior.deviation", f"is below the rounding of numbers, {ROUNDING:g}")
        if self.scale == "log" and not mean > 0.0:
            raise KeyFault("prior.value", "must be greater than 0 on a logarithmic scale")


class ObservationTable(Section):
    """Measured data, and the quantity that they correspond to.

    Attributes
    ----------
    file : str or None
        CSV file; None if the command names it (``--data NAME=FILE``).
    quantity : str or None
        Name of the quantity in the results; by default the name of the column.
    contact : str or None
        Contact of a model of several bodies.
    deviation : Spread or None
        Standard deviation where the file has no column for it.
    set : dict
        Keys of the case that had other values in this measurement.
    """

    file: UserFile | None = None
    quantity: str | None = None
    contact: str | None = None
    deviation: SpreadKey | None = None
    set: dict[str, Any] = {}


class PosteriorTable(Section):
    """Sampling of the posterior distribution by an ensemble sampler.

    Attributes
    ----------
    walkers : int or None
        Number of walkers, even, two for each parameter at least; by default four, at least 16.
    steps : int
        Steps of each walker.
    seed : int
        Seed of the random numbers.
    """

    walkers: Annotated[int, Field(ge=4, le=1000, multiple_of=2, strict=True)] | None = None
    steps: Annotated[int, Field(ge=10, le=100_000, strict=True)] = 1000
    seed: Annotated[int, Field(ge=0, strict=True)] = 1


class CalibrationTable(Section):
    """Calibration of parameters.

    Attributes
    ----------
    parameters : dict of str to ParameterTable
        Parameters by short names.
    set : dict of str to str
        Values of further keys, with names of parameters in braces: ``"{k} 1/MPa^{b}"``.
    observations : dict of str to ObservationTable
        Measurements, by name.
    deviations : str
        ``"known"``, or ``"estimated"`` from the scatter: those given are then relative weights.
    tolerance : float
        Distance from the optimum in standard errors at which the search ends.
    max_evaluations : int
        Largest number of evaluations of the predictions, besides those for derivatives.
    confidence : float
        Level of the intervals.
    posterior : PosteriorTable or None
        Sampling of the posterior distribution by a Markov chain; without it the intervals follow
        from the linearised model.
    """

    parameters: Annotated[dict[str, ParameterTable], Field(min_length=1)]
    set: dict[str, str] = {}
    observations: dict[str, ObservationTable] = {}
    deviations: Literal["known", "estimated"] = "known"
    tolerance: Annotated[Number, Field(gt=0.0, le=0.1)] = 1e-3
    max_evaluations: Annotated[int, Field(ge=1, le=100_000, strict=True)] = 100
    confidence: Percentage = 0.95
    posterior: PosteriorTable | None = None

    @model_validator(mode="after")
    def _parameters_are_used(self):
        used = {name for text in self.set.values() for name in _IN_BRACES.findall(text)}
        for name, parameter in self.parameters.items():
            if not _NAME.fullmatch(name):
                text = 'must be a short name, such as k; its key is given by key = "wear.…"'
                raise KeyFault(f"parameters.{name}", text)
            if parameter.key is None and name not in used:
                text = "missing; or use the parameter in calibrate.set"
                raise KeyFault(f"parameters.{name}.key", text)
        for key, text in self.set.items():
            unknown = sorted(set(_IN_BRACES.findall(text)) - self.parameters.keys())
            if unknown:
                raise KeyFault(f"set.{key}", f"{{{unknown[0]}}} is not a parameter")
        keys = [*self.set, *(p.key for p in self.parameters.values() if p.key is not None)]
        twice = [key for key in keys if keys.count(key) > 1]
        if twice:
            raise KeyFault("set", f"{twice[0]} is set twice")
        return self

    @model_validator(mode="after")
    def _enough_walkers(self):
        walkers = None if self.posterior is None else self.posterior.walkers
        least = 2 * len(self.parameters)
        if walkers is not None and walkers < least:
            raise KeyFault("posterior.walkers", f"must be {least} at least, two for each parameter")
        return self

    def overrides(self, values: dict[str, float]) -> tuple[str, ...]:
        """Changes ``KEY=VALUE`` of the case for values of the parameters, in the units of start."""
        found = []
        for name, table in self.parameters.items():
            if table.key is not None:
                found.append(Scalar(values[name], table.start.unit).override(table.key))
        for key, text in self.set.items():
            filled = _IN_BRACES.sub(lambda m: repr(values[m[1]]), text)
            bare = _IN_BRACES.fullmatch(text) is not None
            found.append(f"{key}={filled}" if bare else f'{key}="{filled}"')
        return tuple(found)
