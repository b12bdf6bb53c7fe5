"""Layers of the wearing faces in the results: what is left of them, and when they are lost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from ...contact.wear.implicit_step import WearRates
from ...laws.wear import LayeredWear, layers_of
from ...model.face_wear import FaceWear
from ...model.model import Model
from ..interface.sdirk import InterfaceState
from ..system.conditions import InterfaceConditions
from ..system.system import System

Face: TypeAlias = "tuple[int, int]"
"""Index of an interface, and of one of its faces (0 is that of its first body)."""


def layers(model: Model) -> dict[Face, LayeredWear]:
    """Layers of the coated faces."""
    return {
        (index, side): layers_of(wear.law)
        for index, interface in enumerate(model.interfaces)
        for side, wear in interface.wear.items()
        if isinstance(wear, FaceWear) and wear.has_layers
    }


def coating_left(system: System, worn: np.ndarray) -> np.ndarray:
    """Thickness left of all layers at worn depths (2, n) [m]; NaN for a body without layers."""
    left = np.full(worn.shape, np.nan)
    for index, side in layers(system.model):
        own, law = system.contacts.ranges[index], _law_at(system, index, side)
        rest = law.total - law.worn(worn[side, own])[:-1].sum(axis=0)
        left[side, own] = np.where(worn[side, own] < law.through, np.maximum(rest, 0.0), 0.0)
    return left


def _law_at(system: System, index: int, side: int) -> LayeredWear:
    """Law of the points of a coated side of an interface."""
    law, own = layers_of(system.laws[side]), system.contacts.ranges[index]
    variation = np.broadcast_to(law.variation, len(system.weights))[own]
    return replace(layers(system.model)[index, side], variation=variation)


def layer_volumes(
    system: System, index: int, worn: np.ndarray, volumes: np.ndarray
) -> dict[str, list[float]]:
    """Summary entries of the volumes worn of the layers and substrates of an interface [m³].

    Parameters
    ----------
    system : System
    index : int
        Index of the interface.
    worn : ndarray, shape (2, n)
        Wear depths [m].
    volumes : ndarray, shape (2,)
        Worn volumes. Those of the layers are fractions of them by the depths at the points, whose
        areas have changed slightly on moved meshes [m³].
    """
    found, own = {}, system.contacts.ranges[index]
    for other, side in layers(system.model):
        if other == index:
            depths = _law_at(system, index, side).worn(worn[side, own])
            parts = depths @ system.worn_areas[side, own]
            scale = volumes[side] / parts.sum() if parts.any() else 1.0
            found[f"layer_volumes_{side + 1}_m3"] = [float(scale * part) for part in parts]
    return found


@dataclass(frozen=True)
class WearingState:
    """State of the interface under its conditions."""

    state: InterfaceState
    conditions: InterfaceConditions


def times_since_worn_through(
    system: System, now: WearingState, before: WearingState | None, step: float
) -> dict[Face, float]:
    """Times since the first points of the faces have lost all layers [s].

    Follow from the depth below the layers at the rate of the substrate, which is taken to change
    linearly in the step, or to be that of its end if the beginning is not known. Faces that have
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
    found, rows = {}, list(system.laws)
    for (index, side), each in layers(system.model).items():
        row, own = rows.index(side), system.contacts.ranges[index]
        below = now.state.worn[row, own] - each.total
        if step > 0.0 and np.any(below >= 0.0):
            end = _substrate_rate(system, now, row)[own]
            begin = end if before is None else _substrate_rate(system, before, row)[own]
            # r_end t - (r_end - r_begin) t²/2 step = depth below the layers
            root = np.sqrt(np.maximum(end**2 - 2 * (end - begin) * below / step, 0.0))
            since = np.zeros_like(below)
            np.divide(2 * below, end + root, out=since, where=(below > 0.0) & (end > 0.0))
            found[index, side] = min(float(since.max()), step)
    return found


def _substrate_rate(system: System, at: WearingState, row: int) -> np.ndarray:
    """Wear rate of the substrate of a wearing body, shape (n,) [m/s]."""
    laws, spreads, conditions = list(system.laws.values()), system.spreads, at.conditions
    rates = WearRates(laws, list(spreads.values()), conditions.wear, conditions.states)
    return rates.by(layers_of(laws[row]).substrate, row, at.state.pressure)
