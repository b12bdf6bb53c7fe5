"""A case made computable: meshed, paired, assembled; condensed when first asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..bulk.bodies import Bodies, distribute
from ..bulk.elasticity import Elasticity, ElasticMaterial, elasticity
from ..bulk.kinematics import Model, section_model
from ..bulk.surface_load import surface_load
from ..case.schema import Case
from ..contact.condensation import CondensedContact, condense
from ..contact.face import gather_face
from ..contact.heat import ThermalDistortion, condense_distortion
from ..contact.holder import Holder, hold
from ..contact.pairing import Pairing, pair
from ..contact.pressure import pressure_basis
from ..contact.sliding import Sliding, sliding
from ..contact.traces import gap_trace, vector_trace
from ..laws import WearLaw
from ..laws.spreading import InPlace, Share, Spreading, Track, coverage
from ..parallel import on_root, sum_over_ranks
from .drives import drives
from .initial_shape import initial_depth
from .phases import Phases
from .thermal_system import ThermalSystem, thermal_system


@dataclass(frozen=True)
class System:
    """Everything an analysis needs.

    Attributes
    ----------
    case : Case
    bodies : Bodies
    pairing : Pairing
    elastic : Elasticity
    trace, traction : csr_matrix, shape (n_owned, n)
        Bᵀ and B_tᵀ, see `contact.pairing`.
    basis : ndarray, shape (n, m)
        Ψ.
    holder : Holder
    pull : ndarray, shape (n, gdim)
        ``n + mu e``: the traction on body 1 is minus the pressure times it.
    speed : ndarray, shape (n,)
        Sliding speed at the contact points [m/s].
    dead_load : ndarray or None, shape (n_owned,)
        Nodal forces of loads on surfaces [N].
    thermal : ThermalSystem or None
    phases : Phases
    """

    case: Case
    bodies: Bodies
    pairing: Pairing
    elastic: Elasticity
    trace: sp.csr_matrix
    traction: sp.csr_matrix
    basis: np.ndarray
    holder: Holder
    pull: np.ndarray
    speed: np.ndarray
    dead_load: np.ndarray | None
    thermal: ThermalSystem | None
    phases: Phases

    @property
    def comm(self):
        return self.bodies.mesh.comm

    @property
    def weights(self) -> np.ndarray:
        return self.pairing.weights

    @cached_property
    def gap(self) -> np.ndarray:
        """Of the unworn bodies under their dead load alone, at the points, shape (n,) [m]."""
        if self.dead_load is None:
            return self.pairing.gap
        opened = self.trace.T @ self.elastic.solve(self.dead_load)
        return self.pairing.gap + sum_over_ranks(self.comm, opened)

    @property
    def press(self) -> np.ndarray:
        """Unit vector along which body 1 is pressed on, shape (gdim,)."""
        return np.array(self.case.geometry.press_direction)

    @property
    def softness(self) -> float:
        """Compliance of the layer between the faces [m/Pa]."""
        return self.case.contact.compliance or 0.0

    @property
    def friction(self) -> float:
        return self.case.contact.friction

    @cached_property
    def laws(self) -> dict[int, WearLaw]:
        """Wear laws by index of the body (0 is body 1); bodies that do not wear are left out."""
        laws = {}
        for index, name in enumerate(self.case.geometry.bodies):
            if name in self.case.wear:
                wear = self.case.wear[name]
                κ, b, a = wear.coefficient_si(), wear.pressure_exponent, wear.velocity_exponent
                laws[index] = (
                    WearLaw.per_friction_stress(κ, self.friction, b, a)
                    if wear.per == "friction-stress"
                    else WearLaw(κ, b, a)
                )
        return laws

    @cached_property
    def spreads(self) -> dict[int, Spreading]:
        """Where the wear of each wearing body goes, by its index."""
        return {index: self._spread(index) for index in self.laws}

    def _spread(self, index: int) -> Spreading:
        geometry = self.case.geometry
        if self.case.wear[geometry.bodies[index]].spread == "in-place":
            return InPlace()
        if geometry.track is None:
            return Share(geometry.sector)
        assert geometry.thickness_factor is not None  # tracks are those of plane models
        return Track(self.weights / geometry.thickness_factor / geometry.track)

    def worn_volumes(self, worn: np.ndarray) -> np.ndarray:
        """Volumes lost by the bodies, all of their tracks, from depths (2, n), shape (2,) [m³]."""
        volumes = worn @ self.weights
        for index, spread in self.spreads.items():
            volumes[index] /= coverage(spread)
        return volumes

    @cached_property
    def contact(self) -> CondensedContact:
        """Elasticity condensed to the pressure space."""
        with self.phases("condense elasticity"):
            return condense(
                self.elastic,
                self.pairing,
                self.trace,
                self.traction,
                self.basis,
                self.holder,
                keep_influence=self.thermal is not None,
            )

    @cached_property
    def distortion(self) -> ThermalDistortion | None:
        """Thermal distortion condensed to the pressure space; None without heat."""
        thermal, contact = self.thermal, self.contact
        if thermal is None:
            return None
        with self.phases("condense distortion"):
            return condense_distortion(thermal.conduction, thermal.load, contact, thermal.face)

    def friction_heat(self, pressure: np.ndarray) -> np.ndarray:
        """``q = mu p v`` at the points [W/m²]."""
        return self.friction * pressure * self.speed


def build(case: Case, comm, phases: Phases, zone: tuple[float, float] | None = None) -> System:
    """Mesh, pair and assemble a case. Every rank calls.

    Raises
    ------
    CaseError
        If the geometry cannot be meshed or paired.
    """
    degree, geometry = case.mesh.degree, case.geometry
    model = section_model(case.model, geometry.thickness_factor, geometry.sector)
    with phases("mesh"):
        bodies = distribute(on_root(comm, lambda: case.tagged_mesh(zone)), comm)
    with phases("pair"):
        faces = [gather_face(bodies, surface) for surface in geometry.contact]
        pairing, basis = contact_points(case, comm, model, *faces)
    slides = _sliding(case, model, pairing)
    pull, speed = pairing.normals, np.zeros(len(pairing.weights))
    if slides is not None:
        friction = case.contact.friction, case.contact.transverse_friction
        pull, speed = slides.pull(pairing.normals, *friction), slides.speed
    with phases("assemble elasticity"):
        materials = {name: _elastic_material(case, name) for name in geometry.parts}
        clamped = [s for s in (geometry.held, geometry.fixed) if s not in geometry.rollers]
        elastic = elasticity(
            bodies, model, degree, materials, clamped, geometry.symmetry, geometry.rollers
        )
    trace = gap_trace(elastic.space, pairing)
    drags = not np.array_equal(pull, pairing.normals)
    return System(
        case=case,
        bodies=bodies,
        pairing=pairing,
        elastic=elastic,
        trace=trace,
        traction=vector_trace(elastic.space, pairing, pull) if drags else trace,
        basis=basis,
        holder=hold(pairing, pull, drives(case, pairing)),
        pull=pull,
        speed=speed,
        dead_load=_dead_load(case, elastic),
        thermal=thermal_system(case, bodies, model, pairing, elastic, basis, phases),
        phases=phases,
    )


def _sliding(case: Case, model: Model, pairing: Pairing) -> Sliding | None:
    """How body 1 slides; None where nothing does."""
    if case.motion is None:
        return None
    geometry = case.geometry
    velocity = model.sliding(pairing.points, case.motion.one_way, geometry.rotation_center)
    return sliding(velocity, pairing.normals, geometry.press_direction)


def contact_points(case: Case, comm, model: Model, face_1, face_2) -> tuple[Pairing, np.ndarray]:
    """Contact points, with the shape that body 1 starts from, and pressure space Ψ."""
    degree, pressure_degree = case.mesh.degree, case.contact.pressure_degree
    if pressure_degree == "lobatto":  # point by point, at the nodes of body 1's facets
        pairing = pair(face_1, face_2, model, degree + 1, refine=False)
        basis = np.eye(len(pairing.weights))
    else:
        pairing = pair(face_1, face_2, model, degree + 2)
        basis = pressure_basis(pairing, pressure_degree or max(degree - 1, 1))
    if case.geometry.initial_shape is not None:
        depth = initial_depth(comm, case.geometry.initial_shape, pairing.position)
        pairing = replace(pairing, gap=pairing.gap + depth)
    return pairing, basis


def _elastic_material(case: Case, body: str) -> ElasticMaterial:
    material = case.material(body)
    E, ν, α = material.young_modulus, material.poisson_ratio, material.expansion
    assert E is not None  # the case has been checked
    assert ν is not None
    return ElasticMaterial(E, ν, α if case.heat is not None and α is not None else 0.0)


def _dead_load(case: Case, elastic: Elasticity) -> np.ndarray | None:
    press = np.array(case.geometry.press_direction)
    loads = [
        surface_load(elastic, surface, force * press)
        for surface, force in case.load.surfaces.items()
    ]
    return np.sum(loads, axis=0) if loads else None
