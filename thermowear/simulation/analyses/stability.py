"""Thermoelastic stability of the steady state, or of the cold bodies.

The temperature response to interface heat that grows at a rate s is ``(K + s M)⁻¹`` times it. A
small space of responses at some rates (rational Krylov space; A. Ruhe, Linear Algebra Appl. 58
(1984) 391) also approximates the responses at rates between them.

Linear, with the thermal conductance of the base state; its own temperatures do not matter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from petsc4py import PETSc

import numpy as np

from ...contact.operators.heat_exchange import HeatExchange, InterfaceHeat, at_faces
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
from ...model.analyses import StabilityAnalysis, StaticAnalysis
from ...model.model import Model
from ...parallel import sum_over_ranks
from ...results import Modes, Result
from ...results.short_names import by_name
from ..heat.heat_steps import HeatOperators, HeatSteps
from ..hot_spots.analysis import hot_spots
from ..interface.body_state import ContactState
from ..interface.condensed_method import CondensedMethod
from ..interface.interface_problem import InterfaceProblem
from ..results.recording import Snapshot
from ..results.summary import merged
from ..runtime.observer import Observer
from ..system.building import build
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .static import steady, unworn

_NEW = 1e-12
"""Smallest squared norm of the new part of a unit field that extends the space."""
_SPREAD = np.geomspace(1.0, 3e4, 12)
"""Initial rates of a model, relative to that of diffusion across the contact.

Critical speeds agree to 1e-10 with responses at the complex rates themselves; with a third of the
rates to 1e-6.
"""
_SAME_RATE, _TOLERANCE, _RATE_ITERATIONS = 1e-3, 1e-6, 6


@dataclass(frozen=True)
class PerturbationMode:
    """Perturbation mode of the pressure.

    Attributes
    ----------
    factor : float
        Factor of the given speed at which it is found.
    rate : Rate
        Growth rate, and coefficients of the pressure.
    """

    factor: float
    rate: Rate

    def near(self, other: PerturbationMode) -> bool:
        """True if both agree within the accuracy of the reduced model."""
        change = abs(self.rate.value - other.rate.value) <= _TOLERANCE * abs(other.rate.value)
        return change and abs(self.factor - other.factor) <= _TOLERANCE * other.factor


class GrowthModel:
    """Heat conduction projected on responses to perturbations over a wide range of growth rates.

    Every rank constructs it.

    Parameters
    ----------
    system : System
        System with a thermal model and known heat capacity.
    conditions : InterfaceConditions
        Conditions of the perturbed state.
    elastic : ndarray, shape (m, m)
        A, see `laws.stability`.
    space : LoadFree
        Basis of the perturbations, coefficients in the whole pressure space.
    """

    def __init__(
        self,
        system: System,
        conditions: InterfaceConditions,
        elastic: np.ndarray,
        space: LoadFree,
    ):
        assert system.thermal is not None
        self._system, self._thermal = system, system.thermal
        self._conditions, self._elastic, self._space = conditions, elastic, space
        pressures = system.basis @ space.pressures
        self._friction = conditions.heating[:, None] * pressures
        # without friction anywhere disturbances of the temperature decay, by conduction alone
        self._heat = self._friction if conditions.heating.any() else pressures
        self._steps = HeatSteps(system, system.thermal, 0)
        self._fields = np.zeros((len(system.thermal.conduction.fixed), 0))
        self._excess = np.zeros((system.basis.shape[1], 0))
        self._rates: list[float] = []
        extent = min(part.extent for part in system.contacts.each)
        self._diffusion_rate = system.thermal.diffusivity / extent**2
        for rate in (0.0, *(self._diffusion_rate * _SPREAD)):
            self.add(rate)

    def refined(
        self, find: Callable[[PerturbationMatrices], PerturbationMode | None]
    ) -> PerturbationMode | None:
        """Result of a search in the model, refined at the rate found; every rank calls.

        The response at the rate found is added until the result no longer changes.
        """
        found = find(self.matrices())
        for _ in range(_RATE_ITERATIONS):
            if found is None or self._has_response(abs(found.rate.value)):
                break
            self.add(abs(found.rate.value))
            before, found = found, find(self.matrices())
            if found is not None and found.near(before):
                break
        return found

    def _has_response(self, rate: float) -> bool:
        return any(abs(rate - known) <= _SAME_RATE * rate for known in self._rates)

    def add(self, rate: float) -> None:
        """Add the thermal response to friction heat that grows at a rate; every rank calls.

        Parameters
        ----------
        rate : float
            Growth rate, zero for steady state [1/s].
        """
        steps = self._steps
        bodies = steps.operators if rate == 0.0 else steps.operators_within(1 / rate)
        self._extend(*self._responses(bodies, self._exchange(bodies).loads(self._heat)))
        self._rates.append(rate)

    def _exchange(self, bodies: HeatOperators) -> HeatExchange:
        exchange = bodies.known(self._conditions.conductance).exchange
        assert isinstance(exchange, HeatExchange)
        return exchange

    def _responses(self, bodies: HeatOperators, loads) -> tuple[np.ndarray, np.ndarray]:
        """Fields (n_owned, q) and their excess heat (m, q) by loads of the exchange."""
        exchange = self._exchange(bodies)
        unknowns = exchange.response(loads)
        heat = loads + exchange.coupling @ unknowns  # bath included
        fields = bodies.conduction.respond(exchange.face.on_nodes(heat))
        return fields, exchange.excess(unknowns)

    def matrices(self) -> PerturbationMatrices:
        """Matrices of the present model; every rank calls."""
        system, space, thermal = self._system, self._space, self._thermal
        conduction, X = thermal.conduction, self._fields
        assert conduction.capacity is not None
        T1, T2 = at_faces(X, thermal.face.traces, system.comm)
        weights = system.weights[:, None]
        f = np.reshape(thermal.face.partition, (-1, 1))
        direct, _, resistance = thermal.face.divided(self._conditions.conductance)
        jump, excess = T2 - T1, system.basis @ self._excess
        # the jump that the excess does not pass is its resistance times it: no product of both,
        # which vanishes in perfect contact but for rounding times large heat of rough fields
        kept = self._product(conduction.conductivity, X)
        kept += jump.T @ (weights * direct[:, None] * jump)
        kept += excess.T @ (weights * resistance[:, None] * excess)
        kept += conduction.joints.passed(conduction.spaces, X)
        carried = np.zeros((X.shape[1],) * 2)
        if conduction.advection is not None:
            carried = self._product(conduction.advection.carried, X)
        return PerturbationMatrices(
            elastic=space(self._elastic),
            opening=space.gaps.T @ system.thermal_opening.of([X]),
            heated=(f * T1 + (1 - f) * T2).T @ (weights * self._friction),
            conducted=kept - carried,
            carried=carried,
            stored=self._product(conduction.capacity, X),
            diffusion_rate=self._diffusion_rate,
        )

    def _extend(self, fields: np.ndarray, excess: np.ndarray) -> None:
        """Extend the orthonormal space by fields (n_owned, q) with their excess heat (m, q)."""
        new = self._closed(*self._orthonormal(fields, excess, _NEW))
        # again, as the rest of a small difference is not orthogonal, and what closes it neither
        fields, excess = self._orthonormal(*new, 0.0)
        self._fields = np.hstack([self._fields, fields])
        self._excess = np.hstack([self._excess, excess])

    def _orthonormal(
        self, fields: np.ndarray, excess: np.ndarray, least: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Parts of fields that are new, those of a squared norm above the least."""
        sizes = np.diag(self._gram(fields, fields))
        fields, excess = fields[:, sizes > 0.0], excess[:, sizes > 0.0]  # no friction: no heat
        scale = 1 / np.sqrt(sizes[sizes > 0.0])
        known = self._gram(self._fields, fields * scale)
        fields = fields * scale - self._fields @ known
        excess = excess * scale - self._excess @ known
        sizes, mixing = np.linalg.eigh(self._gram(fields, fields))
        combined = mixing[:, sizes > least] / np.sqrt(sizes[sizes > least])
        return fields @ combined, excess @ combined

    def _closed(self, fields: np.ndarray, excess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Fields with the jumps of their excess heat, which small differences miss by rounding.

        That, times the large heat of rough fields, would change critical speeds in perfect contact
        by 5e-4.
        """
        bodies = self._steps.operators
        T1, T2 = at_faces(fields, self._thermal.face.traces, self._system.comm)
        missing = self._exchange(bodies).closing(T1 - T2, excess)
        if not missing.any():
            return fields, excess
        changes, more = self._responses(bodies, missing)
        return fields + changes, excess + more

    def _gram(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        return sum_over_ranks(self._system.comm, left.T @ right)

    def _product(self, matrix: PETSc.Mat, fields: np.ndarray) -> np.ndarray:
        """``Xᵀ matrix X``, shape (r, r)."""
        rows, _ = matrix.getSizes()
        right = PETSc.Mat().createDense(
            (rows, fields.shape[1]), array=np.asfortranarray(fields), comm=matrix.comm
        )
        right.assemble()
        image = matrix.matMult(right)
        return self._gram(fields, image.getDenseArray())


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


_SHOWN = 4
"""Number of static modes in the results."""


def stability(
    system: System, analysis: StaticAnalysis, observer: Observer
) -> tuple[Snapshot, Result]:
    """Thermoelastic stability of the steady state, or of the cold unworn contact if there is none.

    Every rank calls.

    Raises
    ------
    ComputationError
        If a body convects heat and the heat capacity of a body is not known.
    """
    end, unperturbed = base_state(system, observer)
    contact = PerturbedContact(system, end.contact.pressure, end.contact.conditions)
    if not contact.has_capacity:
        if contact.has_advection:
            raise ComputationError(
                "stability: a body carries heat along, so disturbances move; that needs density "
                "and specific_heat of all bodies"
            )
        observer.note(
            "without density and specific_heat of all bodies only disturbances that stay at "
            "their critical speed are found, and no rates; others may swing, and grow before"
        )
    with system.phases("stability"):
        static = [] if contact.has_advection else _static(contact)
        if contact.has_capacity:
            extra, modes = _in_time(system, contact)
        else:
            extra, modes = _keys(system, static[0] if static else None, None, None, None), []
    extra["static_speed_factors"] = [mode.factor for mode in static]
    found = replace(unperturbed, modes=_table(system, modes + static))
    if isinstance(analysis, StabilityAnalysis) and analysis.waves:
        with system.phases("hot spots"):
            more, spots = hot_spots(end, analysis, observer, base_state)
        extra, found = extra | more, replace(found, hot_spots=spots)
    return end, replace(found, summary=merged(unperturbed.summary, extra))


def base_state(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Unperturbed state: the steady state of wear, or the contact of the unworn faces."""
    free = system.holder.free
    if system.laws and len(free) and free.all():
        return steady(system, observer)
    return unworn(InterfaceProblem(system, CondensedMethod(system), None))


def _static(contact: PerturbedContact) -> list[PerturbationMode]:
    """First static modes."""
    found = contact.static
    pairs = zip(found.factors[:_SHOWN], found.shapes.T, strict=False)
    return [PerturbationMode(float(factor), Rate(0j, shape)) for factor, shape in pairs]


def _in_time(system: System, contact: PerturbedContact) -> tuple[dict, list[PerturbationMode]]:
    """Summary entries of growth rates and critical speeds, and the modes to tabulate."""
    critical, unworn = contact.onset(False), contact.fastest(False)
    onset, fastest, worn = critical, unworn, None
    if system.laws:
        onset = worn = contact.onset(True)
        fastest = contact.fastest(True)
    modes = [fastest] if fastest is not None and fastest.rate.value.real > 0 else []
    if onset is not None and onset.rate.value.imag > 0:
        modes.append(onset)
    return _keys(system, critical, worn, fastest, unworn), modes


def _keys(
    system: System,
    critical: PerturbationMode | None,
    with_wear: PerturbationMode | None,
    fastest: PerturbationMode | None,
    unworn: PerturbationMode | None,
) -> dict:
    """Summary entries of a stability analysis; critical speeds of several bodies by contact."""
    found: dict[str, Any] = {}
    for which, onset in (("", critical), ("_with_wear", with_wear)):
        found[f"critical_frequency{which}_rad_per_s"] = onset.rate.value.imag if onset else None
        factor = onset.factor if onset else None
        found = merged(found, critical_speeds(system.model, factor, which))
    for which, mode in (("", fastest), ("_without_wear", unworn)):
        found[f"growth_rate{which}_per_s"] = mode.rate.value.real if mode else None
        found[f"growth_frequency{which}_rad_per_s"] = mode.rate.value.imag if mode else None
    return found


def critical_speeds(model: Model, factor: float | None, which: str = "") -> dict[str, Any]:
    """Summary entries of a critical speed factor; speeds of several bodies by contact."""
    speeds: dict[str, Any] = {}
    for one in model.interfaces:
        given = one.motion.velocity, one.motion.angular_velocity
        known = [None if factor is None or v is None else factor * abs(v) for v in given]
        names = f"critical_speed{which}_m_per_s", f"critical_angular_velocity{which}_rad_per_s"
        speeds[one.name] = dict(zip(names, known, strict=True))
    return {f"critical_speed_factor{which}": factor, **by_name("contacts", speeds)}


def hot_state(end: Snapshot, result: Result, observer: Observer) -> Result:
    """Result with the critical speed of its last state; notes an unstable one. Every rank calls.

    Of states in steady temperatures.
    """
    system, heat = end.system, end.system.model.heat
    if heat is None or heat.transient or result.stopped is not None:
        return result
    with system.phases("stability"):
        factor = static_factor(system, end.contact)
    if factor is None:
        return result
    if factor < 1.0:
        observer.note(
            f"the hot state is unstable without wear, at {1 / factor:.3g} times its critical "
            "speed: uneven pressures grow, unless wear evens them out (a stability analysis "
            "tells); hot spots along the sliding were not examined"
        )
    extra = critical_speeds(system.model, factor)
    return replace(result, summary=merged(result.summary, extra))


def _table(system: System, modes: list[PerturbationMode]) -> Modes:
    """Table of mode pressures at the contact points, each normalised to a largest value of 1."""
    points, s = system.contacts.points, system.contacts.position
    places = [*np.pad(points, ((0, 0), (0, 3 - points.shape[1]))).T, s]
    tables = [np.zeros((10, 0))]
    for number, mode in enumerate(modes, 1):
        p = system.basis @ mode.rate.shape
        p = p / p[np.argmax(np.abs(p))] + 0j
        values = (number, mode.factor, mode.rate.value.real, mode.rate.value.imag)
        constants = [np.full(len(p), value) for value in values]
        tables.append(np.array([*constants, *places, p.real, p.imag]))
    return Modes(*np.hstack(tables))
