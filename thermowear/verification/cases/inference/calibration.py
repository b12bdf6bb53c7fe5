"""Calibration of cases by measured depths: Cruzado's scars, and parameters that act together.

The scars of three tests of the block on a ring give its wear coefficient. The depth of a groove
that conforms to the ring is proportional to ``k^(2/3)``, so that the relative error of k is 3/2 of
that of the mean depth.

Blocks under uniform pressure wear by ``k mu p s``, or by ``k p^b s``, from the start on. Depths
under one pressure determine neither k and mu nor k and b, but these products; depths under two
pressures determine k and b.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import log, sqrt

import numpy as np

from ....calibration.candidate_run import InProcess
from ....calibration.measurement import Measurement
from ....calibration.problem import Problem
from ....calibration.readings import reading
from ....calibration.solution import Calibration, solve
from ....reference.elastic_contact.growing_contact import growing_line
from ....simulation.analyses.run import Series
from ...check import Check, compare, compare_each, starter
from ..contact.hertz import MODULUS
from ..wear.geometry_updates import PRESS, RADIUS
from ..wear.growing import RIGID

DEPTHS = np.array([46.3e-6, 44.5e-6, 48.7e-6])
"""Depths of the scars after `DISTANCE` (Cruzado et al., rope wires) [m]."""
DISTANCE, DEVIATION = 3600.0, 2.1e-6
COEFFICIENT, FRICTION, EXPONENT, SPEED = 2e-8, 0.3, 1.4, 0.1
"""Wear coefficient for pressures in MPa, friction, exponent, and speed of the blocks [m/s]."""
PRESSURES = 5.0, 20.0
"""Pressures on the blocks [MPa]."""
SCATTER, TIMES = 0.05, np.array([40.0, 70.0, 100.0])
_COARSE = (
    "mesh.elements=30",
    "wear.update=0.004",
    "analysis.tolerance=1e-2",
    "analysis.output_times=[]",
)
_FLAT = (
    'analysis={type="transient", end_time="100 s"}',
    "mesh.degree=1",
    "mesh.elements=2",
    "calibrate.tolerance=1e-6",
)
_LOG = 'scale="log"'
_SCARS = f"{RIGID}, for the mean of the measured depths"
_EXACT = "closed form, linear in the logarithms"


def calibration() -> Iterator[Check]:
    """Wear coefficient by scars; combinations that one load determines, and fits by two."""
    yield from _scars()
    yield from _friction()
    yield from _exponent()


def _scars() -> Iterator[Check]:
    """Fit of the wear coefficient of the block on a ring to three depths at the end."""
    bounds = 'start="1e-9 1/MPa", lower="1e-11 1/MPa", upper="1e-7 1/MPa"'
    key = f'calibrate.parameters.k={{key="wear.block.coefficient", {bounds}, {_LOG}}}'
    at = {"sliding_distance": np.full(len(DEPTHS), DISTANCE)}
    scars = _measured("max_wear_2", at, DEPTHS, np.full(len(DEPTHS), DEVIATION))
    found = _solved(starter("block-on-ring", *_COARSE, key), [scars])
    mean = float(DEPTHS.mean())
    law = growing_line(PRESS, RADIUS, MODULUS, 1.0)  # the rate is proportional to k
    exact = 1e6 * (sqrt(2 * RADIUS * mean) ** 3 - law.start**3) / (3 * law.rate * DISTANCE)
    yield compare("wear coefficient of the block [1/MPa]", found.values["k"], exact, 1e-2, _SCARS)
    error = 1.5 * DEVIATION / sqrt(len(DEPTHS)) / mean
    quantity = "relative standard error of the coefficient [1]"
    yield compare(quantity, found.standard_errors["k"], error, 2e-2, _SCARS)
    error *= float(DEPTHS.std(ddof=1)) / DEVIATION
    quantity = "relative standard error of the coefficient, deviation by the scatter [1]"
    yield compare(quantity, found.fit.scattered.standard_errors[0], error, 2e-2, _SCARS)


def _friction() -> Iterator[Check]:
    """Fit of k and mu: only ``k mu`` is determined."""
    exact = COEFFICIENT * FRICTION
    keys = (
        _parameter("k", 1e-8, 1e-10, 1e-6, _LOG, 'key="wear.upper.coefficient"', unit=" 1/MPa"),
        _parameter("mu", 0.2, 0.05, 0.9, _LOG, 'key="contact.friction"'),
    )
    found = _solved(starter("stacked-blocks", *_FLAT, *keys, without=("heat",)), [_depths(exact)])
    yield _undetermined("k and mu", found, 1)
    (combination,) = found.identifiability.combinations
    quantity = "exponent of mu in the combination [1]"
    yield compare(quantity, combination.coefficients[1], 1.0, 1e-6, _EXACT)
    quantity, deviation = "relative standard deviation of k mu [1]", SCATTER / sqrt(len(TIMES))
    yield compare(quantity, combination.deviation, deviation, 1e-6, _EXACT)
    yield compare("k mu [1/MPa]", float(combination.value(found.fit.values)), exact, 1e-6, _EXACT)


def _exponent() -> Iterator[Check]:
    """Fit of k and b: one pressure determines ``k p^b``, two determine both."""
    keys = (
        'wear.upper.per="pressure"',
        _parameter("k", 1e-8, 1e-10, 1e-6, _LOG),
        _parameter("b", 1.1, 0.5, 3.0),
        'calibrate.set={"wear.upper.coefficient"="{k} 1/MPa^{b}", '
        '"wear.upper.pressure_exponent"="{b}"}',
    )
    case = starter("stacked-blocks", *_FLAT, *keys, without=("heat",))
    each = [_depths(COEFFICIENT, EXPONENT, pressure) for pressure in PRESSURES]
    found = _solved(case, each[:1])
    yield _undetermined("k and b", found, 1)
    (combination,) = found.identifiability.combinations
    quantity = "logarithm of the base of b in the combination [1]"
    yield compare(quantity, combination.coefficients[1], log(PRESSURES[0]), 1e-5, _EXACT)
    found = _solved(case, each)
    yield _undetermined("k and b, two pressures", found, 0)
    quantity = "fitted {} [1]"
    known = COEFFICIENT, EXPONENT
    yield from compare_each(quantity, "kb", found.fit.values, known, 1e-6, _EXACT)
    deviation, ratio = SCATTER / sqrt(len(TIMES)), log(PRESSURES[1] / PRESSURES[0])
    logs = [log(pressure) for pressure in PRESSURES]
    errors = deviation * sqrt(sum(x**2 for x in logs)) / ratio, deviation * sqrt(2) / ratio
    quantity, places = "standard error of {} by two pressures [1]", ("ln k", "b")
    computed = found.fit.standard_errors
    yield from compare_each(quantity, places, computed, errors, 1e-5, _EXACT)


def _parameter(name: str, *numbers: float | str, unit: str = "") -> str:
    """Override that makes a parameter of a start, its bounds, and further keys."""
    values = zip(("start", "lower", "upper"), numbers[:3], strict=True)
    keys = [f'{key}="{value!r}{unit}"' if unit else f"{key}={value!r}" for key, value in values]
    return f"calibrate.parameters.{name}={{{', '.join([*keys, *map(str, numbers[3:])])}}}"


def _depths(coefficient: float, exponent: float = 1.0, pressure: float = PRESSURES[0]):
    """Exact depths of the upper block under a pressure [MPa], with relative deviations."""
    depths = coefficient * pressure**exponent * SPEED * TIMES
    changes = (f'load.mean_pressure="{pressure} MPa"',)
    return _measured("max_wear_1", {"time": TIMES}, depths, SCATTER * depths, changes)


def _measured(
    name: str,
    at: dict[str, np.ndarray],
    values: np.ndarray,
    deviations: np.ndarray,
    changes: tuple[str, ...] = (),
) -> Measurement:
    quantity = reading(name, at, len(values), None, {})
    return Measurement("depth", quantity, values, deviations, changes)


def _solved(case, measurements: Sequence[Measurement]) -> Calibration:
    return solve(Problem.of(case, measurements), InProcess(Series()))


def _undetermined(which: str, found: Calibration, known: int) -> Check:
    quantity = f"undetermined directions, {which} [1]"
    computed = found.identifiability.null.shape[1]
    return compare(quantity, computed, known, 0.0, _EXACT, 1.0)
