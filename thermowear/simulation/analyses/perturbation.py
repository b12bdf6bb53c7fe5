"""Thermoelastic perturbations of a contact with friction heat: static and growing modes.

Linear, with the thermal conductance of the base state; its own temperatures do not matter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np

from ...contact.operators.heat_exchange import InterfaceHeat
from ...contact.operators.pressure import dense, scaled
from ...errors import CaseError, ComputationError
from ...laws.stability import (
    LoadFree,
    PerturbationMatrices,
    Rate,
    StaticModes,
    leading,
    load_free,
    static_modes,
)
from ..heat.heat_steps import HeatOperators
from ..interface.equilibrium import ContactState
from ..system.building import build
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .growth_model import GrowthModel, PerturbationMode

_REDUCED = 24
"""Number of perturbations most coupled to heat, the basis of growing ones; see `leading`."""
_SLOW, _NEAR = 0.02, 0.3
"""Start of the onset search as part of a speed that is known roughly, or well."""
_SAME, _ITERATIONS = 1e-4, 10
_MOST = 1000
"""Largest number of pressure functions for which any hot state tells its critical speed."""


def static_factor(system: System, contact: ContactState) -> float | None:
    """First static critical speed factor of a hot state, without wear. Every rank calls.

    None where there is none, or where its matrices would cost more than a fraction of a run.
    """
    thermal, heated = system.thermal, contact.conditions.heating.any()
    if thermal is None or not heated or thermal.varies or thermal.conduction.advection is not None:
        return None
    condensed = system.model.method == "condensed" and isinstance(thermal.face, InterfaceHeat)
    at_hand = condensed and not (system.choice.single and system.contacts.in_space)
    if not at_hand or system.basis.shape[1] > _MOST or not contact.pressure.any():
        return None
    try:
        factors = PerturbedContact(system, contact.pressure, contact.conditions).static.factors
    except (ComputationError, np.linalg.LinAlgError):  # a compliance that is no positive operator
        return None
    return float(factors[0]) if len(factors) else None


class PerturbedContact:
    """Perturbations of a contact with a given contact set. Every rank calls.

    Parameters
    ----------
    system : System
        System with a thermal model.
    pressure : ndarray, shape (n,)
        Pressure of the base state [Pa].
    conditions : InterfaceConditions

    Raises
    ------
    CaseError
        If the model has no heat.
    """

    def __init__(self, system: System, pressure: np.ndarray, conditions: InterfaceConditions):
        if system.thermal is None:
            raise CaseError("heat: missing; required in a stability analysis")
        self._system, self._pressure, self._conditions = system, pressure, conditions
        self._thermal_bodies = system.thermal

    @property
    def has_capacity(self) -> bool:
        """True if the heat capacity of the bodies is known, and thus growth rates."""
        return self._thermal_bodies.conduction.capacity is not None

    @property
    def has_advection(self) -> bool:
        """True if a body convects heat: perturbations then move, and no static modes exist."""
        return self._thermal_bodies.conduction.advection is not None

    @cached_property
    def static(self) -> StaticModes:
        """Static modes, each at its own critical speed."""
        return static_modes(self._elastic, self._thermal, self._space)

    def fastest(self, wears: bool) -> PerturbationMode | None:
        """Perturbation with the largest growth rate at the given speed; None if none changes."""
        wear = self._wear(1.0) if wears else None
        return self._refined(lambda small: (1.0, small.fastest(1.0, wear)))

    def onset(self, wears: bool) -> PerturbationMode | None:
        """First perturbation to grow with increasing speed; None if none does."""
        if not self.has_advection:
            return self._onset(wears, _SLOW * float(np.append(self.static.factors, 1.0)[0]))
        # upwind test functions, and the responses in the model, depend on the speed
        found, factor, tried = self._onset(wears, _SLOW), 1.0, []
        for _ in range(_ITERATIONS):
            if found is None or abs(found.factor - 1.0) <= _SAME:
                break
            tried.append((np.log(factor), np.log(found.factor)))
            factor = float(np.exp(_secant(tried)))
            found = self._at(factor)._onset(wears, _NEAR)
        return None if found is None else replace(found, factor=factor * found.factor)

    def _onset(self, wears: bool, start: float) -> PerturbationMode | None:
        wear = self._wear if wears else None

        def find(small: PerturbationMatrices) -> tuple[float, Rate | None]:
            nonlocal start
            factor = small.onset(start, wear)
            if factor is None:
                return 1.0, None
            start = 0.95 * factor
            return factor, small.fastest(factor, wear and wear(factor))

        return self._refined(find)

    def _at(self, factor: float) -> PerturbedContact:
        """Perturbed contact at another speed."""
        model = self._system.model.faster(factor)
        system = build(model, self._system.comm, self._system.phases, parts=self._system.parts)
        conditions = replace(self._conditions, speed=factor * self._conditions.speed)
        return PerturbedContact(system, self._pressure, conditions)

    def _refined(
        self, find: Callable[[PerturbationMatrices], tuple[float, Rate | None]]
    ) -> PerturbationMode | None:
        """Mode by its factor and rate in a refined model, with its shape in the whole space."""

        def mode(small: PerturbationMatrices) -> PerturbationMode | None:
            factor, rate = find(small)
            return None if rate is None else PerturbationMode(factor, rate)

        found = self._model.refined(mode)
        if found is None:
            return None
        shape = self._reduced.pressures @ found.rate.shape
        return replace(found, rate=replace(found.rate, shape=shape))

    @cached_property
    def _model(self) -> GrowthModel:
        return GrowthModel(self._system, self._conditions, self._elastic, self._reduced)

    @cached_property
    def _elastic(self) -> np.ndarray:
        """Compliance A of the bodies and of the soft layers between the faces."""
        system, contact = self._system, self._system.contact
        if len(system.model.interfaces) == 1:
            return contact.compliance + system.model.interface.compliance * contact.mass
        soft = contact.weighted.T @ scaled(system.softness, contact.basis)
        return contact.compliance + dense(soft)

    @cached_property
    def _thermal(self) -> np.ndarray:
        """Weak thermal opening per pressure coefficient, H, at the given speed."""
        face, conductance = self._thermal_bodies.face, self._conditions.conductance
        bodies = HeatOperators(self._system, self._thermal_bodies.conduction, face)
        friction_heat = scaled(self._conditions.heating, self._system.basis)
        return bodies.coupled_distortion(conductance).by_friction(friction_heat)

    @cached_property
    def _space(self) -> LoadFree:
        """All load-free perturbations of the contact set."""
        contact = self._system.contact
        pressed = contact.pressed(self._pressure)
        space = load_free(contact.modes[pressed], contact.force_modes[pressed])
        identity = np.eye(len(pressed))[:, pressed]
        return LoadFree(identity @ space.pressures, identity @ space.gaps)

    @cached_property
    def _reduced(self) -> LoadFree:
        """Basis of the growing perturbations."""
        contact = self._system.contact
        return leading(self._elastic, self._thermal, contact.mass, self._space, _REDUCED)

    def _wear(self, factor: float) -> np.ndarray:
        """Wear rate per perturbation at a factor of the speed, in the reduced basis."""
        system, conditions, space = self._system, self._conditions, self._reduced
        pressed = system.basis @ space.pressures
        worn = np.zeros_like(pressed)
        conditions = replace(conditions, speed=factor * conditions.speed)
        laws = zip(system.laws.values(), system.spreads.values(), strict=True)
        for row, (law, spread) in enumerate(laws):
            slope = conditions.wear_slope(row, law, self._pressure)
            worn += spread.rate(slope[:, None] * pressed)
        return space.gaps.T @ (system.contact.weighted.T @ worn)


def _secant(tried: list[tuple[float, float]]) -> float:
    """Secant estimate of the root of a function with a slope of about -1."""
    (x, y), before = tried[-1], tried[:-1]
    if not before:
        return x + y
    slope = (y - before[-1][1]) / (x - before[-1][0])
    return x - y / min(slope, -0.3)
