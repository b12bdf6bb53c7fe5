"""The bodies under a known contact pressure: temperatures, displacements, balances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import relative, require
from ...compat import coordinate_element
from ...contact.operators.heat import ThermalState
from ...contact.operators.holder import RigidMode
from ...contact.operators.tangential import tangents
from ...contact.operators.traces import vector_trace
from ...contact.search.pairing import PairedFace
from ...laws.motions import translation
from ...parallel import sum_over_ranks
from ..heat.heat_states import TemperatureField
from ..heat.varying_heat import friction_heat
from ..model.conditions import ConditionModel, InterfaceConditions
from ..model.system import System


@dataclass(frozen=True)
class ContactState:
    """What the contact does to the bodies.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    conditions : InterfaceConditions
    warmth : TemperatureField or None
        None without heat.
    shear : ndarray or None, shape (n,)
        Traction of sticking and slipping on body 1, see `contact.tangential` [Pa].
    """

    pressure: np.ndarray
    conditions: InterfaceConditions
    warmth: TemperatureField | None
    shear: np.ndarray | None = None


def contact_state(
    system: System, pressure: np.ndarray, shear: np.ndarray | None = None
) -> ContactState:
    """Of a contact whose conditions depend on nothing but where it touches. Every rank calls."""
    conditions = ConditionModel(system).at(0.0, pressure, None, pressure > 0)
    heat = friction_heat(system)
    warmth = None if heat is None else heat.lasting(conditions, pressure)
    return ContactState(pressure, conditions, warmth, shear)


@dataclass(frozen=True)
class BodyState:
    """Fields of both bodies and what they do to the interface.

    Attributes
    ----------
    displacement : ndarray, shape (n_owned,)
        Without the holder's rigid motion [m].
    rise : ndarray or None, shape (n_owned,)
        Temperature over the ambient [K].
    opening : ndarray, shape (n,)
        ``B u``: gap at the contact points that load and heat open [m].
    thermal : ThermalState or None
        Temperatures and fluxes of the faces.
    hottest : float
        Highest temperature of the bodies [K]; NaN without heat.
    heat_error, force_error : float
        Relative imbalance of heat and of forces; the former NaN without heat.
    """

    displacement: np.ndarray
    rise: np.ndarray | None
    opening: np.ndarray
    thermal: ThermalState | None
    hottest: float
    heat_error: float
    force_error: float

    def require_balance(self) -> None:
        """Raise a `ComputationError` where heat or forces are not balanced."""
        require(equilibrium_relative_error=self.force_error)
        if self.thermal is not None:
            require(heat_balance_relative_error=self.heat_error)


def body_state(system: System, contact: ContactState) -> BodyState:
    """Solve the bodies for what the contact does to them. Every rank calls."""
    system = system.rubbing(contact.conditions.friction)
    pressure, shear, warmth = contact.pressure, contact.shear, contact.warmth
    thermal, rise, hottest, heat_error = None, None, float("nan"), float("nan")
    loads = traction = system.traction @ (system.weights * pressure)
    if shear is not None:
        pairing = system.pairing
        along = vector_trace(system.elastic.space, pairing, -tangents(pairing.normals)[0])
        loads = traction = traction + along @ (system.weights * shear)
    if system.dead_load is not None:
        loads = traction = traction + system.dead_load
    if warmth is not None and system.thermal is not None:
        thermal, rise, heat_error = warmth.faces, warmth.rise, warmth.error
        loads = traction + system.thermal.forces(rise)
        highest = max(system.comm.allgather(float(rise.max(initial=-np.inf))))
        hottest = max(highest, float(np.max(thermal.rise))) + system.thermal.ambient
    displacement = system.elastic.solve(loads)
    opening = sum_over_ranks(system.comm, system.trace.T @ displacement)
    force_error = _force_error(system, contact, displacement, loads)
    return BodyState(displacement, rise, opening, thermal, hottest, heat_error, force_error)


def _force_error(system: System, contact: ContactState, displacement, loads) -> float:
    """How far the supports' reactions are from what the holder gives and the contact carries.

    Along every motion of the holder it must push body 1 with its load, or with what the contact
    carries where the motion is given, and the support must push body 2 back; across them the
    guides do. Moments of the contact act on each body at its own points. Relative to the sum of the
    magnitudes, of all forces for translations.
    """
    drives = [*_with_rotations(system), *_across(system)]
    nodes = system.elastic.nodes()
    reactions = system.elastic.reactions(displacement, loads).reshape(nodes.shape)
    geometry = system.case.geometry
    upper = system.elastic.owned_by(*geometry.parts_of(geometry.bodies[0]))
    carried, borne_by_2 = (_work(system, contact, drives, side) for side in system.pairing.sides)
    errors, scales = np.zeros(len(drives)), np.zeros(len(drives))
    pressed = _part(contact.conditions.load - system.holder.dead, system.holder.load)
    for k, (drive, share, other) in enumerate(zip(drives, carried, borne_by_2, strict=True)):
        moved = drive.motion.at(nodes)
        work = (reactions * moved).sum(axis=1)
        parts = work[upper].sum(), work[~upper].sum(), np.abs(work).sum()
        held, supported, borne = sum_over_ranks(system.comm, np.array(parts))
        given = system.dead_resultant(drive.motion)
        found = share.sum()
        # the largest of a history of loads may be over
        due = (
            found - given[0]
            if drive.load is None or contact.shear is not None
            else pressed * drive.load
        )
        errors[k] = np.maximum(abs(held - due), abs(supported + given[1] + other.sum()))
        scales[k] = max(np.abs(share).sum() + np.abs(given).sum(), borne)
    shifts = np.array([not drive.motion.rotation.any() for drive in drives])
    scales[shifts] = scales[shifts].max()
    return max(relative(e, s) for e, s in zip(errors, scales, strict=True))


def _with_rotations(system: System) -> list[RigidMode]:
    """Motions of the holder that the elements can follow without strain.

    Rotations are linear in the coordinates: cells whose edges are curved by polynomials of a higher
    degree than that of the displacement strain a little under them, and moments balance only
    within the discretisation error.
    """
    curved = coordinate_element(system.bodies.mesh).degree > system.case.mesh.degree
    return [d for d in system.holder.drives if not (curved and d.motion.rotation.any())]


def _work(system: System, contact: ContactState, drives, side: PairedFace) -> np.ndarray:
    """Of the traction of the contact on motions of a body, at the points of its face, (k, n)."""
    points = side.face.points(side.facet, side.t)
    moved = np.array([drive.motion.at(points) for drive in drives])
    traction = contact.pressure[:, None] * system.pull
    if contact.shear is not None:
        traction = traction - contact.shear[:, None] * tangents(system.pairing.normals)[0]
    return system.weights * np.einsum("kni,ni->kn", moved, traction)


def _across(system: System) -> list[RigidMode]:
    """Translations along the axes that balance whatever the holder does, without a load."""
    gdim = system.pairing.points.shape[1]
    axes = [system.press] if system.case.model == "axisymmetric" else np.eye(gdim)
    return [RigidMode(translation(axis), amount=0.0) for axis in axes]


def _part(load: np.ndarray, largest: np.ndarray) -> float:
    """How much of the loads of the case there is."""
    size = float(largest @ largest)
    return float(load @ largest) / size if size > 0 else 1.0
