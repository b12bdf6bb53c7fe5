"""Operators of heat for small changes of the temperature, and where they were made.

They cost a factorisation: Newton's method keeps them as long as its steps go on getting smaller.
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
    """Heat of bodies whose properties change, as its tangents need it."""

    def condensed(self, conduction: Conduction, face: InterfaceHeat) -> ThermalDistortion:
        """Thermal distortion condensed to the pressure space; every rank calls."""

    def gap_per_rise(self, rise: np.ndarray) -> np.ndarray:
        """Weak gap per small change of a nodal rise, shape (n_owned, m) [m³/K]."""

    def tangent(self, rise: np.ndarray, step: float | None) -> TangentOperators:
        """Operators for small changes of a rise (n_owned,); every rank calls."""


@serialisable
@dataclass(frozen=True)
class LastTangents:
    """Where the operators that are at hand were made: Newton's method goes its way by them.

    Attributes
    ----------
    steps : dict of float to (ndarray or None)
        Rise (n_owned,) by size of step, the one that was used last at the end [K].
    steady : tuple or None
        Likewise of the steady state, its last temperatures, and by how much they changed.
    """

    steps: dict[float, np.ndarray | None]
    steady: tuple[np.ndarray | None, np.ndarray, float] | None


class TangentOperators(HeatOperators):
    """Conduction of small changes of the temperature, condensed to the interface.

    Parameters
    ----------
    conduction : Conduction
    face : InterfaceHeat
    heat : ChangingHeat
    reference : ndarray, shape (n_owned,)
        The rise that they are changes of [K].
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
        """Weak gap per nodal rise, shape (n_owned, m) [m³/K]."""
        return self._varying.gap_per_rise(self.reference)

    @cached_property
    def distortion(self) -> ThermalDistortion:
        return condense_distortion(self.conduction, self.per_rise, self.face)


class Tangents:
    """The operators that were used last, for one size of step or for a steady state.

    Parameters
    ----------
    heat : ChangingHeat
    step : float or None
        [s]
    reference : ndarray, optional, shape (n_owned,)
        Rise that the first ones are made for [K].

    Attributes
    ----------
    reference : ndarray or None
        That of the last ones.
    """

    reference: np.ndarray | None

    def __init__(self, heat: ChangingHeat, step: float | None, reference: np.ndarray | None = None):
        self.reference = reference
        self._heat = heat
        self._step = step
        self._last: TangentOperators | None = None

    def near(self, rise: np.ndarray) -> TangentOperators:
        """Those at hand; made for a rise (n_owned,) where there are none."""
        return self._last or self.at(rise if self.reference is None else self.reference)

    def at(self, rise: np.ndarray) -> TangentOperators:
        """New ones for a rise."""
        self.reference, self._last = rise, self._heat.tangent(rise, self._step)
        return self._last
