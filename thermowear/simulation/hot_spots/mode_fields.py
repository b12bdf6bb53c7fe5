"""Fields of a mode in the bodies, sampled on the cells of the section."""

from __future__ import annotations

import numpy as np
from dolfinx import fem
from dolfinx.mesh import entities_to_geometry

from ...bulk.spaces import as_function
from ...laws.waves import WaveMode
from ...results import HotSpotFields, HotSpotMode
from ..results.recording import GRIDS, divisions, gathered, sampled
from .wave_model import WaveModel, WaveSystem

SIGNS = {"whole": 0, "symmetric": 1, "antisymmetric": -1}
"""Symmetries as numbers in tables."""


def mode_fields(model: WaveModel, waves: WaveSystem, mode: WaveMode) -> HotSpotMode | None:
    """Temperature and displacement of a mode, on rank 0; None on others. Every rank calls."""
    temperature, displacement = _nodal(model, waves, mode)
    system, thermal = model.system, model.system.thermal
    assert thermal is not None
    heat, elastic = thermal.conduction.spaces, waves.elasticity.elastic.spaces
    n = divisions(system.bodies, max(system.model.discretisation.degree, 2))
    parts = [
        [spaces.split(part) for part in (field.real, field.imag)]
        for spaces, field in ((heat, temperature), (elastic, displacement))
    ]
    samples = []
    for k, body in enumerate(system.bodies.each):
        fields: list[fem.Function] = [
            as_function(space, part[k], "mode")
            for space, field in zip((heat.each[k], elastic.each[k]), parts, strict=True)
            for part in field
        ]
        samples.append(sampled(body.mesh, *GRIDS[body.cell_type](n), fields))
    found, mirror = gathered(system, samples), _mirror_plane(model)
    if found is None:
        return None
    blocks = tuple(
        HotSpotFields(
            points[..., :2],
            pieces,
            body,
            (T_real + 1j * T_imag)[..., 0],
            _along_wave(u_real + 1j * u_imag),
        )
        for pieces, body, points, T_real, T_imag, u_real, u_imag in found
    )
    return HotSpotMode(
        waves.wave.number,
        model.radius is not None,
        SIGNS[waves.symmetry],
        mirror,
        mode.factor,
        model.reference + 1,
        blocks,
    )


def _along_wave(displacement: np.ndarray) -> np.ndarray:
    """Displacement ``(u1, u2, i w)`` from (u1, u2, w), see `bulk.kinematics`."""
    displacement[..., 2] *= 1j
    return displacement


def _nodal(model: WaveModel, waves: WaveSystem, mode: WaveMode) -> tuple[np.ndarray, np.ndarray]:
    """Owned nodal temperatures, the largest 1 in magnitude, and displacements [m/K]."""
    conduction, elasticity = waves.conduction, waves.elasticity
    comm = model.system.comm
    shape = comm.bcast(mode.shape)
    rises = waves.equations.heat.temperatures(mode.factor, mode.rate) @ shape
    everywhere = np.zeros(len(conduction.kept), dtype=complex)
    everywhere[conduction.kept] = rises
    thermal = model.system.thermal
    assert thermal is not None
    own = thermal.conduction.spaces.owned
    start = sum(comm.allgather(own)[: comm.rank])
    temperature = everywhere[start : start + own]
    largest = everywhere[: elasticity.opening.shape[1]]
    scale = 1 / largest[np.argmax(np.abs(largest))]
    temperature, shape = scale * temperature, scale * shape
    forces = elasticity.elastic.thermal_load(thermal.conduction.spaces)
    displacement = elasticity.responses @ (waves.space.pressures @ shape)
    for unit, part in ((1.0, temperature.real), (1j, temperature.imag)):
        displacement += unit * elasticity.elastic.solve(forces.multiply(np.ascontiguousarray(part)))
    return temperature, displacement


def _mirror_plane(model: WaveModel) -> tuple[int, float] | None:
    """Coordinate that is constant on the mirror plane, and its value; every rank calls."""
    if not model.mirror:
        return None
    bodies, own = model.system.bodies, [np.zeros((0, 2))]
    for body in bodies.each:
        for surface in model.mirror:
            own.append(_points_of(body.mesh, body.facets(surface)))
    points = np.concatenate(bodies.comm.allgather(np.concatenate(own)))
    axis = int(np.argmin(np.ptp(points, axis=0)))
    return axis, float(points[:, axis].mean())


def _points_of(mesh, facets: np.ndarray) -> np.ndarray:
    """Coordinates of the nodes of facets, shape (n, 2) [m]."""
    if not len(facets):
        return np.zeros((0, 2))
    dim = mesh.topology.dim
    mesh.topology.create_connectivity(dim - 1, dim)
    nodes = entities_to_geometry(mesh, dim - 1, facets.astype(np.int32))
    return mesh.geometry.x[nodes.ravel()][:, :2]
