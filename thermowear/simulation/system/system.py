"""System of a model: meshed, paired and assembled bodies, and the wear of their faces.

Set-up results (mesh, factors, condensed operators) are cached and shared by the cases of a sweep.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from ...bulk.bodies import Bodies
from ...bulk.elasticity.elasticity import Elasticity
from ...bulk.solvers.choice import SolverChoice
from ...contact.operators.condensation import (
    CondensedContact,
    Influence,
    component_traces,
    in_directions,
    influence,
    pressure_loads,
)
from ...contact.operators.coupled_heat import CoupledHeat
from ...contact.operators.rigid_motion import RigidHolder, RigidMode, Sliding, hold
from ...contact.operators.thermal_opening import DistortionRows, OpeningStorage, ThermalOpening
from ...contact.search.pairing import Contacts, Pairing
from ...laws.distribution import IN_PLACE, Distribution, joined_distributions
from ...laws.interfaces import Law
from ...laws.motions import RigidMotion, combined
from ...laws.wear import LayeredWear, joined_laws
from ...model.body import Facing
from ...model.face_wear import FaceWear, Wear
from ...model.interface import Interface
from ...model.model import Model, Zone
from ...model.tracks import EvenTrack
from ...parallel import sum_over_ranks
from ...timer import Phases
from ..points.contact_points import facing_parts, singular_points
from ..points.worn_geometry import WornGeometry
from .rigid_modes import approaches, dead_resultant, load_directions
from .setup_cache import CacheKeys, SetupCache
from .thermal_system import ThermalSystem


@dataclass(frozen=True)
class JointWear:
    """Wear at the contact points of a model.

    Attributes
    ----------
    model : Model
    contacts : Contacts
    """

    model: Model
    contacts: Contacts

    @cached_property
    def laws(self) -> dict[int, Law]:
        """Wear laws of the first (0) and of the second faces; faces without wear are left out."""
        return self.laws_of(self._counts)

    def laws_of(self, counts: Sequence[int]) -> dict[int, Law]:
        """Wear laws, likewise, of numbers of points or pressure functions of each interface."""
        return {
            side: joined_laws([_law(wear, pairing, side) for wear, pairing in each], counts)
            for side, each in self._sides.items()
        }

    @cached_property
    def spreads(self) -> dict[int, Distribution]:
        """Distribution of the wear of these faces, likewise."""
        return {
            side: joined_distributions(
                [self._distribution(wear, pairing) for wear, pairing in each],
                self._counts,
                [_track(wear) or str(k) for k, (wear, _) in enumerate(each)],
            )
            for side, each in self._sides.items()
        }

    @cached_property
    def coverage(self) -> np.ndarray:
        """Fraction of the worn area of each face that is in contact at a time, shape (2, n)."""
        result = np.ones((2, sum(self._counts)))
        for side, spread in self.spreads.items():
            result[side] = spread.coverage
        return result

    def _distribution(self, wear: Wear | None, pairing: Pairing) -> Distribution:
        thickness = self.model.thickness or 1.0
        if wear is None:
            return IN_PLACE
        return wear.distribution(pairing.points, pairing.weights, thickness)

    @property
    def _counts(self) -> list[int]:
        return [len(pairing.weights) for pairing in self.contacts.each]

    @cached_property
    def _sides(self) -> dict[int, list[tuple[Wear | None, Pairing]]]:
        """Wear of a side of every interface, with its points, for the sides that wear anywhere."""
        interfaces = self.model.interfaces
        worn = sorted({side for interface in interfaces for side in interface.wear})
        pairs = list(zip(interfaces, self.contacts.each, strict=True))
        return {side: [(one.wear.get(side), pairing) for one, pairing in pairs] for side in worn}


def _law(wear: Wear | None, pairing: Pairing, side: int) -> Law | None:
    """Law of a side of an interface; None where it does not wear."""
    if wear is None:
        return None
    law = wear.law_at(pairing.groups[side])
    if not (isinstance(law, LayeredWear) and wear.in_place):  # tracks are worn evenly
        return law
    return replace(law, variation=depth_variation(pairing))


def depth_variation(pairing: Pairing) -> np.ndarray:
    """Range of the wear depth between the neighbours of each point, (n,) [m].

    That of the unworn gap: constant in time, as the depth has to be a function of the dose alone.
    """
    facet, gap, area = pairing.carrying.facet, pairing.gap, pairing.weights
    low, high = np.full((2, facet.max() + 1), [[np.inf], [-np.inf]])
    np.minimum.at(low, facet, gap)
    np.maximum.at(high, facet, gap)
    share = area / np.bincount(facet, area)[facet]
    return 2 * (high - low)[facet] * share ** (1 / pairing.carrying.face.dim)


def _track(wear: Wear | None) -> str:
    """Name of the track that passes several interfaces; empty for one of its own."""
    track = wear.track if isinstance(wear, FaceWear) else None
    return track.name if isinstance(track, EvenTrack) else ""


_DEPENDENT = 1e-10
"""Relative singular value below which motions are linearly dependent."""


@dataclass(frozen=True)
class System:
    """Bodies, interfaces and loads of an analysis.

    Attributes
    ----------
    model : Model
    bodies : Bodies
    contacts : Contacts
    elastic : Elasticity
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ, see `contact.search.pairing`.
    basis : ndarray, shape (n, m)
        Pressure basis Ψ.
    holder : RigidHolder
    slides : Sliding or None
        Sliding kinematics of the first bodies of the interfaces; None without motion.
    traction_direction : ndarray, shape (n, gdim)
        Traction direction ``n + mu e``: the traction on the first body is ``-p (n + mu e)``.
    speed : ndarray, shape (n,)
        Sliding speed at the contact points [m/s].
    dead_load : ndarray or None, shape (n_owned,)
        Nodal forces of the surface loads and of fluids between the faces [N].
    thermal : ThermalSystem or None
    choice : SolverChoice
        Solver of the bodies.
    phases : Phases
    parts : SetupCache
        Set-up results shared with other systems.
    inputs : CacheKeys
        Cache keys of this system.
    worn : WornGeometry or None
        Present if the meshes have been moved to the worn faces. The gap of the pairing remains that
        of the unworn bodies: the gap of the moved meshes minus the depths that they have lost.
    """

    model: Model
    bodies: Bodies
    contacts: Contacts
    elastic: Elasticity
    trace: sp.csr_matrix
    basis: np.ndarray
    holder: RigidHolder
    slides: Sliding | None
    traction_direction: np.ndarray
    speed: np.ndarray
    dead_load: np.ndarray | None
    thermal: ThermalSystem | None
    choice: SolverChoice
    phases: Phases
    parts: SetupCache
    inputs: CacheKeys
    worn: WornGeometry | None = None

    @cached_property
    def comm(self):
        return self.bodies.comm

    @cached_property
    def zone(self) -> Zone | None:
        """Range of x that the bodies are meshed for; None where the mesh has no zone [m]."""
        return self.inputs.mesh[-1]

    @property
    def pairing(self) -> Pairing:
        """Contact points of the only interface, with its faces; see `Contacts.only`."""
        return self.contacts.only

    @property
    def ranges_by_name(self) -> dict[str, slice]:
        """Ranges of the contact points by the names of the interfaces; empty without names."""
        pairs = zip(self.model.interfaces, self.contacts.ranges, strict=True)
        return {one.name: own for one, own in pairs if one.name}

    @cached_property
    def weights(self) -> np.ndarray:
        return self.contacts.weights

    @cached_property
    def gap(self) -> np.ndarray:
        """Gap of the unworn bodies under the dead load alone at the points, shape (n,) [m]."""
        if self.dead_load is None:
            return self.contacts.gap
        opened = self.trace.T @ self.elastic.solve(self.dead_load)
        return self.contacts.gap + sum_over_ranks(self.comm, opened)

    def dead_resultant(self, motion: RigidMotion) -> np.ndarray:
        """Generalised forces of the dead load on a motion of each body, (n_bodies,) [N or N m]."""
        return dead_resultant(self.elastic, self.model.bodies, self.dead_load, motion)

    @cached_property
    def facing(self) -> tuple[Facing, ...]:
        """Parts in contact at the contact points of each interface."""
        return tuple(facing_parts(self.bodies, pairing) for pairing in self.contacts.each)

    @cached_property
    def load_directions(self) -> np.ndarray:
        """Load direction of the first body at each point, unit vectors of shape (n, gdim)."""
        return load_directions(self.model, self.contacts)

    def normal_forces(self, pressure: np.ndarray) -> list[float]:
        """Resultants of the pressure on the faces of each interface, ``|∫ p n dA|`` [N]."""
        return [float(np.linalg.norm(each @ pressure)) for each in self.resultants]

    @cached_property
    def resultants(self) -> list[np.ndarray]:
        """Forces at each interface per pressure at the points, shape (k, n) [m²].

        Of the whole body: components cancel along the radius of an axisymmetric model, and across
        planes of symmetry that cut both bodies.
        """
        found = []
        for interface, (pairing, own) in zip(self.model.interfaces, self.contacts, strict=True):
            remaining = pairing.normals[:, ~self.cancelled(interface)].T
            found.append(np.zeros((len(remaining), len(self.weights))))
            found[-1][:, own] = remaining * pairing.weights
        return found

    def cancelled(self, interface: Interface) -> np.ndarray:
        """Components of forces at an interface that cancel in the whole body, bool (gdim,)."""
        bodies = [self.model.bodies[body] for body in interface.bodies]
        result = np.zeros(self.bodies.dim, dtype=bool)
        result[0] = self.model.kinematics == "axisymmetric" or bool(self.model.symmetry)
        if self.contacts.in_space:
            result[1:] = all(b.rollers for b in bodies), all(b.mid_plane for b in bodies)
        return result

    @cached_property
    def modes_of_holders(self) -> tuple[slice, ...]:
        """Range of the rigid modes of each holder."""
        ends = np.cumsum([0, *(len(holder.free) for holder in self.model.holders)])
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    def motions(self, amounts: np.ndarray) -> tuple[RigidMotion, ...]:
        """Motion of each holder by the amounts of all rigid modes, shape (n_modes,)."""
        modes = self.holder.motions
        return tuple(combined(modes[own], amounts[own]) for own in self.modes_of_holders)

    def closed_by(self, motions: Sequence[RigidMotion]) -> np.ndarray:
        """Gap closed by motions of the holders, shape (n,) [m]."""
        pairs = zip(self.model.holders, motions, strict=True)
        modes = [RigidMode(motion, amplitude=1.0, bodies=holder.bodies) for holder, motion in pairs]
        return hold(self.contacts, self.contacts.normals, modes).closure.sum(axis=1)

    @cached_property
    def approaches(self) -> np.ndarray:
        """Displacement of the pivot of the first holder along its load per mode, (n_modes,)."""
        return approaches(self.model.holders, self.holder.motions)

    @cached_property
    def mean_pressure(self) -> float:
        """Pressure of the order of those in contact, as a first guess [Pa]."""
        force, area = sum(h.force or 0.0 for h in self.model.holders), float(self.weights.sum())
        return (force or area) / area

    @cached_property
    def softness(self) -> np.ndarray:
        """Compliance of the layer between the faces, shape (n,) [m/Pa]."""
        return self.contacts.per_point([one.compliance for one in self.model.interfaces])

    @cached_property
    def at_singular_edges(self) -> np.ndarray:
        """Points at edges where unworn bodies have a singular pressure, (n,). Every rank calls."""
        return singular_points(self.bodies, self.contacts, self.softness)

    @cached_property
    def at_rest(self) -> np.ndarray:
        """Points of contacts without sliding, bool of shape (n,)."""
        return self.contacts.per_point([one.motion.at_rest for one in self.model.interfaces]) > 0

    @cached_property
    def divided_motions(self) -> tuple[np.ndarray, np.ndarray]:
        """Free motions of the holders, by columns: that contacts at rest admit, and do not.

        Shapes (k, a) and (k, b) with a + b = k. Contacts at rest neither open nor close by the
        first, as wear goes on.
        """
        modes = self.holder.modes[self.at_rest]
        size = np.abs(modes).max(axis=0, initial=0.0)
        if not size.any():
            return np.eye(len(size)), np.zeros((len(size), 0))
        size[size == 0.0] = 1.0
        _, values, rows = np.linalg.svd(modes / size)
        rank = int((values > _DEPENDENT * values[0]).sum())
        columns = rows.T / size[:, None]
        return columns[:, rank:], columns[:, :rank]

    @cached_property
    def friction(self) -> np.ndarray:
        """Nominal coefficient of friction at the points, shape (n,)."""
        return self.contacts.per_point([one.nominal_friction for one in self.model.interfaces])

    @cached_property
    def _wear(self) -> JointWear:
        return JointWear(self.model, self.contacts)

    @cached_property
    def laws(self) -> dict[int, Law]:
        """Wear laws of the first (0) and of the second faces; faces without wear are left out."""
        return self._wear.laws

    @cached_property
    def spreads(self) -> dict[int, Distribution]:
        """Distribution of the wear of these faces, likewise."""
        return self._wear.spreads

    @cached_property
    def coverage(self) -> np.ndarray:
        """Fraction of the worn area of each face that is in contact at a time, shape (2, n)."""
        return self._wear.coverage

    @cached_property
    def lost(self) -> np.ndarray:
        """Volumes removed from the meshes behind both faces, shape (n_interfaces, 2) [m³]."""
        return np.zeros((len(self.contacts.each), 2)) if self.worn is None else self.worn.lost

    @cached_property
    def moved(self) -> np.ndarray:
        """Wear depths already removed from the meshes at the points, shape (2, n) [m]."""
        if self.worn is None:
            return np.zeros((2, len(self.weights)))
        return self.worn.moved(self.contacts)

    @cached_property
    def worn_areas(self) -> np.ndarray:
        """Areas worn to the depth of each point, whole tracks included, shape (2, n) [m²]."""
        return self.weights / self.coverage

    @property
    def influence(self) -> Influence:
        """Responses of the bodies to the pressure basis functions. Every rank calls."""
        return self.parts.get("influence", self.inputs.elasticity, self._influence)

    def _influence(self) -> Influence:
        bodies = self.elastic, self.weights, self.trace, self.basis
        if self.thermal is None:
            return influence(*bodies)
        loads = self.thermal.load_matrices
        if self.opening_storage.kept:
            return influence(*bodies, loads)
        rows = DistortionRows(*self.thermal.condensed, self.basis.shape[1])
        found = influence(*bodies, loads, rows)
        self.parts.get("distortion", self.inputs.conduction, rows.finish)
        return found

    @cached_property
    def opening_storage(self) -> OpeningStorage:
        """Memory of the weak gap per temperature of the bodies."""
        thermal, m = self.thermal, self.basis.shape[1]
        if thermal is None or isinstance(thermal.face, CoupledHeat):
            return OpeningStorage(0, m, self.choice.available)
        nodes = len(thermal.load_matrices) * thermal.conduction.spaces.total
        return OpeningStorage(nodes, m, self.choice.available)

    @cached_property
    def thermal_opening(self) -> ThermalOpening:
        """Weak gap opened by temperatures of the bodies. Every rank calls."""
        assert self.thermal is not None
        found = self.influence
        loads = pressure_loads(self.trace, found.weighted)
        return ThermalOpening(self.elastic, loads, self.thermal.load_matrices, found.per_rise)

    @cached_property
    def contact(self) -> CondensedContact:
        """Elasticity condensed to the pressure space."""
        with self.phases("condense elasticity"):
            return self.influence.condensed(self.traction, self.holder)

    def worn_through(self) -> System:
        """System of faces that have lost all their layers."""
        return replace(self, model=self.model.worn_through) if self.model.coated else self

    def with_friction(self, friction: np.ndarray) -> System:
        """System with given coefficients of friction (n,) in place of the nominal one."""
        if self.slides is None or np.all(friction == self.friction):
            return self
        transverse = [one.transverse_friction for one in self.model.interfaces]
        traction_direction = self.slides.traction_direction(
            self.contacts.normals, friction[:, None], self.contacts.per_point(transverse)[:, None]
        )
        return replace(
            self,
            holder=hold(self.contacts, traction_direction, self.holder.rigid_modes),
            traction_direction=traction_direction,
        )

    @cached_property
    def traction(self) -> sp.csr_matrix:
        """B_tᵀ, shape (n_owned, n), see `contact.search.pairing`; Bᵀ without in-plane friction."""
        if np.array_equal(self.traction_direction, self.contacts.normals):
            return self.trace
        spaces, made_from = self.elastic.spaces, self.inputs.elasticity
        along = self.parts.get("traces", made_from, lambda: component_traces(spaces, self.contacts))
        return in_directions(along, self.traction_direction)
