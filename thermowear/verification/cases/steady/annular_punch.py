"""Ring on a plate (special case 8): steady state, running-in, and a change of conditions."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ....reference import annular_punch as reference
from ....results import Result
from ...check import Check, along, compare, compare_each, computed, run_starter, starter
from .finite_elements import away_from_ends

TABLE = "converged tables of degree 8 to 10 on other meshes"
IN_TIME = "time-exact running-in with two other pressure spaces in agreement"
CLOSED_FORM = "Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, special case 8"
INNER, OUTER, FRICTION, AMBIENT = 0.02, 0.12, 0.25, 293.15
FORCE = 50e6 * np.pi * (OUTER**2 - INNER**2)
DEPTH_RADII = np.array([0.025, 0.07, 0.115])
_HOT, _COLD = "annular-punch", "annular-punch-running-in"


def annular_punch() -> Iterator[Check]:
    """Steady worn shape, pressure, temperature and power for b = 1, 2 and 0.5, cold and hot."""
    for b, speed in reference.STEADY_SHAPE:
        result = steady(b, speed)
        yield from _shape(result, b, speed)
        exact = reference.steady_pressure(result.interface.x, FORCE, INNER, OUTER, b)
        worst = int(np.abs(result.interface.pressure / exact - 1).argmax())
        quantity = f"pressure at the point of largest deviation, {_state(b, speed)} [Pa]"
        yield compare(quantity, result.interface.pressure[worst], exact[worst], 1e-6, CLOSED_FORM)
        if (b, speed) == (1.0, 0.1):
            yield from _heat(result)


def steady(b: float, speed: float) -> Result:
    """Starter case with another pressure exponent; speed 0 means without heat."""
    overrides = (f"wear.punch.pressure_exponent={b}", f'wear.punch.coefficient="2e-7 1/MPa^{b}"')
    return run_starter(_HOT, *overrides, without=() if speed else ("heat",))


def _shape(result: Result, b: float, speed: float) -> Iterator[Check]:
    """Height of the worn face relative to that at r = 70 mm, scaled by its range."""
    interface = result.interface
    heights = along(interface, reference.RADII, interface.shape)
    heights = 1e3 * (heights - along(interface, 0.07, interface.shape))
    expected = np.array(reference.STEADY_SHAPE[b, speed])
    for r, found, known in zip(reference.RADII, heights, expected, strict=True):
        if r != 0.07:
            quantity = f"shape at r = {1e3 * r:g} mm, {_state(b, speed)} [mm]"
            allowed = 2e-3 if r in (INNER, OUTER) else 5e-4
            yield compare(quantity, found, known, allowed, TABLE, scale=np.ptp(expected))


def _heat(result: Result) -> Iterator[Check]:
    interface, quantity = result.interface, "temperature rise at r = {:g} mm, b = 1, hot [K]"
    rises = along(interface, reference.RADII, interface.temperature_1 - AMBIENT)
    known = reference.TEMPERATURE_RISE
    yield from compare_each(quantity, 1e3 * reference.RADII, rises, known, 5e-4, TABLE)
    power = 0.1 * reference.uniform_wear_torque(FORCE, FRICTION, INNER, OUTER)
    found = result.summary["friction_power_W"]
    yield compare("friction power, b = 1, hot [W]", found, power, 1e-6, CLOSED_FORM)


def _state(b: float, speed: float) -> str:
    return f"b = {b:g}, {'hot' if speed else 'cold'}"


def running_in() -> Iterator[Check]:
    """Pressures, depths and volumes in time of a flat ring, on matching and other meshes."""
    plate = ("mesh.bodies.plate.elements=17", "mesh.bodies.plate.grading=0.45")
    for note, mesh, allowed in (("", (), 2e-3), (", not matching", plate, 5e-3)):
        result = run_starter(_COLD, *mesh)
        states = result.outputs | {result.history[-1].time: result.interface}
        for time, (pressures, depths, volume) in reference.RUNNING_IN.items():
            i = states[time]
            radii = reference.RUNNING_IN_RADII
            quantity = f"pressure at {time} s, r = {{:g}} mm{note} [MPa]"
            found = along(i, radii, i.pressure) / 1e6
            yield from compare_each(quantity, 1e3 * radii, found, pressures, allowed, IN_TIME)
            quantity = f"wear depth at {time} s, r = {{:g}} mm{note} [µm]"
            found = along(i, DEPTH_RADII, i.wear_1) * 1e6
            yield from compare_each(quantity, 1e3 * DEPTH_RADII, found, depths, allowed, IN_TIME)
            lost = i.weight @ i.wear_1 * 1e9
            yield compare(f"volume at {time} s{note} [mm³]", lost, volume, 5e-4, IN_TIME)


def story() -> Iterator[Check]:
    """Change of exponent and load, then friction heat: pressures and wear rates at the ends.

    It starts from the steady shape for b = 2 and 100 MPa and continues with b = 1 and 50 MPa, then
    with friction heat. The final shapes differ; the pressure is the closed form in both cases.
    """
    first = run_starter(
        _COLD,
        "wear.punch.pressure_exponent=2.0",
        "wear.punch.coefficient=2e-7 1/MPa^2",
        "load.mean_pressure=100 MPa",
        "analysis={type='steady'}",
    )
    second = _continued(_COLD, first)
    third = _continued(_HOT, second)
    for name, result in (("cold", second), ("then hot", third)):
        inner = away_from_ends(starter(_COLD), result)
        exact = reference.steady_pressure(result.interface.x, FORCE, INNER, OUTER, 1.0)
        off = np.abs(result.interface.pressure / exact - 1.0)[inner]
        worst = np.flatnonzero(inner)[off.argmax()]
        quantity = f"from the shape of b = 2, 100 MPa, with b = 1, 50 MPa, {name}: pressure [Pa]"
        yield compare(quantity, result.interface.pressure[worst], exact[worst], 1e-3, CLOSED_FORM)
        steps = result.history[-3:]
        volumes, times = np.diff([(row.wear_volume_1, row.time) for row in steps], axis=0).T
        begun, ended = volumes / times
        quantity = f"{name}: second difference of the worn volume, over the first, at the end [1]"
        yield compare(quantity, ended / begun - 1.0, 0.0, 1e-3, "steady wear rate", scale=1.0)


def _continued(name: str, before: Result) -> Result:
    """Running-in from the worn shape of another run."""
    on = "analysis={type='transient', until='steady', steady_tolerance=2e-4, tolerance=1e-3}"
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "shape.csv"
        table = np.column_stack([before.profile.s, before.profile.shape])
        np.savetxt(file, table, delimiter=",", header="s_m,shape_m", comments="", fmt="%.17g")
        return computed(starter(name, on, f"geometry.initial_shape={str(file)!r}"))
