"""Notes on states beyond linear elasticity: large strains and approaches, yielding, rigid clamps.

Stresses are singular at sharp edges and at the ends of clamped surfaces. A stress counts that is
exceeded in a volume of a hundredth of the cube of the size of the smallest contact, in a section in
a hundredth of its square: whatever the mesh, singular points then count if they strain so much.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...bulk.bodies import BodyMesh
from ...geometry.checks.mesh_checks import length
from ..geometry_update.outer_loop import thickness_at
from ..results.recording import Samples, Snapshot
from ..system.system import System

_STRAIN = 0.02
"""Largest strain that counts as small."""
_APPROACH = 0.1
"""Largest approach relative to the thickness of a body."""
_SHALLOW = 5e-3
"""Approach relative to the size of the contact faces, below which bodies are thick enough."""
_EXCEEDED = 0.01
"""Volume in which a stress is exceeded, relative to the size of the contact to its dimension."""
_CLAMPED = 2e-3
"""Stress at a clamped surface relative to Young's modulus from which a hot body has a note."""
_SIZES = {"quadrilateral": 1.0, "triangle": 1 / 2, "hexahedron": 1.0, "tetrahedron": 1 / 6}
"""Sizes of the reference cells."""


def beyond_elasticity(end: Snapshot, samples: Sequence[Samples]) -> list[str]:
    """Notes on a state that linear elasticity does not describe well. Every rank calls."""
    return [*_approaches(end), *_stresses(end, samples)]


def _approaches(end: Snapshot) -> list[str]:
    """Notes on contacts whose faces approach each other by much of the thickness of a body."""
    system, pressure, found = end.system, end.contact.pressure, []
    opening = end.bodies.opening + system.softness * pressure
    for index, (pairing, own) in enumerate(system.contacts):
        pressing = pressure[own] > 0.0
        deep = float(opening[own][pressing].max(initial=0.0))
        if deep <= _SHALLOW * pairing.extent:
            continue
        point, bodies = int(np.argmax(pressure[own])), system.contacts.bodies[index]
        behind = [thickness_at(system, (index, side), point) for side in (0, 1)]
        soft = [
            min(thick, pairing.extent) * system.model.bodies[body].compliance
            for body, thick in zip(bodies, behind, strict=True)
        ]
        for body, thick, share in zip(bodies, behind, np.array(soft) / sum(soft), strict=True):
            if share * deep > _APPROACH * thick:
                found.append(
                    f"the faces approach each other by {length(deep)} with the load, "
                    f"{share * deep / thick:.0%} of the thickness of "
                    f"{system.model.bodies[body].name} there ({length(thick)}) by its deformation: "
                    "strains are taken to be small"
                )
    return found


def _stresses(end: Snapshot, samples: Sequence[Samples]) -> list[str]:
    """Notes on large strains, on yielding, and on the clamped surfaces of hot bodies."""
    system = end.system
    small = _small(end)
    table = system.comm.gather(_highest(_points(end.system, samples), small), root=0)
    notes: list[str] = []
    if table is not None:
        columns = zip(*table, strict=True)
        notes = _judged(end, small, *(np.concatenate(column) for column in columns))
    return system.comm.bcast(notes)


def _judged(
    end: Snapshot,
    small: float,
    stress: np.ndarray,
    size: np.ndarray,
    place: np.ndarray,
    part: np.ndarray,
    clamp: np.ndarray,
) -> list[str]:
    """Notes from the columns of `_points`."""
    model, notes = end.system.model, []
    surfaces = [name for body in model.bodies for name in body.fixed]
    parts = {name: one for body in model.bodies for name, one in body.materials.items()}
    for number, name in enumerate(end.system.bodies.names):
        own = np.flatnonzero(part == number)
        order = own[np.argsort(-stress[own], kind="stable")]
        if not len(order):
            continue
        count = int(np.searchsorted(np.cumsum(size[order]), small)) + 1
        highest = order[:count]
        most = float(stress[highest[-1]])
        material, at = parts[name], _at(place[highest[0]])
        strain = 2 * (1 + material.poisson_ratio) / 3 * most / material.young_modulus
        if strain > _STRAIN:
            notes.append(
                f"{name} is strained by {strain:.1%} (von Mises {most / 1e6:.4g} MPa) at {at}: "
                "strains are taken to be small"
            )
        if material.yield_strength is not None and most > material.yield_strength:
            notes.append(
                f"{material.label}.yield_strength: the von Mises stress reaches "
                f"{most / 1e6:.4g} MPa in {name} at {at}, {most / material.yield_strength:.3g} "
                "times the yield strength; bodies are elastic, a real one would yield there"
            )
        touching = clamp[highest]
        held = end.bodies.temperatures is not None and 2 * np.sum(touching >= 0) > len(touching)
        if held and material.expansion and most > _CLAMPED * material.young_modulus:
            surface = surfaces[np.bincount(touching[touching >= 0]).argmax()]
            notes.append(
                f"the largest von Mises stress of {name}, {most / 1e6:.4g} MPa, is at {surface}, "
                "which is clamped and cannot expand with the hot body; rollers let it grow"
            )
    return notes


def _at(place: np.ndarray) -> str:
    """Coordinates [m] as text."""
    return ", ".join(f"{axis} = {x:.4g} m" for axis, x in zip("xyz", place, strict=False))


def _small(end: Snapshot) -> float:
    """Size of the part of a body, in a section its area, in which a stress must be exceeded.

    Every rank calls. Thin bodies have smaller ones.
    """
    system, sizes = end.system, []
    for pairing, own in system.contacts:
        pressing = end.contact.pressure[own] > 0.0
        if system.contacts.in_space:
            sizes.append(float(np.sqrt(pairing.weights[pressing].sum())))
        else:
            factor = system.elastic.kinematics.area_factor(pairing.points)
            pressing &= factor > 0.0  # on the axis points have no area
            sizes.append(float((pairing.weights[pressing] / factor[pressing]).sum()))
    for body in system.bodies.each:
        x = body.mesh.geometry.x[:, : system.bodies.dim]
        each = system.comm.allgather((x.min(axis=0), x.max(axis=0)) if len(x) else None)
        low, high = zip(*(one for one in each if one is not None), strict=True)
        sizes.append(float((np.max(high, axis=0) - np.min(low, axis=0)).min()))
    return _EXCEEDED * min(one for one in sizes if one > 0.0) ** system.bodies.dim


def _points(system: System, samples: Sequence[Samples]) -> tuple[np.ndarray, ...]:
    """Stress, share of the size, place, part and clamped surface (-1: none) at points of cells."""
    columns = []
    surfaces = [name for body in system.model.bodies for name in body.fixed]
    for body, one in zip(system.bodies.each, samples, strict=True):
        count = one.points.shape[1]
        of_cells = body.parts_of_cells(np.arange(body.n_cells)), _clamps(system, body, surfaces)
        columns.append(
            (
                one.fields[1].ravel(),
                _SIZES[body.cell_type] / count * one.stretch.ravel(),
                one.points.reshape(-1, system.bodies.dim),
                *(np.repeat(values, count) for values in of_cells),
            )
        )
    return tuple(np.concatenate(column) for column in zip(*columns, strict=True))


def _highest(points: tuple[np.ndarray, ...], small: float) -> tuple[np.ndarray, ...]:
    """Points of the highest stresses of each part, which take up a size at least."""
    stress, size, _, part, _ = points
    kept: list[np.ndarray] = [np.empty(0, dtype=int)]
    for number in np.unique(part):
        own = np.flatnonzero(part == number)
        order = own[np.argsort(-stress[own], kind="stable")]
        kept.append(order[: int(np.searchsorted(np.cumsum(size[order]), small)) + 1])
    chosen = np.concatenate(kept)
    return tuple(column[chosen] for column in points)


def _clamps(system: System, body: BodyMesh, surfaces: list[str]) -> np.ndarray:
    """Number of the clamped surface at which each cell lies, -1 without; shape (n_cells,)."""
    topology = body.mesh.topology
    topology.create_connectivity(topology.dim - 1, topology.dim)
    cells_of = topology.connectivity(topology.dim - 1, topology.dim)
    found = np.full(body.n_cells, -1)
    for number, name in enumerate(surfaces):
        for facet in body.facets(name):
            cells = cells_of.links(facet)
            found[cells[cells < body.n_cells]] = number
    return found
