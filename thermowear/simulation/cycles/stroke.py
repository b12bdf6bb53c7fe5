"""Discretised stroke of reciprocating bodies, and the wear in its positions.

The body that carries the points of an interface passes over the other one, all with one frequency
and phase.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from ...bulk.kinematics import Kinematics
from ...contact.operators.condensation import gap_trace
from ...contact.operators.pressure import Basis, dense, joined_bases, scaled
from ...contact.operators.rigid_motion import Sliding, hold, joined_sliding, sliding
from ...contact.search.pairing import Contacts, Pairing, with_carrying_face
from ...contact.solvers.coupled_positions import CoupledContacts
from ...contact.wear.implicit_step import Slope
from ...contact.wear.worn_profile import StrokeGrids
from ...errors import CaseError
from ...laws.interfaces import Law, LocalState
from ...model.analyses import ReciprocatingAnalysis
from ...model.face_wear import FaceWear
from ...model.interface import Interface
from ...model.model import Model
from ..points.contact_points import contact_points
from ..system.rigid_modes import load_direction, rigid_modes
from ..system.setup_cache import SetupCache
from ..system.system import System


@dataclass(frozen=True)
class CycleContact:
    """Contact of each interface over a cycle.

    Attributes
    ----------
    largest : ndarray, shape (n_interfaces,)
        Largest pressure [Pa].
    area, force, friction, power : ndarray, shape (n_interfaces,)
        Mean contact area, normal force along the load direction, friction force and friction power
        [m², N, N, W].
    motion : ndarray, shape (n_modes,)
        Mean motion of the holders.
    """

    largest: np.ndarray
    area: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    power: np.ndarray
    motion: np.ndarray


@dataclass(frozen=True)
class FaceLaw:
    """Wear law of the carrying or of the swept face of an interface.

    Attributes
    ----------
    own : slice
        Coefficients of the interface.
    law : Law or None
        None: the face does not wear.
    speeds : ndarray, shape (J, 1) [m/s]
    friction : float
    """

    own: slice
    law: Law | None
    speeds: np.ndarray
    friction: float


@dataclass(frozen=True)
class LocalWear:
    """Local wear rates in all positions, see `contact.wear.implicit_step`.

    Attributes
    ----------
    faces : tuple of tuple of FaceLaw
        Laws of the carrying faces, and those of the swept ones, by interface.
    """

    faces: tuple[tuple[FaceLaw, ...], ...]

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Local rates under coefficients of the pressure (J, m), shape (2, J, m) [m/s]."""
        return self._each(pressure, "value")

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivatives of the local rates with respect to pressure [m/s/Pa]."""
        return Slope.diagonal(self._each(pressure, "slope"))

    def _each(self, pressure: np.ndarray, name: str) -> np.ndarray:
        found = np.zeros((len(self.faces), *pressure.shape))
        for side, faces in zip(found, self.faces, strict=True):
            for face in faces:
                if face.law is not None:
                    at = LocalState(pressure[:, face.own], face.speeds, mu=face.friction)
                    side[:, face.own] = getattr(face.law, name)(at)
        return found


def local_wear(
    system: System, functions: tuple[slice, ...], speeds: np.ndarray, strokes: np.ndarray
) -> LocalWear:
    """Local wear of all faces at the mean speeds (J, 1) of the given stroke [m/s]."""
    each = system.model.interfaces, system.contacts.carriers, functions, strokes
    interfaces = list(zip(*each, strict=True))

    def face(one: Interface, carrier: int, own: slice, stroke: float, swept: int) -> FaceLaw:
        wear = one.wear.get(abs(carrier - swept))
        law = wear.law if isinstance(wear, FaceWear) else None
        return FaceLaw(own, law, abs(stroke) * speeds, one.nominal_friction)

    return LocalWear(tuple(tuple(face(*one, swept) for one in interfaces) for swept in (0, 1)))


_UNPAIRED = 1e-6
_AT_REST = 1e-9
"""Relative amplitude below which bodies do not slide on each other."""


@dataclass(frozen=True)
class Position:
    """Position of the bodies with a sliding direction, representing the stroke around it.

    Attributes
    ----------
    offset : float
        Offset along x from mid-stroke, for the given amplitude [m].
    length : float
        Length of the part of the stroke [m].
    speed : float
        Mean speed in that part [m/s].
    share : float
        Fraction of the cycle time.
    system : System
        Bodies in this position.
    """

    offset: float
    length: float
    speed: float
    share: float
    system: System


def strokes(model: Model, settings: ReciprocatingAnalysis) -> np.ndarray:
    """Amplitude of the first body over the second one, relative to that given, (n_interfaces,).

    Negative where the second one moves.

    Raises
    ------
    CaseError
        If both bodies of an interface of several move alike, or not at all.
    """
    given = 4 * settings.amplitude * settings.frequency
    at_rest = 0.0 if model.named else given
    each = [one.motion.velocity for one in model.interfaces]
    found = np.array([at_rest if velocity is None else velocity for velocity in each]) / given
    for interface, stroke in zip(model.interfaces, found, strict=True):
        if abs(stroke) < _AT_REST:
            raise CaseError(
                f"{interface.table}: its bodies do not slide on each other; every contact of a "
                "reciprocating analysis must slide (glue them: tie = true)"
            )
    return found


def stroke_ends(settings: ReciprocatingAnalysis) -> np.ndarray:
    """Ends of stroke parts of equal duration, shape (positions + 1,) [m]."""
    parts = np.arange(settings.positions + 1) / settings.positions
    return settings.amplitude * np.sin(np.pi * (parts - 0.5))


def positions(system: System, settings: ReciprocatingAnalysis) -> list[Position]:
    """Midpoints of stroke parts of equal duration, from one end to the other.

    Time shares and mean speeds reproduce the period and the length of the stroke exactly. Without
    friction in the section both sliding directions are equivalent; otherwise both are listed.
    """
    count, relative = settings.positions, strokes(system.model, settings)
    directions = (1, -1) if system.traction is not system.trace else (1,)
    return [
        Position(
            offset=float(start + end) / 2,
            length=float(end - start),
            speed=float(end - start) * 2 * count * settings.frequency,
            share=1 / (count * len(directions)),
            system=moved(system, float(start + end) / 2 * relative, direction),
        )
        for direction in directions
        for start, end in itertools.pairwise(stroke_ends(settings))
    ]


def moved(system: System, offsets: np.ndarray, direction: int) -> System:
    """System with the bodies of each interface moved along x, in sliding.

    Parameters
    ----------
    system : System
    offsets : ndarray, shape (n_interfaces,)
        Displacement of the first body of each interface over the second one, along +x [m].
    direction : int
        1 if they slide in the directions of their velocities, -1 backwards.

    Raises
    ------
    CaseError
        If a first body leaves the face of the second one.
    """
    model, contacts = system.model, system.contacts
    with system.phases("pair"):
        each = moved_contacts(model, system.comm, system.elastic.kinematics, contacts, offsets)
    pairings, bases = zip(*each, strict=True)
    there = replace(contacts, each=pairings)
    slides = joined_sliding(
        [
            _sliding(system, interface, pairing, direction)
            for interface, pairing in zip(model.interfaces, pairings, strict=True)
        ]
    )
    friction, transverse = (
        there.per_point([getattr(one, name) for one in model.interfaces])[:, None]
        for name in ("nominal_friction", "transverse_friction")
    )
    traction_direction = slides.traction_direction(there.normals, friction, transverse)
    still = replace(
        there,
        each=tuple(
            with_carrying_face(pairing, before.carrying.face)
            for pairing, before in zip(pairings, contacts.each, strict=True)
        ),
    )
    return replace(
        system,
        contacts=there,
        trace=gap_trace(system.elastic.spaces, there),
        basis=joined_bases(bases),
        holder=hold(
            still,
            traction_direction,
            rigid_modes(model.holders, still, system.dead_resultant),
        ),
        slides=slides,
        traction_direction=traction_direction,
        speed=slides.speed,
        parts=SetupCache(),  # other contact points: no cached condensation applies
    )


def moved_contacts(
    model: Model, comm, kinematics: Kinematics, contacts: Contacts, offsets: np.ndarray
) -> list[tuple[Pairing, Basis]]:
    """Contact points and pressure space of each interface, its first body moved along x.

    Offsets and errors as in `moved`. Every rank calls.
    """
    result = []
    for interface, pairing, offset in zip(model.interfaces, contacts.each, offsets, strict=True):
        side, face = pairing.carrier, pairing.carrying.face
        along = np.eye(face.nodes.shape[-1])[0] * (-1) ** side
        there = with_carrying_face(pairing, replace(face, nodes=face.nodes + offset * along))
        faces = (paired.face for paired in there.sides)
        found, basis = contact_points(model, interface, comm, kinematics, *faces, carrier=side)
        if found.unpaired > pairing.unpaired + _UNPAIRED:
            where, body = interface.path("motion.amplitude"), model.bodies[interface.bodies[0]].name
            own, other = interface.faces[side], interface.faces[1 - side]
            raise CaseError(
                f"{where}: {found.unpaired:.2%} of {own} leaves {other} where {body} is moved by "
                f"{offset:.4g} m; a longer face {other} is needed"
            )
        result.append((found, basis))
    return result


def _sliding(system: System, interface: Interface, pairing: Pairing, direction: int) -> Sliding:
    """Sliding of the first body of an interface, in the direction of its velocity or backwards."""
    velocity = system.elastic.kinematics.sliding(pairing.points, interface.motion)
    along = load_direction(system.model, interface, pairing)
    return sliding(direction * velocity, pairing.normals, along)


def condensed(stroke: list[Position], grid: StrokeGrids) -> CoupledContacts:
    """Condensed contacts in all positions. Every rank calls."""
    systems = [position.system for position in stroke]
    contacts = [system.contact for system in systems]
    compliances, gaps, gaps_per_depth = [], [], []
    for position, system, contact in zip(stroke, systems, contacts, strict=True):
        passed = dense(contact.weighted.T @ grid.hats(system.contacts, position.length))
        soft = dense(contact.weighted.T @ scaled(system.softness, contact.basis))
        compliances.append(contact.compliance + soft)
        gaps.append(contact.weak(system.gap - system.holder.imposed))
        gaps_per_depth.append(np.hstack([contact.mass, passed]))
    return CoupledContacts(
        compliance=np.array(compliances),
        gap=np.array(gaps),
        gap_per_depth=np.array(gaps_per_depth),
        modes=np.array([contact.modes for contact in contacts]),
        force_modes=np.array([contact.force_modes for contact in contacts]),
        load=systems[0].holder.load + systems[0].holder.dead,
    )


def stroke_distribution(
    contacts: CoupledContacts, grid: StrokeGrids, shares: np.ndarray
) -> np.ndarray:
    """Operators from local wear rates to cycle-averaged rates of depths, shape (2, J, N, m)."""
    count, m, total = contacts.gap_per_depth.shape
    result = np.zeros((2, count, total, m))
    result[0, :, :m] = np.eye(m)
    result[1, :, m:] = contacts.gap_per_depth[:, :, m:].mT / grid.areas[:, None]
    return shares[:, None, None] * result
