"""Build a system from a model: mesh, pair and assemble, or reuse cached set-up results.

Neither the factorised stiffness nor the conduction depends on the thermal expansion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...bulk.bodies import Bodies, distribute
from ...bulk.elasticity.elasticity import Elasticity, ElasticMaterial, elasticity, pin
from ...bulk.kinematics import Kinematics, kinematics_of
from ...bulk.solvers.choice import SolverChoice, choose_solver
from ...bulk.spaces import Spaces, lagrange_spaces
from ...contact.faces.face import gather_faces
from ...contact.faces.facets import PartValues
from ...contact.operators.condensation import gap_trace
from ...contact.operators.pressure import Basis, joined_bases
from ...contact.operators.rigid_motion import (
    RigidHolder,
    RigidMode,
    Sliding,
    hold,
    joined_sliding,
    sliding,
)
from ...contact.search.pairing import Contacts, Pairing
from ...contact.ties import elastic_joints, glued_points
from ...errors import CaseError
from ...geometry.mesh.held import check_held, free_motions
from ...geometry.mesh.mixed import AnyMesh
from ...model.conditions import Heat
from ...model.interface import Interface
from ...model.model import Model, Zone
from ...parallel import on_root
from ...timer import Phases
from ..points.contact_points import (
    contact_points,
    divided_faces,
    groups_of_parts,
    require_laws,
    require_regions,
    softness_of_parts,
    worn_contact_points,
)
from ..points.probe_points import probe_points
from ..points.worn_geometry import WornGeometry
from .rigid_modes import (
    dead_load,
    dead_resultant,
    fluid_pressure,
    load_direction,
    motion_of,
    rigid_modes,
)
from .setup_cache import CacheKeys, SetupCache, inputs
from .system import System
from .thermal_system import (
    ThermalSystem,
    coupled_without_condensation,
    heat_partition,
    require_passing,
    thermal_system,
)


@dataclass(frozen=True)
class CachedBodies:
    """Bodies of a model from the cache of set-up results.

    Attributes
    ----------
    parts : SetupCache
    keys : CacheKeys
    model : Model
    choice : SolverChoice
    phases : Phases
    """

    parts: SetupCache
    keys: CacheKeys
    model: Model
    choice: SolverChoice
    phases: Phases

    def elastic(
        self, kinematics: Kinematics, bodies: Bodies, contacts: Contacts
    ) -> tuple[Elasticity, sp.csr_matrix, list[Pairing]]:
        """Elastic bodies, the trace of the gap, and the glued points. Every rank calls."""
        parts, keys, model = self.parts, self.keys, self.model
        glued = parts.get(
            "glued", keys.mesh, lambda: glued_pairings(model, bodies.comm, kinematics, bodies)
        )

        def assembled() -> tuple[Elasticity, sp.csr_matrix]:
            return elastic_system(model, kinematics, bodies, contacts, self.choice, glued)

        def expanding() -> tuple[Elasticity, sp.csr_matrix]:
            elastic, trace = parts.get("stiffness", keys.stiffness, assembled)
            return elastic.expanding(elastic_materials(model)), trace

        return *parts.get("elasticity", keys.elasticity, expanding), glued

    def conducting(
        self,
        heat: Heat,
        contacts: Contacts,
        glued: Sequence[Pairing],
        elastic: Elasticity,
        basis: Basis,
        partition: np.ndarray,
    ) -> ThermalSystem:
        """Conducting bodies, and the forces of their temperatures. Every rank calls."""
        parts, keys, degree = self.parts, self.keys, self.model.discretisation.degree
        spaces = parts.get(
            "temperatures", keys.mesh, lambda: lagrange_spaces(elastic.bodies, degree)
        )
        at = contacts, glued, elastic, spaces, basis, partition

        def assembled() -> ThermalSystem:
            return thermal_system(self.model, heat, *at, self.phases, self.choice)

        def straining() -> ThermalSystem:
            thermal = parts.get("conductivity", keys.conductivity, assembled)
            load = parts.get("thermal load", keys.elasticity, lambda: elastic.thermal_load(spaces))
            return thermal.straining(elastic, load)

        return parts.get("conduction", keys.conduction, straining)


def glued_pairings(model: Model, comm, kinematics: Kinematics, bodies: Bodies) -> list[Pairing]:
    """Opposite points of the glued faces."""
    degree = model.discretisation.degree
    return [
        glued_points(*gather_faces(bodies, tie.faces), kinematics, degree, comm)
        for tie in model.ties
    ]


def elastic_system(
    model: Model,
    kinematics: Kinematics,
    bodies: Bodies,
    contacts: Contacts,
    choice: SolverChoice,
    glued: Sequence[Pairing] = (),
) -> tuple[Elasticity, sp.csr_matrix]:
    """Assemble the elastic bodies and set up their solver. Every rank calls.

    Returns
    -------
    elastic : Elasticity
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ of the gap in the displacement spaces.
    """
    degree = model.discretisation.degree
    clamped, symmetric, rollers, mid_plane = model.supports
    elastic = elasticity(
        bodies,
        kinematics,
        degree,
        elastic_materials(model),
        clamped,
        symmetric,
        rollers,
        choice,
        mid_plane,
        joints=lambda spaces: elastic_joints(spaces, glued),
        pinned=partial(_pinned, model),
    )
    return elastic, gap_trace(elastic.spaces, contacts)


def _pinned(model: Model, spaces: Spaces, supports: list[np.ndarray]) -> list[np.ndarray]:
    """Supports with as many more values as hanging bodies have free motions. Every rank calls.

    Raises
    ------
    CaseError
        If supports that are not plane prevent such a motion.
    """
    fixed, nodes = np.concatenate(supports), spaces.nodes()
    for holder in (one for one in model.holders if one.hanging):
        own = np.zeros(len(fixed))
        own[spaces.rows(*holder.bodies)] = 1.0
        motions = [own * motion_of(holder, name).at(nodes).ravel() for name in holder.free]
        if pin(fixed, np.stack(motions, axis=1), spaces.comm).shape[1] < len(holder.free):
            raise CaseError(
                f"bodies.{holder.name}: its supports prevent the motion {' or '.join(holder.free)} "
                "in part, as their surfaces are not plane; fix one, or use a holder"
            )
    return spaces.split(fixed)


def elastic_materials(model: Model) -> dict[str, ElasticMaterial]:
    """Elastic materials by part; none expands in a model without heat."""
    hot = model.heat is not None
    return {
        part: ElasticMaterial(m.young_modulus, m.poisson_ratio, m.expansion if hot else 0.0)
        for part, m in model.materials.items()
    }


_NO_CLOSURE = 1e-9
"""Relative closure of the gap, below which a motion counts as one that no contact resists."""


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
    kinematics = kinematics_of(model.kinematics, model.thickness, model.sector)
    with phases("mesh"):
        bodies = parts.get("bodies", made_from.mesh, lambda: _meshed(model, comm, zone, worn))
    discretisation = model.discretisation
    glued_faces = [tie.faces for tie in model.ties]
    choice = choose_solver(
        discretisation.solver, bodies, discretisation.degree, single, glued_faces
    )
    with phases("pair"):
        contacts, basis = parts.get(
            "points", made_from.points, lambda: _paired(model, comm, kinematics, bodies, worn)
        )
    if worn is None:
        require_passing(model, bodies, contacts)
    coupled = coupled_without_condensation(choice, len(contacts.weights))
    made_from = made_from.solved_by(choice.name, coupled)
    with phases("assemble elasticity"):
        bodies_of = CachedBodies(parts, made_from, model, choice, phases)
        elastic, trace, glued = bodies_of.elastic(kinematics, bodies, contacts)
    dead = dead_load(model, contacts, elastic, trace)
    driven = rigid_modes(
        model.holders, contacts, lambda motion: dead_resultant(elastic, model.bodies, dead, motion)
    )
    thermal, heat = None, model.heat
    if heat is not None:
        partition = heat_partition(model, bodies, contacts)
        thermal = bodies_of.conducting(heat, contacts, glued, elastic, basis, partition)
        thermal = replace(thermal, face=replace(thermal.face, partition=partition))
    return System(
        model=model,
        bodies=bodies,
        contacts=contacts,
        elastic=elastic,
        trace=trace,
        basis=basis,
        **sliding_contact(model, kinematics, contacts, driven),
        dead_load=dead,
        thermal=thermal,
        choice=choice,
        phases=phases,
        parts=parts,
        inputs=made_from,
        worn=worn,
    )


def contacts_of(model: Model, comm) -> tuple[Contacts, RigidHolder]:
    """Contact points and holders of a model, meshed and paired as for a run. Every rank calls.

    Raises
    ------
    CaseError
        If the bodies cannot be meshed or paired, or heat cannot be carried along.
    """
    kinematics = kinematics_of(model.kinematics, model.thickness, model.sector)
    bodies = _meshed(model, comm, None, None)
    contacts, _ = _paired(model, comm, kinematics, bodies, None)
    require_passing(model, bodies, contacts)
    glued_pairings(model, comm, kinematics, bodies)
    fluid_pressure(model, contacts)
    without_loads = np.zeros(len(model.bodies))
    driven = rigid_modes(model.holders, contacts, lambda motion: without_loads)
    return contacts, hold(contacts, contacts.normals, driven)


def require_carried(model: Model, contacts: Contacts, holder: RigidHolder) -> None:
    """Reject holders with names that can move together without closing any gap.

    The only holder of a short case may have a motion that nothing opposes and nothing loads.

    Raises
    ------
    CaseError
    """
    modes = holder.modes
    if not model.named or not modes.shape[1]:
        return
    free_modes = [mode for mode, free in zip(holder.rigid_modes, holder.free, strict=True) if free]
    moved = [np.linalg.norm(mode.motion.at(contacts.on_body_1)) for mode in free_modes]
    sizes = np.linalg.norm(modes, axis=0)
    idle = sizes <= _NO_CLOSURE * np.array(moved)  # but for rounding
    modes, sizes = np.where(idle, 0.0, modes), np.where(idle, 1.0, sizes)
    values, directions = np.linalg.eigh(modes.T @ modes / np.outer(sizes, sizes))
    if values[0] > _NO_CLOSURE:
        return
    each = [(one, name) for one in model.holders for name in one.free]
    free = [pair for pair, loaded in zip(each, holder.free, strict=True) if loaded]
    parts = np.abs(directions[:, 0]) > 0.1 / len(sizes)
    moving = [pair for pair, moves in zip(free, parts, strict=True) if moves]
    for one, name in moving:
        if one.hanging:
            up = "y" if model.kinematics.startswith("plane") else "z"
            along = {"z": f"along {up}", "rotation": "about z"}.get(
                name, f"about {name[-1]}" if "-" in name else f"along {name}"
            )
            raise CaseError(
                f"bodies.{one.name}: neither its supports nor its contacts hold it {along}; needs "
                "a support (rollers, mid_plane, fixed) or a holder"
            )
    raise CaseError(
        f"holders: the free motions {', '.join(f'{one.name} ({name})' for one, name in moving)} "
        "together close no gap, so that nothing carries their loads; fix one of these holders "
        "(free = []), or give its approach"
    )


def _meshed(model: Model, comm, zone: Zone | None, worn: WornGeometry | None) -> Bodies:
    def held() -> AnyMesh:
        mesh = model.meshes.mesh(zone) if worn is None else worn.mesh
        _check_held(model, mesh)
        return mesh

    bodies = distribute(on_root(comm, held, share=False), comm)
    probe_points(model, bodies, worn is not None)  # reports points outside early
    return bodies


def _check_held(model: Model, mesh: AnyMesh) -> None:
    """Reject a body on no contact alone that its supports leave free to move."""
    clamped, *guided = model.supports
    hanging = [holder.bodies for holder in model.holders if holder.hanging]
    for group in (one for one in model.groups if one not in hanging):
        bodies = [model.bodies[index] for index in group]
        parts = tuple(part for body in bodies for part in body.parts)
        free = free_motions(mesh, parts, clamped, guided)
        if model.kinematics == "axisymmetric":
            free = ["along z" for name in free if name == "along y"]
        check_held(" and ".join(body.name for body in bodies), free)


def _paired(
    model: Model, comm, kinematics: Kinematics, bodies: Bodies, worn: WornGeometry | None
) -> tuple[Contacts, Basis]:
    """Contact points of all interfaces, and their pressure spaces."""
    gathered = [_gathered(model, one, bodies) for one in model.interfaces]
    require_regions(model, gathered)
    given = model, comm, kinematics, bodies, worn
    each = [_paired_faces(*given, index, faces) for index, faces in enumerate(gathered)]
    pairings, bases = zip(*each, strict=True)
    contacts = Contacts(pairings, tuple(interface.bodies for interface in model.interfaces))
    return contacts, joined_bases(bases)


def _gathered(model: Model, interface: Interface, bodies: Bodies) -> tuple:
    """Both faces of an interface, with the softness and groups of their materials."""
    of_parts = PartValues(softness_of_parts(model, interface), groups_of_parts(model, interface))
    return gather_faces(bodies, interface.faces, of_parts)


def _paired_faces(
    model: Model,
    comm,
    kinematics: Kinematics,
    bodies: Bodies,
    worn: WornGeometry | None,
    index: int,
    gathered: tuple,
) -> tuple[Pairing, Basis]:
    interface = model.interfaces[index]
    divided = divided_faces(model, interface, gathered)
    require_laws(model, interface, bodies, divided)
    faces = [replace(face, wears=bool(interface.wearing_in_place)) for face in divided]
    if worn is None:
        return contact_points(model, interface, comm, kinematics, *faces)
    contact = worn.contacts[index]
    if not contact.is_moved:
        return contact_points(model, interface, comm, kinematics, *faces, carrier=contact.carrier)
    moved = contact, worn.relative_motion(interface.bodies)
    return worn_contact_points(model, interface, kinematics, *moved, *faces)


def sliding_contact(
    model: Model, kinematics: Kinematics, contacts: Contacts, driven: tuple[RigidMode, ...]
) -> dict[str, Any]:
    """Attributes of a `System` that follow from its contact points and rigid modes of the holders.

    Sliding of the first bodies, its speed, the traction direction and the holders.
    """
    slides, traction_direction = None, contacts.normals
    speed = np.zeros(len(contacts.weights))
    if not all(interface.motion.at_rest for interface in model.interfaces):
        each = zip(model.interfaces, contacts.each, strict=True)
        slides = joined_sliding(
            [_sliding(model, one, kinematics, pairing) for one, pairing in each]
        )
        if model.sector_of_ring:
            slides = replace(slides, along=np.zeros_like(slides.along))
        friction, transverse = (
            contacts.per_point([getattr(one, name) for one in model.interfaces])[:, None]
            for name in ("nominal_friction", "transverse_friction")
        )
        traction_direction = slides.traction_direction(contacts.normals, friction, transverse)
        speed = slides.speed
    holder = hold(contacts, traction_direction, driven)
    return {
        "slides": slides,
        "speed": speed,
        "traction_direction": traction_direction,
        "holder": holder,
    }


def _sliding(
    model: Model, interface: Interface, kinematics: Kinematics, pairing: Pairing
) -> Sliding:
    """Sliding at the points of an interface."""
    motion, velocity = interface.motion, np.zeros((len(pairing.weights), 3))
    if not motion.at_rest:
        velocity = kinematics.sliding(pairing.points, motion, motion.center, motion.across)
    return sliding(velocity, pairing.normals, load_direction(model, interface, pairing))
