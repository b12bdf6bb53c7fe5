"""Transfer of wear and temperatures to moved meshes, and the change that an update causes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...bulk.points import transferred
from ..interface.sdirk import InterfaceState
from ..system.system import System

_FADED = 0.1
"""Smallest reference pressure of a change, as a fraction of the largest so far."""


def change_by_update(after: System, state: InterfaceState, found: InterfaceState) -> float:
    """Largest relative change of pressure and temperature rise at an interface by an update.

    Area means; reference pressures are at least `_FADED` times the largest pressure so far.
    """
    fields = [(state.pressure, found.pressure, _FADED * state.largest)]
    if state.faces is not None and found.faces is not None:
        rises = zip(state.faces.rise, found.faces.rise, strict=True)
        fields += [(old, new, 0.0) for old, new in rises]
    assert after.worn is not None
    changes = [0.0]
    for old, new, least in fields:
        expected = after.worn.carried(old, after.contacts)
        reference, change = np.maximum(np.abs(expected), least), np.abs(new - expected)
        for own in after.contacts.ranges:
            scale = float(after.weights[own] @ reference[own])
            if scale > 0.0:
                changes.append(float(after.weights[own] @ change[own]) / scale)
    return max(changes)


def carried_wear(before: System, after: System, worn: np.ndarray) -> tuple[np.ndarray, float]:
    """Volume-preserving transfer of worn depths (n_wearing, n) to the moved mesh [m].

    Also returns the relative volume correction that this needed.
    """
    assert after.worn is not None
    sides = list(after.laws)
    in_mesh = np.concatenate([contact.depth for contact in after.worn.contacts], axis=1)[sides]
    # the small rest in the gap matters most: carry it separately from the part in the mesh
    left = after.worn.carried(worn - in_mesh, after.contacts)
    rows = after.worn.carried(in_mesh, after.contacts) + left
    error = 0.0
    for index, (old, new) in enumerate(
        zip(before.contacts.ranges, after.contacts.ranges, strict=True)
    ):
        for row, side, depth in zip(rows[:, new], sides, worn[:, old], strict=True):
            kept, keeps = depth - before.moved[side, old], row - after.moved[side, new]
            had = kept @ before.weights[old] + before.lost[index, side]
            has = keeps @ after.weights[new] + after.lost[index, side]
            if had > 0.0:
                row *= 1.0 + (had - has) / (row @ after.weights[new])
                error = max(error, float(abs(had - has) / had))
    return rows, error


def carried_growth(before: System, after: System, grown: np.ndarray) -> np.ndarray:
    """Volume-preserving transfer of the wear of a step (n_wearing, n) to the moved mesh [m]."""
    assert after.worn is not None
    return with_volumes(before, grown, after, after.worn.carried(grown, after.contacts))


def with_volumes(before: System, grown: np.ndarray, after: System, rows: np.ndarray) -> np.ndarray:
    """Depths (n_wearing, n) of a system, scaled to the volumes of those of another one [m]."""
    sides, result = list(after.laws), rows.copy()
    areas = before.worn_areas[sides], after.worn_areas[sides]
    for old, new in zip(before.contacts.ranges, after.contacts.ranges, strict=True):
        had = (areas[0] * grown)[:, old].sum(axis=1)
        has = (areas[1] * rows)[:, new].sum(axis=1)
        kept = np.divide(had, has, out=np.ones_like(has), where=has > 0.0)
        result[:, new] *= kept[:, None]
    return result


def carried_rise(before: System, after: System, rise: np.ndarray) -> tuple[np.ndarray, float]:
    """Temperature rise of the bodies transferred to the moved mesh [K], and its error."""
    assert before.thermal is not None
    assert after.thermal is not None
    return transferred(
        rise,
        before.thermal.conduction.spaces,
        after.thermal.conduction.spaces,
        before.bodies,
        after.bodies,
    )


def with_carried_fluxes(
    after: System, state: InterfaceState, found: InterfaceState
) -> InterfaceState:
    """State with the heat fluxes of that before the update, where they follow from a time step."""
    if state.stored is None or state.faces is None or found.faces is None:
        return found
    assert after.worn is not None
    into_1, into_2 = (after.worn.carried(flux, after.contacts) for flux in state.faces.flux)
    return replace(found, faces=replace(found.faces, flux=(into_1, into_2)))
