"""Running-in of a flat ring without heat, on matching and on non-matching meshes."""

from __future__ import annotations

from collections.abc import Iterator

from ...reference import annular_punch as reference
from ...results import Result
from ..check import Check, along, compare
from ..starter import run_starter

TABLE = "time-exact running-in with two other pressure spaces in agreement"
DEPTH_RADII = (0.025, 0.07, 0.115)


def checks() -> Iterator[Check]:
    """Pressures, depths and volumes at all tabulated times."""
    matching = run_starter("annular-punch-running-in")
    yield from _against_table(matching, "", 2e-3)
    other = run_starter(
        "annular-punch-running-in",
        "mesh.bodies.plate.elements=17",
        "mesh.bodies.plate.grading=0.45",
    )
    yield from _against_table(other, ", not matching", 5e-3)


def _against_table(result: Result, note: str, allowed: float) -> Iterator[Check]:
    states = result.outputs | {result.history[-1].time: result.interface}
    for time, (pressures, depths, volume) in reference.RUNNING_IN.items():
        state = states[time]
        found = along(state, reference.RUNNING_IN_RADII, state.pressure) / 1e6
        for r, p, known in zip(reference.RUNNING_IN_RADII, found, pressures, strict=True):
            quantity = f"pressure at {time} s, r = {1e3 * r:g} mm{note} [MPa]"
            yield compare(quantity, p, known, allowed, TABLE)
        worn = along(state, DEPTH_RADII, state.wear_1) * 1e6
        for depth_r, w, known in zip(DEPTH_RADII, worn, depths, strict=True):
            quantity = f"wear depth at {time} s, r = {1e3 * depth_r:g} mm{note} [µm]"
            yield compare(quantity, w, known, allowed, TABLE)
        lost = state.weight @ state.wear_1 * 1e9
        yield compare(f"volume at {time} s{note} [mm³]", lost, volume, 5e-4, TABLE)
