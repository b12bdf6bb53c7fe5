"""Increments of stick and slip along the load histories, and through their cycles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...contact.friction.frictional_contact import unloaded
from ...contact.friction.slip_wear import SlipWear, worn_profiles
from ...contact.friction.stick_edge import StickEdge, radius_of, stick_edge
from ...contact.friction.stick_slip import advance, follow
from ...contact.friction.stick_slip_state import StickSlipState
from ...contact.full.edge_deflection import softness
from ...contact.operators.pressure import function_ranges, scaled
from ...contact.operators.tangential import closure, tangential_frame, weak
from ...errors import CaseError
from ...model.analyses import FrettingAnalysis
from ..system.joint_wear import JointWear
from ..system.system import System
from .cycle_jump import adaptive_jumps, fixed_jumps
from .friction_method import frictional_contact_of
from .held_loads import HeldLoads
from .load_path import Increment, LoadPath, LoadSegment, RestartPoint

_NO_RESISTANCE = 1e-9
"""Least singular value of the modes, scaled to unit columns, from which contacts resist them."""


class FrettingPath:
    """Increments of the contacts along the load histories and through the cycles.

    Parameters
    ----------
    system : System
    settings : FrettingAnalysis
    note : callable, optional
        Receives a warning about parameters of the contact method out of range.

    Attributes
    ----------
    loads : HeldLoads
        Holders with their motions and loads.
    cycle_of_history : tuple of float or None
        Start and end of the repeated part of the load histories [s].
    profiles : tuple of WornProfiles or ProfilesAtPoints
        Worn profiles of the wearing faces.
    basis : ndarray or csr_array, shape (n, m)
        Basis of the tractions.
    areas : ndarray, shape (m_Ψ,)
        Areas of the basis functions of the depths [m²].
    frame : ndarray, shape (t, n, gdim)
        Tangential directions at the contact points.

    Raises
    ------
    CaseError
        If no holder has a load history, or nothing resists a motion of the holders.
    """

    def __init__(
        self,
        system: System,
        settings: FrettingAnalysis,
        note: Callable[[str], None] | None = None,
    ):
        if system.slides is not None:
            raise CaseError(
                "motions: not supported in a fretting analysis; holders move the bodies"
            )
        self.loads, self._settings = HeldLoads(system), settings
        history, contacts = self.loads.history, system.contacts
        self._path = LoadPath(history, settings.output_times)
        self.cycle_of_history = history.cycle
        poles = np.array([system.load_directions[own.start] for own in contacts.ranges])
        self.frame = tangential_frame(contacts, poles)
        self._contact = frictional_contact_of(system, self.loads.held, self.frame, note)
        self.basis = self._contact.basis
        self._require_support()
        weighted, depths = self._contact.weighted, scaled(system.weights, system.basis)
        self.areas = np.asarray(depths.sum(axis=0)).ravel()
        self._functions = function_ranges(contacts, weighted)
        counts = [own.stop - own.start for own in self._functions]
        each = [interface.nominal_friction for interface in system.model.interfaces]
        self._friction = np.repeat(each, counts)
        self._edge: StickEdge | None = None
        self._turns = system.model.kinematics == "axisymmetric"
        if system.model.method == "condensed":  # tractions of points have no width
            soft = [softness(system.elastic, pairing) for pairing in contacts.each]
            given = np.concatenate(soft), self._friction
            self._edge = stick_edge(contacts, self.basis, self.frame, *given)
        wear = JointWear(system.model, contacts)
        self._laws = tuple(wear.laws_of(counts).values())
        self.profiles = tuple(
            self._contact.seen(worn_profiles(contacts, depths, side)) for side in system.laws
        )
        self._reactions = weak(weighted, closure(contacts, self.loads.reactions, self.frame))

    def _require_support(self) -> None:
        """Reject free motions that together move no contact."""
        free = np.isnan(self.loads.at(self.loads.history.time[0]).motions)
        modes = self._contact.modes[:, free]
        sizes = np.linalg.norm(modes, axis=0)
        scaled = modes / np.where(sizes > 0.0, sizes, 1.0)
        if free.any() and np.linalg.norm(scaled, -2) <= _NO_RESISTANCE:
            raise CaseError(
                "holders: some of their motions together move no contact, so that nothing carries "
                "their loads; fix one of these holders (free = [])"
            )

    def reactions(self, state: StickSlipState) -> np.ndarray:
        """Forces along and across the load direction, and moment of each holder.

        Shape (n_holders, 3), in space with two forces across it (n_holders, 4).
        """
        found = self._reactions.T @ self._contact.stack(state.pressure, state.shear)
        return found.reshape(len(self.loads.system.model.holders), -1)

    def duration(self, increment: Increment) -> float:
        """Duration of an increment [s]."""
        segment = increment.segment
        return (segment.end - segment.start) / self._settings.increments

    def stick_radii(self, cycle: Sequence[StickSlipState]) -> list[float]:
        """Radius of the stick zone of each contact, see `radius_of` [m].

        Parameters
        ----------
        cycle : sequence of StickSlipState
            States from the start to the end of a cycle, or a single state.
        """
        if self._edge is None:
            return [math.nan] * len(self._functions)
        zone, turns = self._edge.zone(cycle, len(cycle) > 1), self._turns
        each = ((own.start <= zone.crossed) & (zone.crossed < own.stop) for own in self._functions)
        return [radius_of(zone.edge[own], turns) for own in each]

    def travel(self, state: StickSlipState) -> np.ndarray:
        """Displacement of the first bodies along the faces, see `FrictionalContact.travel`."""
        return self._contact.travel @ state.motion

    def increments(self, last: Increment | None = None) -> Iterator[Increment]:
        """Increments up to the start of the cycles, then through them.

        Either all increments, or the ones after an increment with a restart point.
        """
        start = unloaded(self._contact, len(self._laws), len(self.areas))
        restart, passed = RestartPoint(0, start), -math.inf
        if last is not None:
            assert last.restart is not None
            restart, passed = last.restart, last.segment.end
        if restart.cycle == 0:
            left = (segment for segment in self._path.first_pass() if segment.end > passed)
            for increment in self._along(left, restart.state):
                restart = RestartPoint(0, increment.state)
                yield increment
        if self.cycle_of_history is not None:
            yield from self._cycles_after(restart)

    def _cycles_after(self, restart: RestartPoint) -> Iterator[Increment]:
        """Increments of the cycles after a restart point."""
        settings, count = self._settings, self._settings.cycles
        if settings.jump == "auto":
            stops = self._path.cycles_to_stop_at(count)
            return adaptive_jumps(self, stops, restart, settings.tolerance, settings.max_jump)
        return fixed_jumps(self, self._path.jumped_cycles(count, settings.jump), restart)

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """See `cycle_jump.Cycles`."""
        states = [state]
        for increment in self._along(self._path.cycle(number, repeats), state):
            states.append(increment.state)
            ends = increment.ends_segment and increment.segment.ends_cycle
            if ends and self._edge is not None and self._laws:
                increment = replace(increment, state=self._edge.after(states))
            yield increment

    def equilibrium(self, end: Increment, state: StickSlipState) -> StickSlipState:
        """See `cycle_jump.Cycles`."""
        loads = self.loads.at(end.segment.instant)
        found = advance(self._contact, self._friction, state, loads, self._wear(0.0))
        return replace(found, dissipated=state.dissipated)

    def _along(self, segments: Iterator[LoadSegment], state: StickSlipState) -> Iterator[Increment]:
        count = self._settings.increments
        for segment in segments:
            loads, step = self.loads.at(segment.instant), (segment.end - segment.start) / count
            wear = self._wear(step, segment.repeats)
            states = follow(self._contact, self._friction, [loads], count, state, wear)
            for number, state in enumerate(states, start=1):
                time = segment.end if number == count else segment.start + number * step
                yield Increment(time, segment, number == count, state)

    def _wear(self, duration: float, repeats: int = 1) -> SlipWear:
        return SlipWear(self._laws, self.profiles, self._friction, duration, repeats, self._edge)
