"""Fields of a mode of hot spots in space, from its amplitudes in the section, as ``.vtu``."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np

from ..results import HotSpotFields, HotSpotMode
from .files import atomic_write

HOT_SPOTS = "hot_spots.vtu"
_PER_WAVE, _LEAST, _MOST = 16, 72, 320
"""Steps round the axis: for each wave, and all of them."""
_WAVES = 2
"""Number of waves along a prism that are drawn."""
_CELLS = {3: "wedge", 4: "hexahedron"}


def write_hot_spots(path: Path, mode: HotSpotMode) -> None:
    """Write temperature and displacement perturbations round the axis, or along two waves.

    Half models are completed by their mirrored half. The largest temperature is 1 K; the numbers of
    the bodies are kept.

    Parameters
    ----------
    path : Path
    mode : thermowear.results.HotSpotMode
    """
    import meshio

    points, temperature, displacement, bodies, cells, start = [], [], [], [], [], 0
    for fields in mode.blocks:
        for mirrored in (False, True)[: 1 + (mode.mirror is not None)]:
            part = _mirrored(fields, mode) if mirrored else fields
            at, rise, moved, corners = _in_space(part, mode)
            cells.append((_CELLS[fields.pieces.shape[1]], start + corners))
            bodies.append(np.tile(np.repeat(part.body, len(part.pieces)), _steps(mode)))
            start += len(at)
            points.append(at)
            temperature.append(rise)
            displacement.append(moved)
    data = {
        "temperature_K": np.concatenate(temperature).astype(np.float32),
        "displacement_m": np.concatenate(displacement).astype(np.float32),
    }
    conductor = [np.equal(body, mode.conductor).astype(np.int8) for body in bodies]
    of_cells = {"body": bodies, "is_best_conductor": conductor}
    mesh = meshio.Mesh(np.concatenate(points).astype(np.float32), cells, data, of_cells)
    with atomic_write(path) as draft:
        mesh.write(draft, file_format="vtu")


def _steps(mode: HotSpotMode) -> int:
    """Number of steps along the sliding direction."""
    if not mode.is_ring:
        return _WAVES * _PER_WAVE
    return int(np.clip(_PER_WAVE * mode.number, _LEAST, _MOST))


def _mirrored(fields: HotSpotFields, mode: HotSpotMode) -> HotSpotFields:
    """Other half of a half model: equal or opposite fields, by the symmetry of the mode."""
    assert mode.mirror is not None
    axis, value = mode.mirror
    points, moved = fields.points.copy(), mode.symmetry * fields.displacement
    points[..., axis] = 2 * value - points[..., axis]
    moved[..., axis] *= -1.0
    return HotSpotFields(
        points,
        fields.pieces[:, ::-1],  # the orientation of the cells is kept
        fields.body,
        mode.symmetry * fields.temperature,
        moved,
    )


def _in_space(fields: HotSpotFields, mode: HotSpotMode):
    """Points, temperature and displacement in space, and the corners of the cells."""
    steps, size = _steps(mode), fields.temperature.size
    x, y = fields.points.reshape(-1, 2).T
    layers = steps if mode.is_ring else steps + 1
    if mode.is_ring:
        along = 2 * pi * np.arange(layers) / steps
        phase = np.exp(1j * mode.number * along)
    else:
        along = _WAVES * 2 * pi / mode.number * np.arange(layers) / steps
        phase = np.exp(1j * mode.number * along)
    rise = np.outer(phase, fields.temperature.ravel()).real
    u1, u2, u3 = (np.outer(phase, u.ravel()).real for u in np.moveaxis(fields.displacement, -1, 0))
    if mode.is_ring:
        c, s = np.cos(along)[:, None], np.sin(along)[:, None]
        points = np.stack([c * x, s * x, np.broadcast_to(y, rise.shape)], axis=-1)
        moved = np.stack([c * u1 - s * u3, s * u1 + c * u3, u2], axis=-1)
    else:
        wide = np.ones((layers, 1))
        points = np.stack([wide * x, wide * y, along[:, None] * np.ones(size)], axis=-1)
        moved = np.stack([u1, u2, u3], axis=-1)
    n_cells, n_points = fields.temperature.shape
    corners = (np.arange(n_cells)[:, None, None] * n_points + fields.pieces).reshape(
        -1, fields.pieces.shape[1]
    )
    near = np.arange(steps)[:, None, None] * size + corners
    far = ((np.arange(steps) + 1) % layers)[:, None, None] * size + corners
    hexahedra = np.concatenate([near, far], axis=2).reshape(-1, 2 * corners.shape[1])
    return points.reshape(-1, 3), rise.ravel(), moved.reshape(-1, 3), hexahedra
