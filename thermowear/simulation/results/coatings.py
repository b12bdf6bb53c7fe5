"""Layers of the wearing faces in the results: what is left of them, and when they are lost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contact.wear.implicit_step import WearRates
from ...laws.layered_wear import LayeredWear, layers_of
from ..interface.sdirk import InterfaceState
from ..system.conditions import InterfaceConditions
from ..system.system import System


def layers(system: System) -> dict[int, LayeredWear]:
    """Layers of the coated faces by the index of the body (0 is body 1)."""
    found = {index: layers_of(law) for index, law in system.laws.items()}
    return {index: each for index, each in found.items() if each.thickness}


def coating_left(system: System, worn: np.ndarray) -> np.ndarray:
    """Thickness left of all layers at worn depths (2, n) [m]; NaN for a body without layers."""
    left = np.full(worn.shape, np.nan)
    for index, each in layers(system).items():
        left[index] = np.maximum(each.total - worn[index], 0.0)
    return left


def layer_volumes(system: System, worn: np.ndarray, volumes: np.ndarray) -> dict[str, list[float]]:
    """Summary entries of the volumes worn of each layer and of the substrate [m³].

    Parameters
    ----------
    system : System
    worn : ndarray, shape (2, n)
        Wear depths [m].
    volumes : ndarray, shape (2,)
        Worn volumes. Those of the layers are fractions of them by the depths at the points, whose
        areas have changed slightly on moved meshes [m³].
    """
    found = {}
    for index, each in layers(system).items():
        parts = each.worn(worn[index]) @ system.worn_areas[index]
        scale = volumes[index] / parts.sum() if parts.any() else 1.0
        found[f"layer_volumes_{index + 1}_m3"] = [float(scale * part) for part in parts]
    return found


@dataclass(frozen=True)
class WearingState:
    """State of the interface under its conditions."""

    state: InterfaceState
    conditions: InterfaceConditions


def times_since_worn_through(
    system: System, now: WearingState, before: WearingState | None, step: float
) -> dict[int, float]:
    """Times since the first points of the faces have lost all layers, by body index [s].

    Follow from the depth below the layers at the rate of the substrate, which is taken to change
    linearly in the step, or to be that of its end if the beginning is not known. Bodies that have
    not lost their layers at any point are left out.

    Parameters
    ----------
    system : System
    now : WearingState
        At the end of the time step.
    before : WearingState or None
        At its beginning.
    step : float
        [s]
    """
    found = {}
    for row, index in enumerate(system.laws):
        each = layers_of(system.laws[index])
        below = now.state.worn[row] - each.total
        if each.thickness and step > 0.0 and np.any(below >= 0.0):
            end = _substrate_rate(system, now, row)
            begin = end if before is None else _substrate_rate(system, before, row)
            # r_end t - (r_end - r_begin) t²/2 step = depth below the layers
            root = np.sqrt(np.maximum(end**2 - 2 * (end - begin) * below / step, 0.0))
            since = np.zeros_like(below)
            np.divide(2 * below, end + root, out=since, where=(below > 0.0) & (end > 0.0))
            found[index] = min(float(since.max()), step)
    return found


def _substrate_rate(system: System, at: WearingState, row: int) -> np.ndarray:
    """Wear rate of the substrate of a wearing body, shape (n,) [m/s]."""
    laws, spreads, conditions = list(system.laws.values()), system.spreads, at.conditions
    rates = WearRates(laws, list(spreads.values()), conditions.wear, conditions.states)
    return rates.by(layers_of(laws[row]).substrate, row, at.state.pressure)
