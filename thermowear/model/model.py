"""Model: bodies, their interfaces, holders, motion and meshes, as input of all analyses."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, Protocol, TypeVar

from ..errors import CaseError
from ..geometry.mesh.mixed import AnyMesh
from ..laws.histories import LoadHistory, TimeFunction
from .body import Body, Material
from .conditions import Heat, Holder, Motion
from .interface import Interface
from .probe import Probe
from .tie import Tie, glued_bodies

Solver = Literal["auto", "direct", "multigrid"]
"""Linear solver of bodies in space."""
Zone = tuple[float, float]
"""Range of x [m]."""
Item = TypeVar("Item", Interface, Holder)
_IN_SECTION = {"x": {1}, "z": {0}, "rotation": set[int]()}
_LOOSE: Mapping[str, Mapping[str, set[int]]] = {
    "axisymmetric": {"z": {0}},
    "plane-strain": _IN_SECTION,
    "plane-stress": _IN_SECTION,
    "3d": {
        "x": {1, 2},
        "y": {0, 2},
        "z": {0, 1},
        "rotation-x": {0},
        "rotation-y": {1},
        "rotation": {2},
    },
}
"""Axes of the supports that leave a motion free, by kinematic model."""


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
        None where supports hold all bodies.
    meshes : MeshSource
    discretisation : Discretisation
    ties : tuple of Tie
        Glued faces.
    probes : tuple of Probe
    heat : Heat or None
        None: isothermal.
    thickness : float or None
        Thickness that forces of plane models refer to, doubled in half models [m].
    sector : float
        Fraction of the circumference covered by an axisymmetric body 1.
    symmetry : tuple of str
        Surfaces on a plane of symmetry x = const.
    surface_pressures : mapping of str to float
        Pressures on surfaces of any body, towards the body, constant in time [Pa].
    title : str

    Raises
    ------
    CaseError
        If interfaces or holders name bodies that it does not have, or a body has two holders.
    """

    kinematics: Literal["axisymmetric", "plane-strain", "plane-stress", "3d"]
    bodies: tuple[Body, ...]
    interfaces: tuple[Interface, ...]
    holders: tuple[Holder, ...]
    meshes: MeshSource
    discretisation: Discretisation
    heat: Heat | None = None
    thickness: float | None = None
    sector: float = 1.0
    symmetry: tuple[str, ...] = ()
    title: str = ""
    ties: tuple[Tie, ...] = ()
    probes: tuple[Probe, ...] = ()
    surface_pressures: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self):
        if not self.interfaces:
            raise CaseError("model: needs at least one interface")
        held = [index for holder in self.holders for index in holder.bodies]
        named = [*held, *(index for interface in self.interfaces for index in interface.bodies)]
        if len(set(held)) < len(held) or max(named) >= len(self.bodies):
            raise CaseError(
                f"model: interfaces and holders refer to the bodies {sorted(set(named))} of "
                f"{len(self.bodies)}, and each may have one holder only"
            )

        for holder in self.holders:
            bearing = [h for h in self.holders if h.name == holder.reaction and h is not holder]
            admitted = [h.admits(holder.pressing_force) for h in bearing]
            if holder.reaction and (admitted != [True] or holder.force is None):
                raise CaseError(
                    f"model: the reaction of the holder {holder.name!r} needs its force, and one "
                    f"other holder {holder.reaction!r} that is free along it, without an approach"
                )

        for tie in self.ties:
            if len({self.bodies[index].ring for index in tie.bodies}) > 1:
                raise CaseError(
                    f"model: the tie {tie.name!r} joins a whole ring and a sector; glued bodies "
                    "must both be whole rings, or both cover the sector"
                )

    @property
    def named(self) -> bool:
        """Whether contacts and holders have names; those of a short case have none."""
        return any(one.name for one in self.interfaces)

    @cached_property
    def groups(self) -> list[tuple[int, ...]]:
        """Indices of the bodies of each group: of one body, or of those glued to each other."""
        return glued_bodies(len(self.bodies), self.ties)

    @cached_property
    def interface(self) -> Interface:
        """The interface of a pair.

        Raises
        ------
        CaseError
            If there are several.
        """
        return self._only(self.interfaces, "interface")

    @cached_property
    def holder(self) -> Holder:
        """The holder of body 1 of a pair.

        Raises
        ------
        CaseError
            If there are several.
        """
        return self._only(self.holders, "holder")

    @property
    def motion(self) -> Motion:
        """Sliding of body 1 of a pair over body 2."""
        return self.interface.motion

    @property
    def supports(self) -> tuple[tuple[str, ...], ...]:
        """Clamped surfaces, then those that fix the first, the second and the third component."""
        clamped, rollers, mid_plane = (
            tuple(surface for body in self.bodies for surface in getattr(body, kind))
            for kind in ("fixed", "rollers", "mid_plane")
        )
        return clamped, self.symmetry, rollers, mid_plane

    @property
    def coated(self) -> bool:
        """True if a face has layers."""
        return any(interface.coated for interface in self.interfaces)

    @property
    def worn_through(self) -> Model:
        """Model of faces that have lost all their layers."""
        return replace(self, interfaces=tuple(one.worn_through for one in self.interfaces))

    def faster(self, factor: float) -> Model:
        """Model with all sliding faster by a factor."""
        moved = [replace(one, motion=one.motion.faster(factor)) for one in self.interfaces]
        return replace(self, interfaces=tuple(moved))

    def _only(self, each: tuple[Item, ...], kind: str) -> Item:
        if len(each) > 1:
            raise CaseError(
                f"model: has {len(each)} {kind}s; this is supported for two bodies with one "
                "interface and one holder only"
            )
        return each[0]

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
        turns = any(interface.motion.center is not None for interface in self.interfaces)
        return bool(cut) and self.kinematics == "3d" and turns

    def pressure_degree(self, interface: Interface) -> int:
        """Degree of a pressure space, by default one below that of the displacement."""
        own, degree = interface.pressure_degree, self.discretisation.degree
        if own == "lobatto":  # as many functions per facet as the displacement
            return degree
        return own or max(degree - 1, 1)

    @property
    def modulus(self) -> float:
        """Contact modulus E*, ``1/E* = Σ (1 - ν²)/E`` [Pa]."""
        return 1 / sum(body.compliance for body in self.bodies)

    @property
    def expected_zone(self) -> Zone | None:
        """Estimate of the contact zone; None where the mesh has no zone, as of several pairs."""
        if len(self.interfaces) > 1 or len(self.holders) != 1:
            return None
        return self.meshes.expected_zone(self.holder.force, self.holder.approach, self.modulus)

    @property
    def histories(self) -> list[LoadHistory | TimeFunction]:
        """Functions of time of loads, speed, friction and temperatures."""
        heat = () if self.heat is None else self.heat.histories
        given: list[LoadHistory | TimeFunction | None] = [h.history for h in self.holders]
        for interface in self.interfaces:
            given += [interface.motion.history, interface.friction_history]
        return [history for history in (*given, *heat) if history is not None]

    @property
    def method(self) -> str:
        """Contact method, of all interfaces.

        Raises
        ------
        CaseError
            If several interfaces have another one than the condensed method.
        """
        names = {interface.method.name for interface in self.interfaces}
        if len(self.interfaces) > 1 and names != {"condensed"}:
            raise CaseError(
                f"model: several interfaces need the condensed method; found {sorted(names)}"
            )
        return self.interfaces[0].method.name

    @property
    def wears(self) -> bool:
        """True if any face has a wear law."""
        return any(interface.wear for interface in self.interfaces)

    def ring(self, surface: str) -> float:
        """Area of a surface relative to that in the model, see `Body.ring`."""
        return next((body.ring for body in self.bodies if surface in body.surfaces), 1.0)


def hanging_holders(
    kinematics: str,
    bodies: Sequence[Body],
    symmetry: Sequence[str],
    groups: Sequence[tuple[int, ...]],
    held: Collection[int],
) -> tuple[Holder, ...]:
    """Free motions of the bodies that neither a holder nor a clamped surface holds.

    Other supports lie in planes normal to an axis: they prevent motions along it, and rotations
    about the other axes. Those that are left must be carried by contacts.

    Parameters
    ----------
    kinematics : str
    bodies : sequence of Body
    symmetry : sequence of str
        Surfaces on planes of symmetry.
    groups : sequence of tuple of int
        Bodies that are glued to each other, by index.
    held : collection of int
        Bodies on holders.
    """
    found = []
    for group in groups:
        members = [bodies[index] for index in group]
        if not set(held).isdisjoint(group) or any(body.fixed for body in members):
            continue
        planes = {
            0: any(surface in symmetry for body in members for surface in body.surfaces),
            1: any(body.rollers for body in members),
            2: any(body.mid_plane for body in members),
        }
        axes = {axis for axis, present in planes.items() if present}
        free = tuple(name for name, allowed in _LOOSE[kinematics].items() if axes <= allowed)
        if free:
            origin = (0.0,) * (3 if kinematics == "3d" else 2)
            down = (*origin[:-1], -1.0)
            name = members[0].name
            found.append(Holder(down, origin, origin, free, bodies=group, name=name, hanging=True))
    return tuple(found)
