"""Fields of the bodies as ``.vtu``, and ``frames/``: intermediate states (``frames.pvd``)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from ..results import FIELDS, HotSpotFields, HotSpotMode
from ..results.points import part_of
from .files import AT, atomic_write, final_name
from .tables import write_points

_CELLS = {(2, 3): "triangle", (2, 4): "quad", (3, 4): "tetra", (3, 8): "hexahedron"}
"""Types of cells by dimension and number of corners."""
_INDEX = "frames.pvd"
_KINDS = {"fields": ".vtu", "interface": ".csv", "track": ".csv"}
"""Files of a frame with their endings."""
_FILE = re.compile(
    rf"fields_(\d{{5,}})\.vtu|interface_[\w-]+{AT}(\d{{5,}})\.csv|(?:interface|track)_(\d{{5,}})\.csv"
)
"""Names of these files, with the number of the frame in one of the groups."""


@dataclass(frozen=True)
class FrameFiles:
    """Files of an intermediate state; see `thermowear.results.Frame`.

    Attributes
    ----------
    time : float
        Time of the state [s].
    number : int
    place : Path
        Folder of the frames.
    """

    time: float
    number: int
    place: Path

    def file(self, kind: str, contact: str = "") -> Path:
        """File of the fields, the track of reciprocating analyses, or the interface.

        The latter by contact in a model of several bodies.
        """
        stem = f"{kind}_{contact}{AT}" if contact else f"{kind}_"
        return self.place / f"{stem}{self.number:05d}{_KINDS[kind]}"


def write_frame(place: Path, frame) -> None:
    """Write a frame in single precision, sufficient for pictures.

    The index lists a frame only while all of its files exist. Frames that are no longer needed,
    frames of later steps of an earlier run, and remains of a killed run are removed.

    Parameters
    ----------
    place : Path
        Folder, created with the first frame.
    frame : thermowear.results.Frame
    """
    place.mkdir(exist_ok=True)
    new = FrameFiles(frame.time, frame.number, place)
    for contact, own in (frame.contacts or {"": slice(None)}).items():
        write_points(new.file("interface", contact), part_of(frame.interface, own))
    if frame.track is not None:
        write_points(new.file("track"), frame.track)
    _write_blocks(new.file("fields"), [_single(block) for block in frame.fields.blocks])
    earlier = [old for old in frame_files(place) if old.number != new.number]
    kept = [o for o in earlier if o.number < new.number and o.number % frame.every == 0]
    _write_index(place, [*kept, new])
    _remove_others(place, [*kept, new])


def frame_files(place: Path) -> list[FrameFiles]:
    """Frames of a folder in the order of time; empty if there is no such folder.

    Raises
    ------
    ValueError
        If the index is not a valid index of frames.
    """
    index = place / _INDEX
    if not index.is_file():
        return []
    try:
        sets = ET.parse(index).getroot().iter("DataSet")
        found = [(float(s.attrib["timestep"]), s.attrib["file"]) for s in sets]
        numbers = [int(file.removeprefix("fields_").removesuffix(".vtu")) for _, file in found]
    except (ET.ParseError, KeyError, ValueError):
        raise ValueError(f"{index}: not an index of frames") from None
    return [FrameFiles(t, number, place) for (t, _), number in zip(found, numbers, strict=True)]


def keep_indexed(place: Path) -> None:
    """Remove files of a killed run that are not listed in the index."""
    if place.is_dir():
        _remove_others(place, frame_files(place))


def remove_frames(place: Path) -> None:
    """Remove the files written by `write_frame`, and the folder if it is empty then."""
    _remove_others(place, [])
    for name in (_INDEX, f".{_INDEX}.part"):
        (place / name).unlink(missing_ok=True)
    if not any(place.iterdir()):
        place.rmdir()


def _remove_others(place: Path, frames: list[FrameFiles]) -> None:
    """Remove files of frames, complete or partial, that belong to none of the given frames."""
    kept = {frame.number for frame in frames}
    for path in place.iterdir():
        found = _FILE.fullmatch(final_name(path))
        partial = final_name(path) != path.name
        if found and (partial or int(next(filter(None, found.groups()))) not in kept):
            path.unlink()


def _write_index(place: Path, frames: list[FrameFiles]) -> None:
    """Write the list of frames as a ParaView collection."""
    root = ET.Element("VTKFile", type="Collection", version="0.1")
    collection = ET.SubElement(root, "Collection")
    for frame in frames:
        ET.SubElement(
            collection, "DataSet", timestep=f"{frame.time:.15g}", file=frame.file("fields").name
        )
    ET.indent(root)
    with atomic_write(place / _INDEX) as draft:
        ET.ElementTree(root).write(draft, encoding="utf-8", xml_declaration=True)


def _single(fields):
    """Convert fields of one cell type to single precision."""
    names = ("points", "displacement", "von_mises", "temperature")
    values = {name: getattr(fields, name) for name in names}
    short = {name: v.astype(np.float32) for name, v in values.items() if v is not None}
    return replace(fields, **short)


def write_fields(path: Path, fields) -> None:
    """Write the fields on linear subcells, discontinuous between the cells of the mesh.

    Parameters
    ----------
    path : Path
    fields : thermowear.results.BodyFields or thermowear.results.MixedFields
    """
    _write_blocks(path, fields.blocks)


def _write_blocks(path: Path, blocks: Sequence) -> None:
    """Write `thermowear.results.BodyFields`, one for each type of cells."""
    import meshio

    points, cells, body, start = [], [], [], 0
    data: dict[str, list[np.ndarray]] = {}
    for fields in blocks:
        n_cells, n_points, gdim = fields.points.shape
        first = start + np.arange(n_cells)[:, None, None] * n_points
        corners = fields.pieces.shape[1]
        cells.append((_CELLS[gdim, corners], (first + fields.pieces).reshape(-1, corners)))
        points.append(_three(fields.points.reshape(-1, gdim)))
        body.append(np.repeat(fields.body, len(fields.pieces)))
        values = {"displacement": _three(fields.displacement.reshape(-1, gdim))}
        values["von_mises"] = fields.von_mises.ravel()
        if fields.temperature is not None:
            values["temperature"] = fields.temperature.ravel()
        for name, value in values.items():
            data.setdefault(FIELDS[name].header, []).append(value)
        start += n_cells * n_points
    joined = {name: np.concatenate(values) for name, values in data.items()}
    mesh = meshio.Mesh(np.concatenate(points), cells, joined, {"body": body})
    with atomic_write(path) as draft:
        mesh.write(draft, file_format="vtu")


def _three(vectors: np.ndarray) -> np.ndarray:
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


HOT_SPOTS = "hot_spots.vtu"
_PER_WAVE, _LEAST, _MOST = 16, 72, 320
"""Steps round the axis: for each wave, and all of them."""
_WAVES = 2
"""Number of waves along a prism that are drawn."""
_SOLID_CELLS = {3: "wedge", 4: "hexahedron"}


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
            cells.append((_SOLID_CELLS[fields.pieces.shape[1]], start + corners))
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
