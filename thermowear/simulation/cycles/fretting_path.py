"""Increments of stick and slip along the load histories, and the states at their ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...contact.friction.frictional_contact import unloaded
from ...contact.friction.slip_wear import SlipWear, worn_profiles
from ...contact.friction.stick_edge import StickEdge, radius_of, stick_edge
from ...contact.friction.stick_slip import advance, follow
from ...contact.friction.stick_slip_state import Status, StickSlipState
from ...contact.full.edge_deflection import softness
from ...contact.operators.pressure import Basis, function_ranges, scaled
from ...contact.operators.rigid_motion import closure, forwards, tangential_frame, tangents, weak
from ...errors import CaseError
from ...laws.motions import spatial
from ...model.analyses import FrettingAnalysis
from ...results import FrictionInterface
from ..system.system import JointWear, System
from .held_loads import HeldLoads, frictional_contact_of
from .load_path import Increment, LoadPath, LoadSegment, RestartPoint, adaptive_jumps, fixed_jumps

_LOCATED = 0.3
"""Uncertainty of a stick edge that is fitted inside of coefficients of degree 1, by their width."""
_SCAR = 0.01
"""Depth of the scar at its rim, by the largest one."""
_SLIDES = 1 - 1e-6  # fraction of the friction limit from which a point slips


@dataclass(frozen=True)
class FrettingState:
    """State at the end of an increment, at the contact points of a system.

    Attributes
    ----------
    system : System
    increment : Increment
    frame : ndarray, shape (t, n, gdim)
        Tangential directions at the points.
    basis : ndarray or csr_array, shape (n, m)
        Basis of the tractions.
    """

    system: System
    increment: Increment
    frame: np.ndarray
    basis: Basis

    @cached_property
    def pressure(self) -> np.ndarray:
        """Pressure, shape (n,) [Pa]."""
        return self.basis @ self.increment.state.pressure

    @cached_property
    def shear(self) -> np.ndarray:
        """Components of the shear traction on the first bodies, shape (n, t) [Pa]."""
        return self.basis @ self.increment.state.shear

    @property
    def shear_vectors(self) -> np.ndarray:
        """Shear traction on the first bodies, shape (n, gdim) [Pa]."""
        return self.vectors(self.shear)

    def vectors(self, components: np.ndarray) -> np.ndarray:
        """Vectors (n, gdim) of tangential components (n, t)."""
        return np.einsum("nt,tni->ni", components, self.frame)

    @cached_property
    def sticking(self) -> np.ndarray:
        """Mask of points with shear below the friction limit, shape (n,).

        In space those where more coefficients have stuck than slipped in the last increment: the
        shear between coefficients that slip in different directions is below the limit, too.
        """
        if self.in_space:
            status, basis = self.increment.state.status, self.basis
            stick, slip = (basis @ (status == each) for each in (Status.STICK, Status.SLIP))
            return (stick > slip) & (self.pressure > 0)
        return np.abs(self.shear[:, 0]) < _SLIDES * self.system.friction * self.pressure

    @cached_property
    def depths(self) -> np.ndarray:
        """Worn depths of the first and of the second faces, shape (2, n) [m]."""
        system = self.system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = (system.basis @ self.increment.state.worn.T).T
        return both

    @cached_property
    def sense(self) -> np.ndarray:
        """Signs of shear and slip along +x (+y on faces along y) in a plane, shape (n,)."""
        contacts = self.system.contacts
        means = np.array([each.weights @ each.normals for each in contacts.each])
        return contacts.per_point(forwards(tangents(means)[0]))

    @property
    def in_space(self) -> bool:
        return self.system.contacts.in_space

    @cached_property
    def normal_forces(self) -> np.ndarray:
        """Forces on the second bodies along the load direction at the points, shape (n,) [N]."""
        along = np.einsum("ni,ni->n", self._on_second, self.system.load_directions)
        return self.system.weights * along

    def friction_force(self, own: slice) -> float:
        """Force on the first body of a contact across its load direction [N].

        Along +x (+y where it is pressed along x); in space its magnitude.
        """
        w, along = self.system.weights[own], self.system.load_directions[own]
        if self.in_space:
            total = w @ self._on_second[own]
            return float(np.linalg.norm(total - (total @ along[0]) * along[0]))
        turned = tangents(along)[0]
        pull = np.einsum("ni,ni->n", self._on_second[own], turned)
        return float((-forwards(turned) * w * pull).sum())

    @property
    def _on_second(self) -> np.ndarray:
        """Traction on the second bodies, shape (n, gdim) [Pa]."""
        return self.pressure[:, None] * self.system.contacts.normals - self.shear_vectors

    @property
    def friction(self) -> FrictionInterface:
        """Stick and slip at the contact points."""
        system, state = self.system, self.increment.state
        points = spatial(system.contacts.on_body_1)
        nothing = np.full((len(points), 3), np.nan)
        shear, slip = self._shown(self.shear), self._shown(state.point_slip)
        vectors = (self.shear_vectors, self.vectors(state.point_slip)) if self.in_space else ()
        (tx, ty, tz), (sx, sy, sz) = (each.T for each in vectors or (nothing, nothing))
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.contacts.position,
            weight=system.weights,
            pressure=self.pressure,
            shear=shear,
            slip=slip,
            dissipated=state.dissipated,
            status=np.where(self.pressure > 0, np.where(self.sticking, 1, 2), 0),
            z=points[:, 2] if self.in_space else nothing[:, 2],
            shear_x=tx,
            shear_y=ty,
            shear_z=tz,
            slip_x=sx,
            slip_y=sy,
            slip_z=sz,
        )

    def edge_error(self) -> float | None:
        """Error of the worn volume by the position of the stick edge, relative to the volume.

        The edge is located to a part of a coefficient, see `stick_edge`. Depths grow with the root
        of the distance x from it: where it moves by δ, those of the scar, n coefficients wide,
        change by ``δ/2x`` of themselves, by that next to the edge times ``δ/√n`` in the mean. That
        counts the less, the smoother the pressure is across the edge.

        Returns
        -------
        float or None
            None without wear, and where tractions are those of points.
        """
        state, (basis, weights) = self.increment.state, (self.system.basis, self.system.weights)
        lost, worn = self.depths.sum(axis=0), state.worn
        total = float(weights @ lost)
        if total == 0.0 or worn.shape[1] != len(state.part):
            return None
        overlap = sp.csr_array(basis)
        near = overlap.T @ overlap
        stuck, depths = state.part > 0.0, worn.sum(axis=0)
        beyond = (near @ stuck.astype(float) > 0.0) & ~stuck & (depths > 0.0)
        inner = (near @ beyond.astype(float) > 0.0) & stuck
        areas, error = overlap.T @ weights, 0.0
        model, functions = self.system.model, function_ranges(self.system.contacts, basis)
        for interface, own in zip(model.interfaces, functions, strict=True):
            if not beyond[own].any():
                continue
            outside, within = (areas * beyond)[own], inner[own]
            depth = outside @ depths[own] / outside.sum()
            mean = outside @ state.pressure[own] / outside.sum()
            highest = state.pressure[own][within].max()
            scar = areas[own][depths[own] > _SCAR * depths[own].max()].sum()
            drop = max(1.0 - mean / highest, 0.0) if highest > 0.0 else 1.0
            located = 1.0
            if state.crossed[own].any():
                located = min(1.0, _LOCATED * model.pressure_degree(interface) ** 2)
            error += located * drop * depth * np.sqrt(scar * outside.sum())
        return float(error) / total

    def _shown(self, components: np.ndarray) -> np.ndarray:
        """Component along +x of a plane model, magnitude in space, shape (n,)."""
        if self.in_space:
            return np.linalg.norm(components, axis=1)
        return self.sense * components[:, 0]

    def power(self, before: FrettingState, duration: float) -> np.ndarray:
        """Friction power per area in the increment, shape (n,) [W/m²]; NaN without duration."""
        slid = self.increment.state.point_slip - before.increment.state.point_slip
        return -(self.shear * slid).sum(axis=1) / (duration or np.nan)


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
        """See `load_path.Cycles`."""
        states = [state]
        for increment in self._along(self._path.cycle(number, repeats), state):
            states.append(increment.state)
            ends = increment.ends_segment and increment.segment.ends_cycle
            if ends and self._edge is not None and self._laws:
                increment = replace(increment, state=self._edge.after(states))
            yield increment

    def equilibrium(self, end: Increment, state: StickSlipState) -> StickSlipState:
        """See `load_path.Cycles`."""
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
