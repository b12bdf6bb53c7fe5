"""Outer loop of a transient analysis: meshes are moved to the worn faces when wear is large.

Contact, heat and wear are integrated in time on fixed meshes, with the wear since the last update
kept in the gap. When it exceeds a fraction of the dimensions of the bodies, the meshes are moved
and time integration continues. The fraction follows from the change by the last update.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ...contact.search.pairing import Pairing
from ...contact.wear.worn_face import curvatures, directions_between, nodes_of
from ...errors import ComputationError
from ...geometry.checks.mesh_checks import length
from ...geometry.mesh.mixed import AnyMesh, block_of
from ...geometry.mesh.nodes import boundary, shape_functions
from ...geometry.moving.moved import cells_of, nodes_at
from ...model.analyses import TransientAnalysis
from ...model.model import Zone
from ...parallel import on_root
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.sdirk import InterfaceState
from ..interface.steady import SteadyState
from ..results.recording import GRIDS
from ..runtime.observer import Observer
from ..system.building import build
from ..system.setup_cache import SetupCache
from ..system.system import System
from ..time_loop import Moment, StepSizes, is_over, is_steady, moments
from .geometry_update import settled, updated
from .moving_faces import (
    KEPT,
    STEPPED,
    FaceKey,
    MovingFaces,
    node_paths,
    parts_behind,
    smoothed_wear,
    steps_grow,
)
from .wider_zone import UpdateCounts, meshed_wider, wider_zone

_CHANGE = 5e-3
"""Target change of pressure and temperatures by an automatic update, or the larger tolerance."""
_OVER = 0.1
"""Overshoot of the allowed fraction that a step may cause, relative to it; half is aimed at."""
_ROOM = 5.0
"""Upper limit of the allowed fraction, as a multiple of the automatic one."""
_ALMOST = 0.05
"""Part of a body's thickness below which one whose mesh cannot follow the wear is worn through."""
_TILT = 0.1
"""Weight of the element tilt: depth difference of its ends relative to its size."""


class GapWear:
    """Wear kept in the gap of a system, relative to the dimensions of the bodies.

    Thickness behind a face, and radii of curvature; a tenth of the tilt of elements counts, too.

    Attributes
    ----------
    faces : MovingFaces
        Faces that may follow the wear.
    """

    def __init__(self, system: System):
        self._system = system
        self.faces = MovingFaces(system)
        thick = thicknesses(system, self.faces.rows)
        each = zip(thick, system.contacts, strict=True)
        self._each = [(_FaceSize(pairing, behind), own) for behind, (pairing, own) in each]

    def depth(self, state: InterfaceState) -> np.ndarray:
        """Depths kept in the gap in a state, shape (2, n) [m]."""
        return state.by_body(self._system.laws) - self._system.moved

    def fraction(self, depth: np.ndarray) -> float:
        """Largest ratio of depths (2, n) of the faces to the dimensions of their bodies."""
        return max(size.fraction(depth[:, points]) for size, points in self._each)


class _FaceSize:
    """Dimensions of the bodies at an interface that limit the wear kept in its gap."""

    def __init__(self, pairing: Pairing, thickness: dict[int, float]):
        side = pairing.carrying
        facets, self._first = np.unique(side.facet, return_index=True)
        self._lengths = side.face.lengths[facets]
        self._curvature = max(float(curvatures(s.face).max()) for s in pairing.sides)
        self._thickness = thickness

    def fraction(self, depth: np.ndarray) -> float:
        ratios = [0.0]
        for index, thickness in self._thickness.items():
            largest = float(np.abs(depth[index]).max())
            low, high = (f.reduceat(depth[index], self._first) for f in (np.minimum, np.maximum))
            tilt = float(((high - low) / self._lengths).max())
            ratios += [largest / thickness, largest * self._curvature, _TILT * tilt]
        return max(ratios)


@dataclass(frozen=True)
class MeshPeriod:
    """Part of a transient analysis on the same meshes.

    Attributes
    ----------
    problem : InterfaceProblem
    steady : SteadyState or None
    gap_wear : GapWear or None
        Wear kept in the gap; None if meshes must not be moved.
    walls : Walls
        Thickness of the bodies behind the worn faces.
    """

    problem: InterfaceProblem
    steady: SteadyState | None
    gap_wear: GapWear | None
    walls: Walls

    @property
    def system(self) -> System:
        return self.problem.system

    def fraction(self, moment: Moment | None) -> float:
        """Wear kept in the gap at a moment, relative to the dimensions of the bodies."""
        kept = self.gap_wear
        return 0.0 if kept is None or moment is None else kept.fraction(kept.depth(moment.state))

    def thinnest(self, moment: Moment | None) -> Thinnest:
        """Place where wear has left the smallest part of a body at a moment; every rank calls."""
        if moment is None:
            return Thinnest()
        return self.walls.thinnest(moment.state.by_body(self.system.laws))


class OuterLoop:
    """Time loop of a transient analysis with geometry updates between its moments.

    Parameters
    ----------
    problem : InterfaceProblem
        Problem of the unworn bodies.
    settings : TransientAnalysis
    principle : callable
        Function of a system for its steady state; None if there is none.
    sizes : StepSizes
    observer : Observer

    Attributes
    ----------
    now : MeshPeriod
        Problem, system and steady state at the last moment.
    largest_kept : float
        Largest wear kept in the gap so far, relative to the dimensions of the bodies.
    allowed : float
        Largest wear that may be kept now, relative to the dimensions of the bodies.
    earlier : UpdateCounts
        Counts of the updates of meshes for narrower zones.
    """

    def __init__(
        self,
        problem: InterfaceProblem,
        settings: TransientAnalysis,
        principle: Callable[[System], SteadyState | None],
        sizes: StepSizes,
        observer: Observer,
    ):
        self.largest_kept = 0.0
        self.allowed = settings.largest_kept
        self.earlier = UpdateCounts()
        self._settings, self._sizes = settings, sizes
        self._principle, self._observer = principle, observer
        self._narrow = ""
        self._follows = bool(np.isfinite(self.allowed))
        if self._follows and steps_grow(problem.system):
            self._keep_all(STEPPED)
        self.now = self._period(problem)

    def _keep_all(self, why: str) -> None:
        """Keep all wear in the gap from now on."""
        self._follows, self._sizes.largest = False, np.inf
        self._observer.note(why)

    def _period(self, problem: InterfaceProblem) -> MeshPeriod:
        kept = GapWear(problem.system) if self._follows else None
        walls = Walls(problem.system, MovingFaces(problem.system) if kept is None else kept.faces)
        return MeshPeriod(problem, self._principle(problem.system), kept, walls)

    def restart_data(self) -> tuple:
        """Worn geometry, zone of the mesh [m], counts for earlier zones, limits of kept wear."""
        limits = self.largest_kept, self.allowed, self._sizes.largest
        system = self.now.system
        return system.worn, system.zone, self.earlier, limits

    def restore(self, data: tuple) -> None:
        """Restore an earlier loop after its last update or wider zone, if any."""
        worn, zone, self.earlier, limits = data
        self.largest_kept, self.allowed, self._sizes.largest = limits
        unworn = self.now.system
        zone = unworn.zone if zone is None else zone
        if worn is None and zone == unworn.zone:
            return
        system = build(unworn.model, unworn.comm, unworn.phases, zone, SetupCache(), worn)
        self.now = self._period(interface_problem(system, self._observer.note))

    def moments(self, last: Moment | None = None) -> Iterator[Moment]:
        """Accepted moments, see `time_loop.moments`; the last one where a body is worn through."""
        now, settings, fraction = self.now, self._settings, self.now.fraction(last)
        thin = now.thinnest(last)
        while not thin.is_through:
            if last is not None and (zone := self._wider(now, last)) is not None:
                now, last = self._widen(now, last, zone)
                fraction = now.fraction(last)
            if last is not None and self._is_due(now, fraction, last):
                try:
                    now, last = self._update(now, last)
                except ComputationError:
                    if thin.left > _ALMOST:
                        raise
                    break
                fraction, thin = 0.0, now.thinnest(last)
            for moment in self._naming_zone_limit(
                moments(now.problem, settings, now.steady, self._sizes, last)
            ):
                before, thin = thin, now.thinnest(moment)
                if thin.left < 0.0:  # the wear of the step is deeper than the body
                    self._sizes.largest, thin = thin.step_to_end(before, moment.step), before
                    break
                former, fraction = fraction, now.fraction(moment)
                self._look_ahead(fraction, fraction - former, moment.step)
                ahead = thin.step_to_end(before, moment.step)
                self._sizes.largest = min(self._sizes.largest, ahead)
                if now.gap_wear is not None and now.system.worn and is_over(settings, moment):
                    assert last is not None
                    now, moment = self._end(now, last, moment)
                self.now = now
                yield moment
                last = moment
                if thin.is_through or self._wider(now, last) or self._is_due(now, fraction, last):
                    break
            else:
                return
        assert last is not None
        self._observer.note(thin.text(last.time))

    def summary(self) -> dict[str, float | int]:
        """Summary entries of the geometry updates; empty without updates."""
        system = self.now.system
        return self.earlier.counting(system.worn).summary(self.largest_kept, system)

    def _naming_zone_limit(self, passing: Iterator[Moment]) -> Iterator[Moment]:
        """Pass the moments on; add to an error that the contact has outgrown the meshed zone."""
        try:
            yield from passing
        except ComputationError as reason:
            if not self._narrow:
                raise
            raise ComputationError(
                f"{reason}; the contact has grown beyond the zone that is meshed for it, which "
                f"cannot be wider: {self._narrow}"
            ) from None

    def _wider(self, now: MeshPeriod, moment: Moment) -> Zone | None:
        """Zone to mesh for, if a wearing contact has outgrown its own before the end of the run."""
        worn = moment.state.worn.any()
        if self._narrow or now.system.zone is None or not worn or is_over(self._settings, moment):
            return None
        return wider_zone(now.system, moment.state.pressure)

    def _widen(self, now: MeshPeriod, last: Moment, zone: Zone) -> tuple[MeshPeriod, Moment]:
        """Period and moment on a mesh for a wider zone; unchanged if it cannot be made."""
        found = meshed_wider(now.problem, last.state, last.time, zone)
        if isinstance(found, str):
            self._narrow = found
            return now, last
        self._observer.note(
            f"at {last.time:.4g} s the contact has grown beyond the zone that was meshed for it; "
            f"from there on the mesh is made for x = {zone[0]:.4g} to {zone[1]:.4g} m "
            "(a larger geometry.zone avoids that)"
        )
        self.earlier = self.earlier.counting(now.system.worn)
        problem, state = found
        return self._period(problem), replace(last, state=state)

    def _is_due(self, now: MeshPeriod, fraction: float, moment: Moment) -> bool:
        """True if the kept wear that the nodes can follow exceeds the allowed fraction.

        Always False at the end of the run.
        """
        kept = now.gap_wear
        if kept is None or fraction <= self.allowed or is_over(self._settings, moment):
            return False
        return kept.fraction(kept.faces.movable(kept.depth(moment.state))) > self.allowed

    def _look_ahead(self, fraction: float, grown: float, step: float) -> None:
        """Limit the next step so that the kept wear hardly exceeds the allowed fraction."""
        self.largest_kept = max(self.largest_kept, fraction)
        self._sizes.largest = np.inf
        if grown > 0.0:
            begun = fraction if fraction <= self.allowed else 0.0  # an update is due
            self._sizes.largest = step * ((1 + _OVER / 2) * self.allowed - begun) / grown

    def _end(self, now: MeshPeriod, before: Moment, last: Moment) -> tuple[MeshPeriod, Moment]:
        """Period and moment after a final update, so that the run ends with worn meshes.

        One that takes the pressure away from the steady state is left out: wear stays in the gap.
        """
        (moved, after), settings = self._update(now, last), self._settings
        states, tolerance = (before.state, last.state, after.state), settings.tolerance
        state = settled(now.problem, moved.problem, *states, before.time, after.step, tolerance)
        distance = moved.problem.distance(state, moved.steady)
        if is_steady(settings, last.distance) and not is_steady(settings, distance):
            return now, last
        return moved, replace(after, state=state, distance=distance)

    def _update(self, now: MeshPeriod, last: Moment) -> tuple[MeshPeriod, Moment]:
        """Period and moment after moving the meshes; adapts the allowed fraction."""
        kept = now.gap_wear
        assert kept is not None
        if kept.faces.obstacle is not None:
            self._keep_all(KEPT.format(last.time, kept.faces.obstacle))
            return self._period(now.problem), last
        worn = smoothed_wear(now.problem, last.state, last.time)
        state = replace(last.state, worn=worn)
        depth = kept.depth(state)
        problem, state, change = updated(now.problem, kept.faces, depth, state, last.time)
        automatic = self._settings.largest_kept
        if self._settings.adapts and change > 0.0:
            target = max(_CHANGE, self._settings.tolerance)
            before, wished = self.allowed, self.allowed * float(np.clip(target / change, 0.2, 2.0))
            self.allowed = float(np.clip(wished, 0.01 * automatic, _ROOM * automatic))
            self._sizes.largest *= self.allowed / before
        return self._period(problem), replace(last, state=state)


_THIN = 0.1
"""Part of the unworn thickness below which the remaining one does not count less."""
_DEEP = 0.02
"""Depth, relative to the thickness behind the middle of a face, from which rays are cast."""
_NOTHING, _EQUAL = 2e-3, 1e-6
"""Part of the thickness whose loss counts as that of all; parts that differ by rounding, of which
the first place is named, however many processes compute them."""
_RAYS, _AT_ONCE = 500, 16
"""Largest number of rays from a face; number of those compared with all facets together."""
_GRAZING = 0.05
"""Least cosine between a ray and the normal of a facet through which it leaves the body."""
_FINE = 4
"""Number of straight parts of a curved edge."""


def thicknesses(system: System, keys: Iterable[FaceKey]) -> list[dict[int, float]]:
    """Thickness behind the worn faces of each interface, by side [m]; every rank calls.

    Faces of one body share it equally, as a disk becomes thinner by the wear of both of its faces.
    What is left of a thin wall counts as a tenth of the unworn one, as it is soon worn through.
    """
    bodies = {key: system.contacts.bodies[key[0]][key[1]] for key in keys}
    of_body, found = list(bodies.values()), [dict[int, float]() for _ in system.contacts.each]
    for (index, side), body in bodies.items():
        left = _thickness_behind(system, (index, side)) / of_body.count(body)
        worn = float(system.moved[side, system.contacts.ranges[index]].max(initial=0.0))
        found[index][side] = max(left, _THIN * (left + worn))
    return found


def _thickness_behind(system: System, key: FaceKey) -> float:
    """Thickness of a body behind the middle of a contact face [m]; every rank calls."""
    bodies, (index, side) = system.bodies, key
    pairing = system.contacts.each[index]
    out = (pairing.weights @ pairing.normals) * (1 if side == 0 else -1)
    out = out / np.linalg.norm(out)
    middle = np.average(pairing.points, axis=0, weights=pairing.weights)
    mesh = bodies.each[pairing.sides[side].face.body].mesh
    nodes = mesh.geometry.x[:, : len(middle)]
    return max(system.comm.allgather(float(((middle - nodes) @ out).max(initial=0.0))))


@dataclass(frozen=True)
class Thinnest:
    """Place where wear has left the smallest part of a body.

    Attributes
    ----------
    left : float
        Thickness left, relative to the unworn one; infinite while wear is not deep.
    body : str
        Name of the body.
    thickness : float
        Unworn thickness there [m].
    place : tuple of float
        Coordinates on the worn face [m].
    """

    left: float = np.inf
    body: str = ""
    thickness: float = 0.0
    place: tuple[float, ...] = ()

    @property
    def is_through(self) -> bool:
        """Whether the body is worn through here."""
        return self.left <= _NOTHING

    def step_to_end(self, before: Thinnest, step: float) -> float:
        """Size of a step from here, or from before it if this one went too far, to the end [s].

        By the mean rate in a step of a given size.
        """
        lost = min(before.left, 1.0) - self.left
        begin = min(before.left, 1.0) if self.left < 0.0 else self.left
        return step * (begin - _NOTHING / 2) / lost if lost > 0.0 and begin < np.inf else np.inf

    def text(self, time: float) -> str:
        """Note that the body is worn through at a time [s]."""
        at = ", ".join(
            f"{name} = {value:.4g}" for name, value in zip("xyz", self.place, strict=False)
        )
        return (
            f"wear: {self.body} is worn through at t = {time:.6g} s, at {at} m: of its thickness "
            f"of {length(self.thickness)} there, {max(self.left, 0.0):.1%} is left; the run ends"
        )


class Walls:
    """Thickness of the bodies behind their faces worn in place, in the meshes of a system.

    Measured from each contact point along the path on which the nodes of its face move.

    Parameters
    ----------
    system : System
    faces : MovingFaces
    """

    def __init__(self, system: System, faces: MovingFaces):
        self._system, self._rows = system, faces.rows
        middle = thicknesses(system, self._rows)
        self._deep = {key: _DEEP * middle[key[0]][key[1]] for key in self._rows}
        self._behind: dict[FaceKey, tuple[np.ndarray, np.ndarray]] | None = None

    def thinnest(self, depth: np.ndarray) -> Thinnest:
        """Smallest part left behind depths (2, n) of the faces [m]. Every rank calls."""
        if not any((depth[own] > self._deep[key]).any() for key, own in self._rows.items()):
            return Thinnest()
        if self._behind is None:
            self._behind = on_root(self._system.comm, self._measured)
        kept = depth - self._system.moved
        each = [self._of_face(key, depth[own], kept) for key, own in self._rows.items()]
        return min(each, key=lambda one: one.left)

    def _of_face(self, key: FaceKey, depth: np.ndarray, kept: np.ndarray) -> Thinnest:
        assert self._behind is not None
        system, (index, side) = self._system, key
        behind, far = self._behind[key]
        left = behind - kept[self._rows[key]]
        for other, own in self._rows.items():  # a disk is worn from both of its sides
            if other != key and parts_behind(system, other) == parts_behind(system, key):
                there = system.contacts.each[other[0]].points
                tree = cKDTree(there)
                apart, nearest = tree.query(far)
                spacing = tree.query(there, k=2)[0][:, 1].max()
                left = left - np.where(apart <= spacing, kept[own][nearest], 0.0)
        whole = behind - kept[self._rows[key]] + depth
        part = np.where(np.isfinite(whole), left / np.where(np.isfinite(whole), whole, 1.0), np.inf)
        k = int(np.argmax(part <= part.min() + _EQUAL))
        place = tuple(float(x) for x in system.contacts.each[index].points[k])
        body = system.model.bodies[system.contacts.bodies[index][side]].name
        return Thinnest(float(part[k]), body, float(whole[k]), place)

    def _measured(self) -> dict[FaceKey, tuple[np.ndarray, np.ndarray]]:
        """Thickness (n_own,) behind each face, and places (n_own, gdim) at its far side [m]."""
        system = self._system
        worn, found = system.worn, {}
        if worn is None:
            mesh, paths = node_paths(system)
            directions = [tuple(path.directions for path in pair) for pair in paths]
        else:
            mesh, directions = worn.mesh, [contact.directions for contact in worn.contacts]
        for key in self._rows:
            index, side = key
            pairing = system.contacts.each[index]
            recession = np.array([side == 0, side == 1], dtype=float)
            out = directions_between(pairing.sides, directions[index], recession)
            inward = -out if side == 0 else out
            paired = pairing.sides[side]
            starts = paired.face.points(paired.facet, paired.t)
            some = np.unique(np.linspace(0, len(starts) - 1, _RAYS).round().astype(int))
            nearest = some[cKDTree(starts[some]).query(starts)[1]]
            lengths = np.full(len(starts), np.inf)
            lengths[some] = _lengths(_behind(system, mesh, key), starts[some], inward[some])
            lengths = lengths[nearest]
            far = starts + np.where(np.isfinite(lengths), lengths, 0.0)[:, None] * inward
            along = np.abs(np.einsum("ni,ni->n", inward, pairing.normals))
            found[key] = lengths * along, far
        return found


def thickness_at(system: System, key: FaceKey, point: int) -> float:
    """Thickness of a body along the normal at a point of one of its faces [m]. Every rank calls."""
    side = system.contacts.each[key[0]].sides[key[1]]
    facet, t = side.facet[point : point + 1], side.t[point : point + 1]
    start, inward = side.face.points(facet, t), -side.face.normals(facet, t)

    def cast() -> float:
        worn = system.worn
        mesh = system.model.meshes.mesh(system.zone) if worn is None else worn.mesh
        return float(_lengths(_behind(system, mesh, key), start, inward)[0])

    return on_root(system.comm, cast)


def _behind(system: System, mesh: AnyMesh, key: FaceKey) -> np.ndarray:
    """Straight pieces of the boundary of a body without one of its faces, (n, gdim, gdim) [m]."""
    parts = parts_behind(system, key)
    block, face = block_of(mesh, *parts), system.contacts.each[key[0]].sides[key[1]].face
    own = nodes_at(block, parts, nodes_of(face))
    facets = boundary(block.cell_type, block.order, cells_of(block, parts))
    facets = block.points[facets[~np.isin(facets, own).all(axis=1)]]
    kind, fine = block.facet_type, 1 if block.order == 1 else _FINE
    if facets.shape[2] == 2:
        at = np.linspace(0.0, 1.0, fine + 1)[:, None]
        pieces = np.column_stack([np.arange(fine), np.arange(fine) + 1])
    else:
        at, pieces = GRIDS[kind](fine)
        if kind == "quadrilateral":
            pieces = np.vstack([pieces[:, [0, 1, 2]], pieces[:, [0, 2, 3]]])
    points = np.einsum("qk,fki->fqi", shape_functions(kind, block.order, at), facets)
    return points[:, pieces].reshape(-1, *pieces.shape[1:], facets.shape[2])


def _lengths(pieces: np.ndarray, starts: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """Lengths of rays inside a body, up to straight pieces of its boundary, shape (n,) [m]."""
    corner, edges = pieces[:, 0], pieces[:, 1:] - pieces[:, :1]
    in_space = edges.shape[1] == 2
    normals = np.cross(edges[:, 0], edges[:, 1]) if in_space else edges[:, 0, ::-1] * [1, -1]
    sizes = np.linalg.norm(normals, axis=1)
    solid = sizes > 0.0
    corner, edges, normals = corner[solid], edges[solid], normals[solid] / sizes[solid, None]
    inverse = np.linalg.solve(edges @ edges.mT, edges)
    found = []
    for few in np.array_split(np.arange(len(starts)), -(-len(starts) // _AT_ONCE)):
        start, way = starts[few, None], ways[few]
        across = way @ normals.T
        across = np.where(np.abs(across) > _GRAZING, across, np.nan)
        way_to = np.einsum("rfi,fi->rf", corner - start, normals) / across
        hit = start + way_to[..., None] * way[:, None] - corner
        at = np.einsum("rfi,fki->rfk", hit, inverse)
        inside = (at >= -1e-9).all(axis=2) & (at.sum(axis=2) <= 1 + 1e-9) & (way_to > 0.0)
        found.append(np.where(inside, way_to, np.inf).min(axis=1))
    return np.concatenate(found)
