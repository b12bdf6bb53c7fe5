"""Build a system from a model: mesh, pair and assemble, or reuse cached set-up results."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...bulk.bodies import Bodies, distribute
from ...bulk.kinematics import Kinematics, kinematics_of
from ...bulk.mechanics.elasticity import Elasticity, ElasticMaterial, elasticity
from ...bulk.solver_choice import SolverChoice, choose_solver
from ...contact.operators.rigid_motion import RigidMode, hold, sliding
from ...contact.operators.traces import gap_trace
from ...contact.search.face import gather_faces
from ...contact.search.pairing import Pairing
from ...contact.search.part_values import PartValues
from ...geometry.mesh.held import check_held, free_motions
from ...geometry.mesh.mixed import AnyMesh
from ...model.model import Model, Zone
from ...parallel import on_root
from ...timer import Phases
from .contact_points import (
    contact_points,
    facing_parts,
    groups_of_parts,
    require_laws,
    softness_of_parts,
    worn_contact_points,
)
from .rigid_modes import dead_load, dead_resultant, rigid_modes
from .setup_cache import SetupCache, inputs
from .system import System
from .thermal_system import coupled_without_condensation, thermal_system
from .worn_geometry import WornGeometry


def build(
    model: Model,
    comm,
    phases: Phases,
    zone: Zone | None = None,
    parts: SetupCache | None = None,
    worn: WornGeometry | None = None,
    single: bool = False,
) -> System:
    """Mesh, pair and assemble a model. Every rank calls.

    Parameters
    ----------
    model : Model
    comm : mpi4py.MPI.Comm
    phases : Phases
    zone : tuple of float, optional
        Range of x to mesh for, by default the contact zone that the model expects [m].
    parts : SetupCache, optional
        Set-up results of earlier systems on the same ranks, reused where the keys agree.
    worn : WornGeometry, optional
        Present node positions of the mesh; all cached parts must belong to them.
    single : bool, optional
        True if the analysis needs a single solution of the bodies and no compliance: large ones
        are then solved by multigrid, and are not condensed.

    Raises
    ------
    CaseError
        If the bodies cannot be meshed or paired.
    """
    parts, made_from = SetupCache() if parts is None else parts, inputs(model, zone)
    interface = model.interface
    kinematics = kinematics_of(model.kinematics, model.thickness, model.sector)
    with phases("mesh"):
        bodies = parts.get("bodies", made_from.mesh, lambda: _meshed(model, comm, zone, worn))
    discretisation = model.discretisation
    choice = choose_solver(discretisation.solver, bodies, discretisation.degree, single)
    with phases("pair"):
        pairing, basis = parts.get(
            "points", made_from.points, lambda: _paired(model, comm, kinematics, bodies, worn)
        )
    coupled = coupled_without_condensation(choice, len(pairing.weights))
    made_from = made_from.solved_by(choice.name, coupled)
    with phases("assemble elasticity"):
        elastic, trace = parts.get(
            "elasticity",
            made_from.elasticity,
            lambda: elastic_system(model, kinematics, bodies, pairing, choice),
        )
    facing = facing_parts(bodies, pairing)
    dead = dead_load(model.holder, elastic)
    upper = model.bodies[0].parts
    driven = rigid_modes(
        model.holder, pairing, lambda motion: dead_resultant(elastic, upper, dead, motion)[0]
    )
    thermal, heat = None, model.heat
    if heat is not None:
        partition = interface.heat_partition(facing, model.materials)
        thermal = parts.get(
            "conduction",
            made_from.conduction,
            lambda: thermal_system(model, heat, pairing, elastic, basis, partition, phases, choice),
        )
        thermal = replace(thermal, face=replace(thermal.face, partition=partition))
    return System(
        model=model,
        bodies=bodies,
        pairing=pairing,
        elastic=elastic,
        trace=trace,
        basis=basis,
        **sliding_contact(model, kinematics, pairing, driven),
        dead_load=dead,
        thermal=thermal,
        choice=choice,
        phases=phases,
        parts=parts,
        inputs=made_from,
        worn=worn,
    )


def check_contact_points(model: Model, comm) -> None:
    """Mesh and pair a model as a run does, to detect errors in either step. Every rank calls.

    Raises
    ------
    CaseError
    """
    kinematics = kinematics_of(model.kinematics, model.thickness, model.sector)
    _paired(model, comm, kinematics, _meshed(model, comm, None, None), None)


def _meshed(model: Model, comm, zone: Zone | None, worn: WornGeometry | None) -> Bodies:
    def held() -> AnyMesh:
        mesh = model.meshes.mesh(zone) if worn is None else worn.mesh
        _check_held(model, mesh)
        return mesh

    return distribute(on_root(comm, held, share=False), comm)


def _check_held(model: Model, mesh: AnyMesh) -> None:
    """Reject a body that its supports leave free to move."""
    clamped, *guided = supports(model)
    for body in model.bodies:
        free = free_motions(mesh, body.parts, clamped, guided)
        if model.kinematics == "axisymmetric":
            free = ["along z" for name in free if name == "along y"]
        check_held(body.name, free)


def _paired(
    model: Model, comm, kinematics: Kinematics, bodies: Bodies, worn: WornGeometry | None
) -> tuple[Pairing, np.ndarray]:
    of_parts = PartValues(softness_of_parts(model), groups_of_parts(model))
    gathered = gather_faces(bodies, model.interface.faces, of_parts)
    require_laws(model, bodies, gathered)
    wears = bool(model.interface.wearing_in_place)
    faces = [replace(face, wears=wears) for face in gathered]
    if worn is None:
        return contact_points(model, comm, kinematics, *faces)
    return worn_contact_points(model, kinematics, worn, *faces)


def elastic_system(
    model: Model,
    kinematics: Kinematics,
    bodies: Bodies,
    pairing: Pairing,
    choice: SolverChoice,
) -> tuple[Elasticity, sp.csr_matrix]:
    """Assemble the elastic bodies and set up their solver. Every rank calls.

    Returns
    -------
    elastic : Elasticity
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ of the gap in the displacement spaces.
    """
    hot = model.heat is not None
    materials = {
        part: ElasticMaterial(m.young_modulus, m.poisson_ratio, m.expansion if hot else 0.0)
        for part, m in model.materials.items()
    }
    degree = model.discretisation.degree
    clamped, symmetric, rollers, mid_plane = supports(model)
    elastic = elasticity(
        bodies, kinematics, degree, materials, clamped, symmetric, rollers, choice, mid_plane
    )
    return elastic, gap_trace(elastic.spaces, pairing)


def supports(model: Model) -> tuple[tuple[str, ...], ...]:
    """Clamped surfaces, then those that fix the first, the second and the third component."""
    clamped, rollers, mid_plane = (
        tuple(surface for body in model.bodies for surface in getattr(body, kind))
        for kind in ("fixed", "rollers", "mid_plane")
    )
    return clamped, model.symmetry, rollers, mid_plane


def sliding_contact(
    model: Model, kinematics: Kinematics, pairing: Pairing, driven: tuple[RigidMode, ...]
) -> dict[str, Any]:
    """Attributes of a `System` that follow from its contact points and rigid modes of the holder.

    Sliding of body 1, its speed, the traction direction and the holder.
    """
    motion, slides = model.motion, None
    traction_direction, speed = pairing.normals, np.zeros(len(pairing.weights))
    if not motion.at_rest:
        velocity = kinematics.sliding(pairing.points, motion, motion.center, motion.across)
        slides = sliding(velocity, pairing.normals, model.holder.load_direction)
        if model.sector_of_ring:
            slides = replace(slides, along=np.zeros_like(slides.along))
        friction = model.interface.nominal_friction, model.interface.transverse_friction
        traction_direction = slides.traction_direction(pairing.normals, *friction)
        speed = slides.speed
    holder = hold(pairing, traction_direction, driven)
    return {
        "slides": slides,
        "speed": speed,
        "traction_direction": traction_direction,
        "holder": holder,
    }
