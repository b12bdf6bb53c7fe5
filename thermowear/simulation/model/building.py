"""Build a system from a case: mesh, pair and assemble, or reuse cached set-up results."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...bulk.bodies import Bodies, distribute
from ...bulk.kinematics import Model, section_model
from ...case.tables.facing import Facing
from ...case.tables.schema import Case
from ...contact.operators.holder import hold
from ...contact.operators.sliding import Sliding, sliding
from ...contact.search.closed_face import gather_faces
from ...contact.search.pairing import Pairing
from ...geometry.mesh.tagged import TaggedMesh
from ...parallel import on_root
from ...timer import Phases
from .contact_points import contact_points, facing_parts, implicit_contact_points
from .elastic_system import dead_load, dead_resultant, elastic_system
from .interface_laws import partition
from .rigid_modes import drives
from .setup_cache import SetupCache, inputs
from .system import System
from .thermal_system import ThermalSystem, thermal_system
from .wear_shares import closes_by_wear, softness_of_parts
from .worn_geometry import WornGeometry


def build(
    case: Case,
    comm,
    phases: Phases,
    zone: tuple[float, float] | None = None,
    parts: SetupCache | None = None,
    worn: WornGeometry | None = None,
) -> System:
    """Mesh, pair and assemble a case. Every rank calls.

    Parameters
    ----------
    case : Case
    comm : mpi4py.MPI.Comm
    phases : Phases
    zone : tuple of float, optional
        Range of x to mesh for, by default the contact zone that the case expects [m].
    parts : SetupCache, optional
        Set-up results of earlier systems on the same ranks, reused where the keys agree.
    worn : WornGeometry, optional
        Present node positions of the mesh; all cached parts must belong to them.

    Raises
    ------
    CaseError
        If the geometry cannot be meshed or paired.
    """
    parts, made_from = SetupCache() if parts is None else parts, inputs(case, zone)
    geometry = case.geometry
    model = section_model(case.model, geometry.thickness_factor, geometry.sector)
    with phases("mesh"):
        bodies = parts.get("bodies", made_from.mesh, lambda: _meshed(case, comm, zone, worn))
    with phases("pair"):
        pairing, basis = parts.get(
            "points", made_from.points, lambda: _paired(case, comm, model, bodies, worn)
        )
    with phases("assemble elasticity"):
        elastic, trace = parts.get(
            "elasticity", made_from.elasticity, lambda: elastic_system(case, model, bodies, pairing)
        )
    slides = sliding_of(case, model, pairing)
    pull, speed = pairing.normals, np.zeros(len(pairing.weights))
    if slides is not None:
        friction = case.contact.nominal_friction, case.contact.transverse_friction
        pull, speed = slides.pull(pairing.normals, *friction), slides.speed
    facing = facing_parts(bodies, pairing)
    dead = dead_load(case, elastic)
    driven = drives(case, pairing, lambda motion: dead_resultant(case, elastic, dead, motion)[0])
    thermal = parts.get(
        "conduction",
        made_from.conduction,
        lambda: thermal_system(case, bodies, model, pairing, elastic, basis, facing, phases),
    )
    return System(
        case=case,
        bodies=bodies,
        pairing=pairing,
        elastic=elastic,
        trace=trace,
        basis=basis,
        holder=hold(pairing, pull, driven),
        slides=slides,
        pull=pull,
        speed=speed,
        dead_load=dead,
        thermal=None if thermal is None else _exchanging(thermal, case, facing),
        phases=phases,
        parts=parts,
        inputs=made_from,
        worn=worn,
    )


def check_contact_points(case: Case, comm) -> None:
    """Mesh and pair a case as a run does, to detect errors in either step. Every rank calls.

    Raises
    ------
    CaseError
    """
    geometry = case.geometry
    model = section_model(case.model, geometry.thickness_factor, geometry.sector)
    _paired(case, comm, model, _meshed(case, comm, None, None), None)


def _meshed(
    case: Case, comm, zone: tuple[float, float] | None, worn: WornGeometry | None
) -> Bodies:
    def mesh() -> TaggedMesh:
        return case.tagged_mesh(zone) if worn is None else worn.mesh

    return distribute(on_root(comm, mesh), comm)


def _paired(
    case: Case, comm, model: Model, bodies: Bodies, worn: WornGeometry | None
) -> tuple[Pairing, np.ndarray]:
    softness = bodies.per_body(softness_of_parts(case))
    gathered = gather_faces(bodies, case.geometry.contact, softness)
    faces = [replace(face, wears=closes_by_wear(case)) for face in gathered]
    if worn is None:
        return contact_points(case, comm, model, *faces)
    return implicit_contact_points(case, model, worn, *faces)


def _exchanging(thermal: ThermalSystem, case: Case, facing: Facing) -> ThermalSystem:
    """Thermal system with the heat partition of this case."""
    return replace(thermal, face=replace(thermal.face, partition=partition(case, facing)))


def sliding_of(case: Case, model: Model, pairing: Pairing) -> Sliding | None:
    """Sliding kinematics of body 1; None without motion."""
    if case.motion is None:
        return None
    geometry = case.geometry
    velocity = model.sliding(
        pairing.points, case.motion.one_way, geometry.rotation_center, geometry.slides_across
    )
    return sliding(velocity, pairing.normals, geometry.press_direction)
