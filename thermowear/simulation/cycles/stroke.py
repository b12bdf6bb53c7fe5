"""Discretised stroke of a reciprocating body 1: positions, mean speeds and contact systems."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from ...contact.operators.rigid_motion import hold, sliding
from ...contact.operators.traces import gap_trace
from ...contact.search.contacts import Contacts
from ...contact.solvers.coupled_positions import CoupledContacts
from ...contact.wear.track import StrokeGrid
from ...errors import CaseError
from ...model.analyses import ReciprocatingAnalysis
from ..system.contact_points import contact_points
from ..system.rigid_modes import rigid_modes
from ..system.setup_cache import SetupCache
from ..system.system import System

_UNPAIRED = 1e-6


@dataclass(frozen=True)
class Position:
    """Position of body 1 with a sliding direction, representing the stroke around it.

    Attributes
    ----------
    offset : float
        Offset along x from mid-stroke [m].
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


def positions(system: System, settings: ReciprocatingAnalysis) -> list[Position]:
    """Midpoints of stroke parts of equal duration, from one end to the other.

    Time shares and mean speeds reproduce the period and the length of the stroke exactly. Without
    friction in the section both sliding directions are equivalent; otherwise both are listed.
    """
    count = settings.positions
    ends = settings.amplitude * np.sin(np.pi * (np.arange(count + 1) / count - 0.5))
    directions = (1, -1) if system.traction is not system.trace else (1,)
    return [
        Position(
            offset=float(start + end) / 2,
            length=float(end - start),
            speed=float(end - start) * 2 * count * settings.frequency,
            share=1 / (count * len(directions)),
            system=moved(system, float(start + end) / 2, direction),
        )
        for direction in directions
        for start, end in itertools.pairwise(ends)
    ]


def moved(system: System, offset: float, direction: int) -> System:
    """System with body 1 moved along x and sliding along +x (direction 1) or -x (direction -1).

    Raises
    ------
    CaseError
        If body 1 leaves the face of body 2.
    """
    model, kinematics = system.model, system.elastic.kinematics
    face_1, face_2 = (side.face for side in system.pairing.sides)
    face_1 = replace(face_1, nodes=face_1.nodes + np.array([offset, 0.0]))
    with system.phases("pair"):
        given = model, model.interface, system.comm, kinematics
        pairing, basis = contact_points(*given, face_1, face_2)
    if pairing.unpaired > system.pairing.unpaired + _UNPAIRED:
        raise CaseError(
            f"motion.amplitude: {pairing.unpaired:.2%} of {model.interface.faces[0]} leaves "
            f"{model.interface.faces[1]} where body 1 is moved by {offset:.4g} m; a longer face of "
            "body 2 is needed (geometry.stroke)"
        )
    velocity = direction * kinematics.sliding(pairing.points, model.motion)
    slides = sliding(velocity, pairing.normals, model.holder.load_direction)
    friction = model.interface.nominal_friction, model.interface.transverse_friction
    traction_direction = slides.traction_direction(pairing.normals, *friction)
    on_1, on_2 = pairing.sides
    in_place = replace(pairing, sides=(replace(on_1, face=system.pairing.sides[0].face), on_2))
    still = Contacts((in_place,))
    return replace(
        system,
        contacts=Contacts((pairing,)),
        trace=gap_trace(system.elastic.spaces, Contacts((pairing,))),
        basis=basis,
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


def condensed(stroke: list[Position], grid: StrokeGrid) -> CoupledContacts:
    """Condensed contacts in all positions. Every rank calls."""
    systems = [position.system for position in stroke]
    contacts = [system.contact for system in systems]
    compliances, gaps, gaps_per_depth = [], [], []
    for position, system, contact in zip(stroke, systems, contacts, strict=True):
        mean = contact.mass
        passed = contact.weighted.T @ grid.hats(system.pairing, position.length)
        compliances.append(contact.compliance + system.model.interface.compliance * mean)
        gaps.append(contact.weak(system.gap - system.holder.imposed))
        gaps_per_depth.append(np.hstack([mean, passed]))
    return CoupledContacts(
        compliance=np.array(compliances),
        gap=np.array(gaps),
        gap_per_depth=np.array(gaps_per_depth),
        modes=np.array([contact.modes for contact in contacts]),
        force_modes=np.array([contact.force_modes for contact in contacts]),
        load=systems[0].holder.load + systems[0].holder.dead,
    )


def stroke_distribution(
    contacts: CoupledContacts, grid: StrokeGrid, shares: np.ndarray
) -> np.ndarray:
    """Operators from local wear rates to cycle-averaged rates of depths, shape (2, J, N, m)."""
    count, m, total = contacts.gap_per_depth.shape
    result = np.zeros((2, count, total, m))
    result[0, :, :m] = np.eye(m)
    result[1, :, m:] = contacts.gap_per_depth[:, :, m:].mT / grid.areas[:, None]
    return shares[:, None, None] * result
