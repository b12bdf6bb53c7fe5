"""What a fretting analysis keeps of the increments and cycles that it goes through."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..contact.slip_wear import Profile
from ..contact.stick_slip import StickSlipState
from ..laws.motions import translation
from .load_path import Leg
from .observer import Observer
from .recording import interface_at
from .result import CycleRow, FrictionHistory, FrictionInterface, Interface, LoadRow
from .state import BodyState, ContactState, contact_state
from .system import System

_SLIDES = 1 - 1e-6  # of friction's limit


@dataclass(frozen=True)
class Instant:
    """The end of an increment.

    Attributes
    ----------
    time : float
        [s]
    leg : Leg
    ends_leg : bool
    state : StickSlipState
    """

    time: float
    leg: Leg
    ends_leg: bool
    state: StickSlipState


class FrettingRecord:
    """Increments, cycles and outputs so far.

    Parameters
    ----------
    system : System
    translations : ndarray, shape (k, 2)
        Of the holder.
    profiles : tuple of Profile
        Of the wearing bodies.
    observer : Observer
        Told of each of them.
    """

    last: StickSlipState

    def __init__(
        self,
        system: System,
        translations: np.ndarray,
        profiles: tuple[Profile, ...],
        observer: Observer,
    ):
        self.outputs: dict[float, Interface] = {}
        self._system = system
        self._translations = translations
        self._profiles = profiles
        self._observer = observer
        self._rows: list[LoadRow] = []
        self._cycles: list[CycleRow] = []
        self._frictions: dict[float, FrictionInterface] = {}
        self._now: list[Instant] = []  # of the cycle that is computed
        self._per_cycle = np.zeros((2, len(system.weights)))

    def keep(self, instant: Instant) -> None:
        """Take up the end of an increment."""
        leg = instant.leg
        self.last = instant.state
        self._rows.append(self._row(instant))
        self._observer.load_step(self._rows[-1])
        if self._now and self._now[-1].leg.cycle != leg.cycle:
            self._now = self._now[-1:]  # where the cycle begins
        self._now.append(instant)
        if instant.ends_leg and leg.ends_cycle:
            self._cycles.append(self._cycle())
            self._observer.cycle(self._cycles[-1])
        if instant.ends_leg and leg.is_output:
            with self._system.phases("output"):
                self._frictions[leg.end] = self._friction()
                self.outputs[leg.end] = self.interface()[2]
                self._observer.output(leg.end, self.outputs[leg.end], self._frictions[leg.end])

    def interface(self) -> tuple[ContactState, BodyState, Interface]:
        """Contact, bodies and interface in the last state; wear rates are means of its cycle."""
        system, state = self._system, self.last
        pressure, shear = system.basis @ state.pressure, system.basis @ state.shear[:, 0]
        moved = translation(state.motion @ self._translations)
        history = system.case.load.history
        assert history is not None  # the case has been checked
        begin, end = history.cycle or (0.0, np.inf)
        rates = self._per_cycle / (end - begin)
        contact = contact_state(system, pressure, shear)
        bodies, found = interface_at(system, contact, moved, self._depths(state), rates)
        return contact, bodies, replace(found, gap=found.gap + system.basis @ self._slid_along())

    def _slid_along(self) -> np.ndarray:
        """What the profiles open more than in place, as body 1 has slid, coefficients [m]."""
        state, nothing = self.last, np.zeros(self._system.basis.shape[1])
        if len(state.motion) < 2:
            return nothing
        pairs = zip(self._profiles, state.worn, strict=True)
        return sum((own.seen(state.motion[1]) @ ω - ω for own, ω in pairs), start=nothing)

    def history(self) -> FrictionHistory:
        """All of it."""
        return FrictionHistory(self._rows, self._cycles, self._friction(), self._frictions)

    def extra(self) -> dict:
        """What a fretting analysis adds to the summary."""
        last, w = self._rows[-1], self._system.weights
        per_cycle = self._per_cycle @ w if self._cycles else (None, None)
        return {
            "steps": len(self._rows),
            "time_s": last.time,
            "cycles": self._cycles[-1].cycle if self._cycles else 0,
            "normal_force_N": last.normal_force,
            "friction_force_N": abs(last.tangential_force),
            "guide_force_N": None,
            "tangential_force_N": last.tangential_force,
            "tangential_displacement_m": last.tangential_displacement,
            "stick_area_m2": last.stick_area,
            "dissipated_energy_J": last.dissipated,
            "wear_volume_per_cycle_1_m3": per_cycle[0],
            "wear_volume_per_cycle_2_m3": per_cycle[1],
        }

    def _depths(self, state: StickSlipState) -> np.ndarray:
        """Depths worn off both bodies at the points, shape (2, n) [m]."""
        system = self._system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = state.worn @ system.basis.T
        return both

    def _row(self, instant: Instant) -> LoadRow:
        system, state = self._system, instant.state
        w, pressure = system.weights, system.basis @ state.pressure
        forces, motions = (np.append(v, [0.0, 0.0]) for v in (state.force, state.motion))
        volumes = self._depths(state) @ w
        return LoadRow(
            time=instant.time,
            normal_force=float(forces[0]),
            approach=float(motions[0]),
            tangential_force=float(forces[1]),
            tangential_displacement=float(motions[1]),
            max_pressure=float(pressure.max()),
            contact_area=float(w[pressure > 0].sum()),
            stick_area=float(w[self._sticking(state)].sum()),
            dissipated=float(w @ state.dissipated),
            iterations=state.iterations,
            cycle=instant.leg.cycle,
            wear_volume_1=float(volumes[0]),
            wear_volume_2=float(volumes[1]),
        )

    def _cycle(self) -> CycleRow:
        """The cycle that has ended just now."""
        w, last = self._system.weights, self._now[-1]
        start, end = (self._depths(instant.state) for instant in (self._now[0], last))
        self._per_cycle = (end - start) / last.leg.repeats
        pressures = np.array([i.state.pressure for i in self._now]) @ self._system.basis.T
        return CycleRow(
            cycle=last.leg.cycle,
            time=last.time,
            wear_volume_1=float(end[0] @ w),
            wear_volume_2=float(end[1] @ w),
            dissipated=float(w @ last.state.dissipated),
            max_wear_1=float(end[0].max()),
            max_wear_2=float(end[1].max()),
            contact_area=float(w[(pressures > 0).any(axis=0)].sum()),
            max_pressure=float(pressures.max()),
        )

    def _sticking(self, state: StickSlipState) -> np.ndarray:
        """Points whose shear is below friction's limit, shape (n,)."""
        basis = self._system.basis
        pressure, shear = basis @ state.pressure, basis @ state.shear[:, 0]
        return np.abs(shear) < _SLIDES * self._system.friction * pressure

    def _friction(self) -> FrictionInterface:
        """Sticking and slipping in the last state."""
        system, state = self._system, self.last
        points, pressure = system.pairing.points, system.basis @ state.pressure
        status = np.where(pressure > 0, np.where(self._sticking(state), 1, 2), 0)
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.pairing.position,
            weight=system.weights,
            pressure=pressure,
            shear=system.basis @ state.shear[:, 0],
            slip=state.point_slip[:, 0],
            dissipated=state.dissipated,
            status=status,
        )
