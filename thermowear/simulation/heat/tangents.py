"""Tangent operators of nonlinear conduction, and the temperatures of their linearisation.

Each needs a factorisation: Newton's method reuses it while its increments keep decreasing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...contact.operators.heat import InterfaceHeat
from ...contact.operators.heat_condensation import ThermalDistortion, condense_distortion
from ...serialise import serialisable
from .heat_stages import HeatOperators


class ChangingHeat(Protocol):
    """Heat with temperature-dependent properties: interface to its tangents."""

    def condensed(self, conduction: Conduction, face: InterfaceHeat) -> ThermalDistortion:
        """Thermal distortion condensed to the pressure space; every rank calls."""

    def gap_per_rise(self, rise: np.ndarray) -> np.ndarray:
        """Derivative of the weak gap by a nodal rise, shape (n_owned, m) [m³/K]."""

    def tangent(self, rise: np.ndarray, step: float | None) -> TangentOperators:
        """Tangent operators at a rise (n_owned,); every rank calls."""


@serialisable
@dataclass(frozen=True)
class LastTangents:
    """Linearisation points of the cached tangents, which the Newton iterates depend on.

    Attributes
    ----------
    steps : dict of float to (ndarray or None)
        Rise (n_owned,) by step size, the last used at the end [K].
    steady : tuple or None
        Linearisation point of the steady state, its last temperatures, and their last change.
    """

    steps: dict[float, np.ndarray | None]
    steady: tuple[np.ndarray | None, np.ndarray, float] | None


class TangentOperators(HeatOperators):
    """Linearised conduction, condensed to the interface.

    Parameters
    ----------
    conduction : Conduction
    face : InterfaceHeat
    heat : ChangingHeat
    reference : ndarray, shape (n_owned,)
        Rise at which the conduction is linearised [K].
    """

    def __init__(
        self,
        conduction: Conduction,
        face: InterfaceHeat,
        heat: ChangingHeat,
        reference: np.ndarray,
    ):
        super().__init__(conduction, face, heat.condensed)
        self.reference = reference
        self._varying = heat

    @cached_property
    def per_rise(self) -> np.ndarray:
        """Derivative of the weak gap by the nodal rise, shape (n_owned, m) [m³/K]."""
        return self._varying.gap_per_rise(self.reference)

    @cached_property
    def distortion(self) -> ThermalDistortion:
        return condense_distortion(self.conduction, self.per_rise, self.face)


class Tangents:
    """Cache of the last tangent operators for one step size or for the steady state.

    Parameters
    ----------
    heat : ChangingHeat
    step : float or None
        Step size [s]; None: steady state.
    reference : ndarray, optional, shape (n_owned,)
        Linearisation point of the first operators [K].

    Attributes
    ----------
    reference : ndarray or None
        Linearisation point of the last operators.
    """

    reference: np.ndarray | None

    def __init__(self, heat: ChangingHeat, step: float | None, reference: np.ndarray | None = None):
        self.reference = reference
        self._heat = heat
        self._step = step
        self._last: TangentOperators | None = None

    def near(self, rise: np.ndarray) -> TangentOperators:
        """Return the cached operators; make them for a rise (n_owned,) if there are none."""
        return self._last or self.at(rise if self.reference is None else self.reference)

    def at(self, rise: np.ndarray) -> TangentOperators:
        """Make and cache operators for a rise (n_owned,)."""
        self.reference, self._last = rise, self._heat.tangent(rise, self._step)
        return self._last
