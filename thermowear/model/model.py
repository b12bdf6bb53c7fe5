"""Model: bodies, their interfaces, holders, motion and meshes, as input of all analyses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, Protocol

from ..errors import CaseError
from ..geometry.mesh.mixed import AnyMesh
from ..laws.time_course import LoadHistory, TimeFunction
from .body import Body, Material
from .conditions import Heat, Holder, Motion
from .interface import Interface

Solver = Literal["auto", "direct", "multigrid"]
"""Linear solver of bodies in space."""
Zone = tuple[float, float]
"""Range of x [m]."""


class MeshSource(Protocol):
    """Mesh of the bodies with named parts and surfaces; sources of equal meshes compare equal.

    Attributes
    ----------
    path : str or None
        File that the mesh is read from: it is identified by a checksum. None for built meshes.
    """

    @property
    def path(self) -> str | None: ...

    def mesh(self, zone: Zone | None) -> AnyMesh:
        """Mesh for a contact zone, by default the expected one; called on rank 0.

        Raises
        ------
        CaseError
            If it cannot be made.
        """
        ...

    def expected_zone(
        self, force: float | None, approach: float | None, modulus: float
    ) -> Zone | None:
        """Estimate of the contact zone, for which the mesh is refined; None if it has no zone.

        A face may reach beyond its zone: a contact that comes near its end has outgrown the mesh.

        Parameters
        ----------
        force : float or None
            Normal force [N].
        approach : float or None
            Approach of body 1 [m].
        modulus : float
            Contact modulus E*, ``1/E* = Σ (1 - ν²)/E`` [Pa].
        """
        ...


@dataclass(frozen=True)
class Discretisation:
    """Finite-element spaces on the mesh.

    Attributes
    ----------
    degree : int
        Polynomial degree of displacement and temperature.
    positioning : bool
        Move the mesh until element ends coincide with the contact edges.
    solver : str
        Linear solver of bodies in space: ``"auto"`` (by size), ``"direct"`` or ``"multigrid"``.
    """

    degree: int
    positioning: bool = False
    solver: Solver = "auto"


@dataclass(frozen=True)
class Model:
    """Bodies in contact, without the analysis to make.

    Attributes
    ----------
    kinematics : str
        ``"axisymmetric"``, ``"plane-strain"``, ``"plane-stress"`` or ``"3d"``.
    bodies : tuple of Body
        The held body first.
    interfaces : tuple of Interface
    holders : tuple of Holder
    meshes : MeshSource
    discretisation : Discretisation
    motion : Motion
    heat : Heat or None
        None: isothermal.
    thickness : float or None
        Thickness that forces of plane models refer to, doubled in half models [m].
    sector : float
        Fraction of the circumference covered by an axisymmetric body 1.
    symmetry : tuple of str
        Surfaces on a plane of symmetry x = const.
    title : str

    Raises
    ------
    CaseError
        If it has more than one pair of bodies.
    """

    kinematics: Literal["axisymmetric", "plane-strain", "plane-stress", "3d"]
    bodies: tuple[Body, ...]
    interfaces: tuple[Interface, ...]
    holders: tuple[Holder, ...]
    meshes: MeshSource
    discretisation: Discretisation
    motion: Motion = field(default_factory=Motion)
    heat: Heat | None = None
    thickness: float | None = None
    sector: float = 1.0
    symmetry: tuple[str, ...] = ()
    title: str = ""

    def __post_init__(self):
        counts = len(self.bodies), len(self.interfaces), len(self.holders)
        if counts != (2, 1, 1):
            raise CaseError(
                "model: needs two bodies, one interface and one holder; found {} bodies, {} "
                "interfaces and {} holders".format(*counts)
            )

    @cached_property
    def interface(self) -> Interface:
        """The interface of the pair."""
        return self.interfaces[0]

    @cached_property
    def holder(self) -> Holder:
        """The holder of body 1."""
        return self.holders[0]

    @cached_property
    def materials(self) -> Mapping[str, Material]:
        """Materials by part: those of the bodies, then those of their other parts."""
        own = {body.name: body.materials[body.name] for body in self.bodies}
        return own | {part: m for body in self.bodies for part, m in body.materials.items()}

    @property
    def sector_of_ring(self) -> bool:
        """True if planes of symmetry cut a sector from bodies that rotate in space.

        The shear traction of friction is antisymmetric about these planes. It twists the whole ring
        without changing gap or pressure, and is left out, as in axisymmetric models. A mid-plane,
        normal to the axis of rotation, cuts no sector: the shear is symmetric about it.
        """
        cut = self.symmetry or any(body.rollers for body in self.bodies)
        return bool(cut) and self.kinematics == "3d" and self.motion.center is not None

    @property
    def pressure_degree(self) -> int:
        """Degree of the pressure space, by default one below that of the displacement."""
        own, degree = self.interface.pressure_degree, self.discretisation.degree
        if own == "lobatto":  # as many functions per facet as the displacement
            return degree
        return own or max(degree - 1, 1)

    @property
    def modulus(self) -> float:
        """Contact modulus E*, ``1/E* = Σ (1 - ν²)/E`` [Pa]."""
        return 1 / sum(body.compliance for body in self.bodies)

    @property
    def expected_zone(self) -> Zone | None:
        """Estimate of the contact zone; None where the mesh has no zone."""
        return self.meshes.expected_zone(self.holder.force, self.holder.approach, self.modulus)

    @property
    def histories(self) -> list[LoadHistory | TimeFunction]:
        """Functions of time of loads, speed, friction and temperatures."""
        heat = () if self.heat is None else self.heat.histories
        given = self.holder.history, self.motion.history, self.interface.friction_history, *heat
        return [history for history in given if history is not None]

    def ring(self, surface: str) -> float:
        """Area of a surface relative to that in the model, see `Body.ring`."""
        return next((body.ring for body in self.bodies if surface in body.surfaces), 1.0)
