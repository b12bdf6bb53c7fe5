"""Heat steps: linear conduction at the times of an analysis, with the balance of each body."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...balances import relative
from ...bulk.heat.conduction import Conduction
from ...contact.operators import heat_exchange
from ...contact.operators.condensation import condense_heat
from ...contact.operators.coupled_heat import AnyFace
from ...contact.operators.exchange_matrix import BaselineResponse, ThermalState
from ...contact.operators.heat_exchange import CoupledDistortion, InterfaceHeat
from ...contact.operators.pressure import scaled
from ...contact.operators.thermal_opening import ThermalDistortion
from ...parallel import sum_over_ranks
from ...serialise import serialisable
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_system import ThermalLoad, ThermalSystem
from .exchange_cache import ExchangeCache, KnownExchange, exchange_cache, thermal_distortion

_LEAST = 1e-3
"""Least scale of the balance of a body, relative to the heat turned over in all of them."""


def of_bodies(system: System, nodal: np.ndarray) -> np.ndarray:
    """Sums of nodal values (k, n_owned) over each body, shape (k, n_bodies); every rank calls."""
    assert system.thermal is not None
    spaces, bodies = system.thermal.conduction.spaces, system.model.bodies
    result = np.zeros((len(nodal), len(bodies)))
    for k, mesh in enumerate(system.bodies.each):
        owner = next(i for i, body in enumerate(bodies) if mesh.parts[0] in body.parts)
        result[:, owner] += nodal[:, spaces.rows(k)].sum(axis=1)
    return sum_over_ranks(system.comm, result)


def into_bodies(
    system: System,
    thermal: ThermalSystem,
    faces: ThermalState,
    rise: np.ndarray,
    load: ThermalLoad,
    stored: np.ndarray | float = 0.0,
) -> np.ndarray:
    """Net heat into each body and the sum of its magnitudes, shape (2, n_bodies) [W].

    Every rank calls.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem
    faces : ThermalState
    rise : ndarray, shape (n_owned,) [K]
    load : ThermalLoad
    stored : ndarray, shape (n_owned,), optional
        Rate of the nodal stored heat [W].
    """
    heat = thermal.face.nodal_heat(faces, bath=False) + load.heat - stored
    net, sizes = thermal.conduction.into_bodies(rise, heat)
    return of_bodies(system, np.array([net + stored, sizes]))


def body_balance_errors(net: np.ndarray, sizes: np.ndarray) -> list[float]:
    """Relative errors of balances of bodies, from their defects and magnitudes, (n_bodies,)."""
    scales = np.maximum(sizes, _LEAST * sizes.sum())
    return [relative(float(d), float(s)) for d, s in zip(net, scales, strict=True)]


ROUNDING = 1e-3
"""Least scale of the heat balance, relative to the initial heat content (rounding)."""


@dataclass(frozen=True)
class HeatBalance:
    """Heat balance since the start.

    Attributes
    ----------
    made, stored, lost : float
        Heat by friction and surfaces with given flux or power, in the bodies, and lost [J].
    moved : float
        Magnitude of all heat put in, lost, or moved inside the bodies [J].
    """

    made: float
    stored: float
    lost: float
    moved: float

    @property
    def error(self) -> float:
        """Imbalance relative to the largest term."""
        scale = max(abs(self.made), abs(self.stored), abs(self.lost), self.moved)
        return abs(self.made - self.stored - self.lost) / (scale or 1.0)


@serialisable
@dataclass(frozen=True)
class StoredHeat:
    """Heat stored in the bodies in transient conduction.

    Attributes
    ----------
    rise : ndarray, shape (n_owned,)
        Nodal temperature rise over the ambient [K].
    content : ndarray, shape (n_owned,)
        Nodal heat content over the ambient [J].
    turnover : ndarray, shape (3 + 2 n_bodies,)
        Cumulated heat input by friction and through surfaces, heat lost, sum of the magnitudes of
        all heat in and out, and those of `into_bodies`; in checkpoints of earlier versions without
        the latter [J].
    largest : float
        Largest magnitude so far of the rise of the faces; also inside the bodies where friction is
        not the only heat source [K].
    """

    rise: np.ndarray
    content: np.ndarray
    turnover: np.ndarray
    largest: float

    def towards(self, other: StoredHeat, part: float) -> StoredHeat:
        """Interpolate linearly (or extrapolate) to another state by a fraction of the distance."""
        return StoredHeat(
            self.rise + part * (other.rise - self.rise),
            self.content + part * (other.content - self.content),
            self.turnover + part * (other.turnover - self.turnover),
            other.largest,
        )

    def balance(self, initial: StoredHeat, comm) -> HeatBalance:
        """Heat balance since an initial state on the same mesh; every rank calls."""
        gained, before = self.content - initial.content, np.abs(initial.content).sum()
        sums = np.array([gained.sum(), np.abs(gained).sum(), before])
        gain, shifted, had = (float(heat) for heat in sum_over_ranks(comm, sums))
        made, lost, exchanged = (float(heat) for heat in self.turnover[:3])
        return HeatBalance(made, gain, lost, max(exchanged, shifted, ROUNDING * had))


class HeatOperators:
    """Linear conduction condensed to the interface: steady, or over a time step of one size.

    The last exchange and compliance are kept. No reference to the heat steps: a cycle of references
    would keep it in memory after its mesh has been discarded.
    """

    def __init__(self, system: System, conduction: Conduction, face: AnyFace):
        self.conduction, self.face, self._system = conduction, face, system
        method, condensed = system.model.method, isinstance(face, InterfaceHeat)
        self.distorts = method == "condensed" and condensed
        self._last: tuple[bytes, KnownExchange] | None = None

    @cached_property
    def _exchanges(self) -> ExchangeCache:
        """Exchanges of the faces, to whose nodes conduction is condensed first."""
        if isinstance(self.face, InterfaceHeat):
            with self._system.phases("condense conduction"):
                _ = self.face.response
        return exchange_cache(self._system, self.conduction, self.face)

    @cached_property
    def slopes(self) -> list[np.ndarray]:
        """Excess rises of temperature-dependent expansions per rise, shape (n_owned,) each."""
        return []

    def rise(self, load: ThermalLoad, heat: np.ndarray) -> np.ndarray:
        """Nodal rise (n_owned,) by nodal heat and prescribed temperatures; every rank calls [K]."""
        return self.conduction.with_prescribed(load.given).solve(heat)

    def baseline(self, rise: np.ndarray) -> BaselineResponse:
        """Interface response to a nodal rise (n_owned,); every rank calls."""
        opening = self.opened([rise]) if self.distorts else None
        return heat_exchange.baseline_response(rise, self.face.traces, self._system.comm, opening)

    def opened(self, rises: list[np.ndarray]) -> np.ndarray:
        """Weak gap opened by nodal rises, see `ThermalOpening.of`; every rank calls."""
        opening = self._system.thermal_opening
        if opening.per_rise:
            return heat_exchange.opened_by(opening.per_rise, rises, self._system.comm)
        return opening.of(rises)

    def known(self, conductance: np.ndarray) -> KnownExchange:
        """Heat exchange of the faces for conductances at the points (n,), and its distortion."""
        key = conductance.tobytes()
        if self._last is None or self._last[0] != key:
            self._last = None  # frees its memory
            self._last = key, self._exchanges.of(conductance)
        return self._last[1]

    def coupled_distortion(self, conductance: np.ndarray) -> CoupledDistortion:
        """Distortion of faces that exchange heat by conductances at the points, shape (n,)."""
        known = self.known(conductance)
        if known.distortion is None:
            known.distortion = self._exchanges.distortion(known, self._uncoupled)
        return known.distortion

    @cached_property
    def _uncoupled(self) -> ThermalDistortion:
        return thermal_distortion(self._system, self.conduction, self.face, self.slopes)

    def compliance(self, conductance: np.ndarray, heating: np.ndarray, basis: np.ndarray):
        """Thermal compliance ``H diag(mu v) Ψ`` for a heating ``mu v`` (n,) [m/s], (m, m)."""
        key, known = heating.tobytes(), self.known(conductance)
        if known.compliance is None or known.compliance[0] != key:
            distortion = self.coupled_distortion(conductance)
            known.compliance = key, distortion.by_friction(scaled(heating, basis))
        return known.compliance[1]


@dataclass(eq=False)
class HeatStep:
    """Linear conduction at one time: operators, loads and stored heat.

    Attributes
    ----------
    operators : HeatOperators
    load : ThermalLoad
    supplied : ndarray, shape (n_owned,)
        Nodal heat without that of the contact, stored heat divided by the step included [W].
    baseline : BaselineResponse
        Response of the faces without heat at the contact.
    """

    operators: HeatOperators
    load: ThermalLoad
    supplied: np.ndarray
    baseline: BaselineResponse
    _gap: tuple[CoupledDistortion, np.ndarray] | None = None

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        """Temperatures and fluxes of the faces under a pressure at the points [Pa]."""
        exchange = self.operators.known(conditions.conductance).exchange
        return exchange.state(conditions.heating * pressure, self.baseline)

    def rise(self, faces: ThermalState) -> np.ndarray:
        """Temperature rise of the bodies, shape (n_owned,) [K]."""
        heat = self.operators.face.nodal_heat(faces, bath=True) + self.supplied
        return self.operators.rise(self.load, heat)

    def coupling(
        self, conditions: InterfaceConditions, basis: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Weak gap per pressure coefficient by friction heat (m, m), by other heat (m,) [m³]."""
        operators = self.operators
        distortion = operators.coupled_distortion(conditions.conductance)
        if self._gap is None or self._gap[0] is not distortion:
            self._gap = distortion, distortion.baseline_gap(self.baseline)
        return operators.compliance(conditions.conductance, conditions.heating, basis), self._gap[1]

    def converged(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test whether the last coupling has converged at a pressure: linear heat always has."""
        return True


class HeatSteps:
    """Conduction in time with constant properties; operators are kept for `kept` step sizes."""

    def __init__(self, system: System, thermal: ThermalSystem, kept: int):
        self._system, self._thermal, self._kept = system, thermal, kept
        self.driven = system.model.heat is not None and system.model.heat.driven
        self._of_size: OrderedDict[float, Any] = OrderedDict()

    @cached_property
    def operators(self) -> HeatOperators:
        """Operators of steady conduction with the properties at the ambient temperature."""
        return HeatOperators(self._system, self._thermal.conduction, self._thermal.face)

    @cached_property
    def steady(self) -> HeatStep:
        """Steady conduction; every rank calls."""
        load, operators, system = self._thermal.loads.at(0.0), self.operators, self._system
        baseline = system.parts.get(
            "at rest",
            (system.inputs.conduction, operators.distorts),
            lambda: operators.baseline(operators.rise(load, load.heat)),
        )
        return HeatStep(operators, load, load.heat, baseline)

    def operators_within(self, step: float) -> Any:
        """Operators for an implicit Euler step of a size [s]; every rank calls."""
        conduction = self._thermal.conduction.implicit_euler(step)
        return HeatOperators(
            self._system, conduction, condense_heat(conduction, self._thermal.face)
        )

    def after(self, before: StoredHeat | None, step: float, time: float) -> HeatStep:
        """Conduction after an Euler step [s], steady without stored heat; every rank calls."""
        if before is None:
            return self.steady
        if step not in self._of_size:
            if len(self._of_size) >= self._kept:
                self._of_size.popitem(last=False)
            self._of_size[step] = self.operators_within(step)
        self._of_size.move_to_end(step)
        load = self._thermal.loads.constant or self._thermal.loads.at(time)
        supplied = load.heat + before.content / step
        return self._conducting(self._of_size[step], load, supplied, before.rise)

    def end(
        self,
        before: StoredHeat,
        step: float,
        heat: HeatStep,
        faces: ThermalState,
        friction_heat: np.ndarray,
    ) -> StoredHeat:
        """Stored heat after a step [s] by the faces and friction heat (n,) [W/m²] at its end."""
        conduction, face, load = self._thermal.conduction, self._thermal.face, heat.load
        rise = heat.rise(faces)
        content = conduction.stored_heat(rise)
        gained = (content - before.content) / step
        nodal = face.nodal_heat(faces, bath=False) + load.heat - gained
        lost = sum(conduction.losses(rise, nodal, load.ambient))
        made = float(face.weights @ friction_heat)
        exchanged = made + load.magnitude + conduction.exchanged_heat(rise, nodal, load.ambient)
        largest = max(before.largest, float(np.abs(faces.rise).max()), self.largest(rise))
        flows = [made + load.prescribed, lost, exchanged]
        if len(before.turnover) > len(flows):  # not in those of earlier versions
            flows += [*into_bodies(self._system, self._thermal, faces, rise, load, gained).ravel()]
        return StoredHeat(rise, content, before.turnover + step * np.array(flows), largest)

    def largest(self, rise: np.ndarray) -> float:
        """Largest rise inside the bodies with other heat sources, else 0 [K]; every rank calls.

        Where friction is the only heat source the faces show the errors of a step.
        """
        if not self.driven:
            return 0.0
        return max(self._system.comm.allgather(float(np.abs(rise).max(initial=0.0))))

    def restart_data(self) -> Any:
        """Data that a continued run needs for the same results; None for linear conduction."""

    def restore(self, data: Any) -> None:
        """Restore the state from `restart_data`."""

    def _conducting(self, operators, load: ThermalLoad, supplied, rise: np.ndarray) -> HeatStep:
        """Conduction at one time, with nodal heat without the contact and an initial rise."""
        baseline = operators.baseline(operators.rise(load, supplied))
        return HeatStep(operators, load, supplied, baseline)
