"""Contact points, pressure space, and the materials that the points lie on.

A contact that ends at a sharp edge of one body, while the smooth surface of the other one goes on
(within the contact face, or beyond its end there), has
a pressure that grows towards the edge like a negative power of the distance (Dundurs and Lee, J.
Elasticity 2 (1972) 109): the finer the elements, the larger the largest pressure. Forces, and the
pressure away from the edge, converge. Wear and soft layers between the faces make it finite.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.kinematics import Kinematics
from ...contact.faces.face import Face, Surface
from ...contact.faces.projection import ray_intersections
from ...contact.faces.rim import beside_edges, edges_of, rim
from ...contact.operators.pressure import Basis, jumps, pressure_basis
from ...contact.search.common_face import carrying_side, ends_within, opposite
from ...contact.search.pairing import Contacts, Pairing, pair, paired
from ...contact.search.refinement import OVERHANG_TOLERANCE, SLIVER
from ...contact.wear.worn_face import directions_between
from ...errors import CaseError
from ...lagrange import lattice
from ...laws.expressions import Region
from ...laws.motions import RigidMotion
from ...model.body import Facing
from ...model.face_wear import CompositeWear
from ...model.interface import Interface
from ...model.model import Model
from .initial_shape import initial_gap
from .worn_geometry import WornContact


def singular_points(bodies: Bodies, contacts: Contacts, softness: np.ndarray) -> np.ndarray:
    """Contact points on facets at such an edge, or next to them, bool (n,). Every rank calls.

    Whether they touch, and whether they are worn, is not asked.

    Parameters
    ----------
    bodies : Bodies
    contacts : Contacts
    softness : ndarray, shape (n,)
        Compliance of the layer between the faces [m/Pa].
    """
    found = [_at_edges(bodies, pairing) for pairing in contacts.each]
    return np.concatenate(found) & (softness == 0.0)


def _at_edges(bodies: Bodies, pairing: Pairing) -> np.ndarray:
    """Points of an interface at sharp edges of either face where the other body goes on, (n,)."""
    carrying = pairing.carrying
    numbers = carrying.face.corner_numbers
    at_edge = []
    for side, other in (pairing.sides, pairing.sides[::-1]):
        face = side.face
        sharp, goes_on = (
            rim(one, bodies.each[one.body], [one.name])[k]
            for k, one in enumerate((face, other.face))
        )
        within = ends_within(face, other.face)
        ends = sharp & ~within  # where the other face may end, too
        if ends.any():
            beyond = opposite(face, *beside_edges(face, ends), other.face).facet
            within[ends] = goes_on[beyond].reshape(np.count_nonzero(ends), -1).any(axis=1)
        sharp &= within
        if face is carrying.face:
            at_edge.append(numbers[:, edges_of(face.kind)][sharp].ravel())
        elif sharp.any():  # cuts facets of the other face
            cut = opposite(face, *beside_edges(face, sharp), other.face).facet
            at_edge.append(numbers[cut].ravel())
    return np.any(np.isin(numbers, np.concatenate(at_edge))[carrying.facet], axis=1)


_SAMPLES = 4
"""Degree of the lattice of places on a facet."""
_AT_BORDER = 1e-6
"""Distance from the border of a region, relative to the facet, that counts as zero."""


def regions_of(interface: Interface) -> list[tuple[int, str, Region, int]]:
    """Face, name, region and group of each part of the faces by an expression of the place."""
    return [
        (side, name, region, wear.each.index(law))
        for side, wear in interface.wear.items()
        if isinstance(wear, CompositeWear)
        for name, (region, law) in wear.regions.items()
    ]


def divided_faces(
    model: Model, interface: Interface, faces: Sequence[Face | Surface]
) -> list[Face | Surface]:
    """Faces of an interface, with the groups of the regions that their facets lie in.

    Raises
    ------
    CaseError
        If the border of a region cuts facets, or regions overlap.
    """
    divided, owner = list(faces), dict[int, np.ndarray]()
    for side, name, region, group in regions_of(interface):
        face = faces[side]
        where = f"{table(model, interface, side)}.{name}.where"
        inside = _inside(face, region, where, model.kinematics == "axisymmetric")
        known = owner.setdefault(side, np.full(len(face.nodes), "", dtype=object))
        twice = inside & (known != "")
        if twice.any():
            raise CaseError(
                f"{where}: overlaps {known[twice][0]} on {face.name}, near {_place(face, twice)}; "
                "each element of the face needs one law"
            )
        known[inside] = name
        groups = np.where(inside, group, divided[side].group_at(np.arange(len(face.nodes))))
        divided[side] = replace(divided[side], group=groups)
    return divided


def require_regions(model: Model, faces: Sequence[Sequence[Face | Surface]]) -> None:
    """Reject regions without an element of any contact face of their body.

    Raises
    ------
    CaseError
    """
    found: dict[str, bool] = {}
    for interface, both in zip(model.interfaces, faces, strict=True):
        for side, name, region, _ in regions_of(interface):
            where = f"{table(model, interface, side)}.{name}.where"
            axisymmetric = model.kinematics == "axisymmetric"
            some = bool(_inside(both[side], region, where, axisymmetric).any())
            found[where] = found.get(where, False) or some
    for where, some in found.items():
        if not some:
            raise CaseError(f"{where}: no element of a contact face of this body lies there")


def table(model: Model, interface: Interface, side: int) -> str:
    """Path of the table of the parts of a face."""
    return f"wear.{model.bodies[interface.bodies[side]].name}.materials"


def _inside(face: Face | Surface, region: Region, where: str, axisymmetric: bool) -> np.ndarray:
    """Facets inside a region, shape (n_facets,)."""
    t, count = lattice(_SAMPLES, face.kind).reshape(-1, face.dim), len(face.nodes)
    facet, t = face.on_each(t if face.dim > 1 else t[:, 0])
    depth = region.depth(face.points(facet, t), axisymmetric).reshape(count, -1)
    wrong = ~np.isfinite(depth).all(axis=1)
    if wrong.any():
        raise CaseError(f"{where}: has no value near {_place(face, wrong)}")
    near = _AT_BORDER * np.ptp(face.nodes, axis=1).max(axis=1)
    cut = (depth.max(axis=1) > near) & (depth.min(axis=1) < -near)
    if cut.any():
        raise CaseError(
            f"{where}: the border of this region cuts an element of {face.name} near "
            f"{_place(face, cut)}; end elements there (mesh.elements, mesh.grading), or move the "
            "border"
        )
    return depth.max(axis=1) > near


def _place(face: Face | Surface, facets: np.ndarray) -> str:
    """Middle of the first of some facets, for messages."""
    middle = face.nodes[facets][0].mean(axis=0)
    return "(" + ", ".join(f"{x:.4g}" for x in middle) + ") m"


_SLIVER = 1e-3
"""Snapping distance to facet ends, relative to the facet: matching facets drift apart by wear."""
_LEAST = 1e-9
"""Softness of a body with an unchanging face, where that of the other body is 1."""
_ALONG = 0.05
"""Largest overhang past the end of the other face by the holder's motion, relative to the face."""


def softness_of_parts(model: Model, interface: Interface) -> dict[str, float]:
    """Softness of each part of the bodies for `contact.search.common_face`; only ratios count.

    The gap between opposite points closes by the elastic deflection of both bodies. In continued
    sliding wear the deflection is soon small compared with the wear depths: the shares are then in
    the ratio of the wear rates.
    """
    wearing = interface.wearing_in_place
    if not wearing:
        return {part: material.compliance for part, material in model.materials.items()}
    largest = max(wearing.values()) or 1.0  # all rates are 0 below a threshold
    softness: dict[str, float] = {}
    for side, index in enumerate(interface.bodies):
        share = max(wearing.get(side, 0.0) / largest, _LEAST)
        softness |= dict.fromkeys(model.bodies[index].parts, share)
    return softness


def groups_of_parts(model: Model, interface: Interface) -> dict[str, int]:
    """Group of equally wearing materials of each part of the bodies; -1 without a wear law.

    Zero for all parts of a body that wears by one law, or not at all.
    """
    groups = {part: 0 for index in interface.bodies for part in model.bodies[index].parts}
    for side, wear in interface.wear.items():
        for part in model.bodies[interface.bodies[side]].parts:
            group = wear.group_of(part)
            groups[part] = -1 if group is None else group
    return groups


def contact_points(
    model: Model,
    interface: Interface,
    comm,
    kinematics: Kinematics,
    face_1,
    face_2,
    *,
    carrier: int | None = None,
) -> tuple[Pairing, Basis]:
    """Contact points, with the gap of the initial shape, and pressure space Ψ.

    They are carried by the given side, or else by that which is chosen for these faces.
    """
    side = carrying_side(face_1, face_2) if carrier is None else carrier
    given = model, interface, kinematics, face_1, face_2
    pairing, basis = _points(*given, comm=comm, carrier=side)
    shape = interface.initial_shape
    if shape is not None:
        key = f"{interface.table if interface.name else 'geometry'}.initial_shape"
        pairing = replace(pairing, gap=initial_gap(comm, shape, pairing, key))
    return pairing, basis


def worn_contact_points(
    model: Model,
    interface: Interface,
    kinematics: Kinematics,
    worn: WornContact,
    motion: RigidMotion,
    face_1: Face | Surface,
    face_2: Face | Surface,
) -> tuple[Pairing, Basis]:
    """Contact points of worn faces after a motion of body 1 over body 2, with the unworn gap.

    The side that carried them on the unworn faces carries them still.

    The gap is measured between points opposite along the directions of the mesh motion: a moved
    mesh opens it by exactly the depth that it loses, even where the faces are inclined to each
    other. They are where a mesh cannot follow the edge of the wear and the faces overlap by the
    depth not removed. Closest-point or normal projection would change the gap there.
    """
    if worn.carrier:
        given = model, interface, kinematics, worn.exchanged, motion.reversed
        pairing, basis = worn_contact_points(*given, face_2, face_1)
        return pairing.exchanged, basis
    face_1, face_2 = _by_walls(worn, (face_1, face_2))
    closer = replace(face_1, nodes=face_1.nodes + motion.at(face_1.nodes))
    if worn.pieces is None:
        max_overhang = _max_overhang(worn, face_1)
        settings = model, interface, kinematics
        pairing, basis = _points(*settings, closer, face_2, _SLIVER, max_overhang)
    else:
        pairing = paired(closer, face_2, kinematics, worn.pieces)
        basis = pressure_basis(pairing, model.pressure_degree(interface))
    first, second = pairing.sides
    on_face = face_1.points(first.facet, first.t)
    to = motion.at(on_face)
    ways = directions_between(pairing.sides, worn.directions, np.abs(worn.depth).max(axis=1))
    facet, t, way = ray_intersections(face_2, on_face + to, ways)
    between, apart = (np.einsum("ni,ni->n", pairing.normals, v) for v in (way[:, None] * ways, to))
    points = on_face + (pairing.share * between)[:, None] * pairing.normals
    sides = replace(first, face=face_1), replace(second, facet=facet, t=t)
    worn_pairing = replace(pairing, points=points, sides=sides)
    unworn = worn.carried(worn.missing_shape, pairing) - worn.moved(worn_pairing).sum(axis=0)
    return replace(worn_pairing, gap=between + apart + unworn), basis


def _by_walls(worn: WornContact, faces: tuple) -> tuple:
    """Assign the common face to the other body if the mesh of only one has groove walls.

    Walls are the unworn remainder of a mesh beside its wear and not in contact.
    """
    walled = np.array([held.any() for held in worn.held]) & np.any(worn.depth != 0.0, axis=1)
    if walled[0] == walled[1]:
        return faces
    pairs = zip(faces, walled, strict=True)
    return tuple(replace(face, softness=1.0 if wall else _LEAST) for face, wall in pairs)


def _max_overhang(worn: WornContact, face_1: Face | Surface) -> float:
    """Largest overhang of a face past the end of the other one, relative to its size.

    Rounding only if the unworn face overhangs already. Otherwise the holder's motion has moved it
    over a body that continues there.
    """
    opposite = worn.at[0] == 0.0 and worn.at[-1] == len(face_1.nodes)
    return _ALONG if opposite else OVERHANG_TOLERANCE


def _points(
    model: Model,
    interface: Interface,
    kinematics: Kinematics,
    face_1,
    face_2,
    sliver: float = SLIVER,
    max_overhang: float = OVERHANG_TOLERANCE,
    comm=None,
    carrier: int = 0,
) -> tuple[Pairing, Basis]:
    """Contact points of two faces, and pressure space Ψ; parameters as in `pair`."""
    degree = model.discretisation.degree
    if interface.pressure_degree == "lobatto":  # at the nodes of the facets
        if isinstance(face_1, Surface):
            raise CaseError(f"{interface.table}.pressure_degree: 'lobatto' is for sections")
        pairing = pair(face_1, face_2, kinematics, degree + 1, refine=False, carrier=carrier)
        _check_jumps(model, interface, pairing)
        return pairing, np.eye(len(pairing.weights))
    pairing = pair(
        face_1,
        face_2,
        kinematics,
        degree + 2,
        sliver=sliver,
        max_overhang=max_overhang,
        comm=comm,
        carrier=carrier,
    )
    _check_jumps(model, interface, pairing)
    return pairing, pressure_basis(pairing, model.pressure_degree(interface))


def _check_jumps(model: Model, interface: Interface, pairing: Pairing) -> None:
    """Reject settings that do not determine a pressure with jumps between materials."""
    degree, method = model.discretisation.degree, interface.method.name
    if not jumps(pairing):
        return
    where = "where the materials of a contact face wear by different laws the pressure jumps"
    if method != "condensed":
        raise CaseError(f'contact.method: {method!r} is not supported; {where}; use "condensed"')
    if degree < 2:
        raise CaseError(f"mesh.degree: found {degree}; {where}, which needs 2 or more")
    if model.pressure_degree(interface) >= degree:
        raise CaseError(
            f"contact.pressure_degree: {where}, which needs a degree below mesh.degree ({degree})"
        )


def require_laws(
    model: Model, interface: Interface, bodies: Bodies, faces: Sequence[Face | Surface]
) -> None:
    """Reject parts of a wearing face without a wear law. Every rank calls.

    Raises
    ------
    CaseError
    """
    for index, face in zip(interface.bodies, faces, strict=True):
        body = model.bodies[index]
        parts = _parts_of_facets(bodies, face)
        without = parts[face.group_at(np.arange(len(parts))) < 0]
        if len(without):
            part = bodies.names[without[0]]
            own = f"materials.{part.removeprefix(f'{body.name}.')}"
            raise CaseError(
                f"wear.{body.name}.{'coefficient' if part == body.name else own}: missing; the "
                f"contact face {face.name} has cells of this part"
            )


def facing_parts(bodies: Bodies, pairing: Pairing) -> Facing:
    """Parts of both bodies in contact at the contact points. Every rank calls."""
    first, second = (_parts_of_facets(bodies, side.face)[side.facet] for side in pairing.sides)
    return Facing(bodies.names, (first, second))


def _parts_of_facets(bodies: Bodies, face: Face | Surface) -> np.ndarray:
    """Index in ``bodies.names`` of the part that each facet belongs to, shape (n_facets,)."""
    mine = face.rank == bodies.comm.rank
    parts = np.zeros(len(face.rank), dtype=np.int64)
    parts[mine] = bodies.each[face.body].parts_of_cells(face.cell[mine])
    return bodies.comm.allreduce(parts)
