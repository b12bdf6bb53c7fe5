"""Layers of the wearing faces in the results: what is left of them, and when they are lost."""

from __future__ import annotations

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


def times_worn_through(
    system: System, conditions: InterfaceConditions, state: InterfaceState, time: float
) -> dict[int, float]:
    """Times at which the first points of the faces have lost all their layers, by body index [s].

    Follows from the depth below the layers at the present rate of the substrate: exact at constant
    rates, otherwise as accurate as the time step. Bodies that have not are left out.

    Parameters
    ----------
    system : System
    conditions : InterfaceConditions
    state : InterfaceState
        State at the end of the time step in which it happens.
    time : float
        End of that step [s].
    """
    laws, spreads = list(system.laws.values()), list(system.spreads.values())
    rates = WearRates(laws, spreads, conditions.wear, conditions.states)
    found = {}
    for row, index in enumerate(system.laws):
        each = layers_of(laws[row])
        below = state.worn[row] - each.total
        passed = below >= 0.0
        if each.thickness and passed.any():
            rate = rates.by(each.substrate, row, state.pressure)[passed]
            since = below[passed] / np.where(rate > 0.0, rate, np.inf)
            found[index] = time - float(since.max())
    return found
