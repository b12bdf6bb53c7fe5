"""Program that reads a mesh file with libraries, run by `file_contents` in a separate process.

Started by its path, so that this package is not imported. The file may be hostile: memory and
processor time are limited, no file can be written, and only the named one (and an HDF5 file
next to an .xdmf) is opened. The result is written to the standard output as ``.npz``.
"""

from __future__ import annotations

import importlib
import io
import json
import os
import sys
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np

_SECONDS = 20
"""Largest processor time [s]."""
_MIXED = {
    1: ("vertex", 1),
    2: ("line", 2),
    4: ("triangle", 3),
    5: ("quad", 4),
    6: ("tetra", 4),
    9: ("hexahedron", 8),
    0x22: ("line3", 3),
    0x23: ("quad9", 9),
    0x24: ("triangle6", 6),
    0x25: ("quad8", 8),
    0x26: ("tetra10", 10),
    0x30: ("hexahedron20", 20),
    0x32: ("hexahedron27", 27),
}
"""Type and number of nodes of cells in mixed topologies, see XdmfTopologyType.cpp."""
_COUNTED = (1, 2)
"""Mixed cells whose number of nodes follows their type."""


def read(path: Path, ending: str) -> dict[str, np.ndarray]:
    """Arrays that describe a mesh, see `file_contents.read_isolated`."""
    if ending == ".med":
        _check_hdf5_links(path)
    else:
        _check_xml(path)
    if ending == ".xdmf":
        mesh = _read_xdmf(path)
        cells = mesh.cells
    else:
        mesh = importlib.import_module(f"meshio{ending}").read(str(path))
        cells = [(block.type, block.data) for block in mesh.cells]
    arrays = {"points": np.asarray(mesh.points, dtype=float)}
    contents = {"kinds": [kind for kind, _ in cells], "sets": [], "node_sets": []}
    for index, ((_, nodes), sets) in enumerate(zip(cells, _sets_of_blocks(mesh), strict=True)):
        arrays[f"nodes_{index}"] = np.asarray(nodes, dtype=np.int64)
        for name, members in sets.items():
            arrays[f"set_{len(contents['sets'])}"] = members
            contents["sets"].append([index, name])
    for name, members in _node_sets(mesh).items():
        arrays[f"node_set_{len(contents['node_sets'])}"] = members
        contents["node_sets"].append(name)
    return arrays | {"contents": np.array(json.dumps(contents))}


def _sets_of_blocks(mesh) -> list[dict[str, np.ndarray]]:
    """Sets by name (families of .med), or by the numbers of integer data (.vtu, .xdmf).

    Of several data, ``"material=1"`` is a number of one of them; a number alone is a set if all
    data that have it agree.
    """
    found: list[list[tuple[str, np.ndarray]]] = [[] for _ in mesh.cells]
    data = {key: [np.asarray(values) for values in of] for key, of in mesh.cell_data.items()}
    for key, of_key in list(data.items()):
        if any(values.ndim > 1 or values.dtype.kind not in "iu" for values in of_key):
            del data[key]
    if hasattr(mesh, "cell_tags"):
        for index, values in enumerate(data.pop("cell_tags", [])):
            for value in np.unique(values):
                names = mesh.cell_tags.get(value, [])
                found[index] += [(name, np.flatnonzero(values == value)) for name in names]
    if "gmsh:physical" in data:
        data.pop("gmsh:geometrical", None)  # parts of the drawing
    members = {
        key: {int(n): [np.flatnonzero(v == n) for v in of] for n in np.unique(np.concatenate(of))}
        for key, of in data.items()
    }
    for key, sets in members.items():
        for number, parts in sets.items():
            others = [of[number] for of in members.values() if number in of]
            names = [f"{key}={number}"] if len(members) > 1 else []
            if all(map(np.array_equal, parts * len(others), [p for of in others for p in of])):
                names.append(str(number))
            for index, part in enumerate(parts):
                found[index] += [(name, part) for name in names if len(part)]
    return [_united(of_block) for of_block in found]


def _node_sets(mesh) -> dict[str, np.ndarray]:
    """Node sets of .med files."""
    values = mesh.point_data.get("point_tags", np.empty(0))
    families = getattr(mesh, "point_tags", {}).items()
    return _united([(name, np.flatnonzero(values == f)) for f, names in families for name in names])


def _united(sets: list[tuple[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Union of the sets of each name."""
    found: dict[str, np.ndarray] = {}
    for name, members in sets:
        found[name] = np.union1d(found[name], members) if name in found else members
    return found


def _check_xml(path: Path) -> None:
    """Reject XML with entities or included files."""
    from xml.parsers import expat

    def refuse(*_) -> None:
        raise ValueError(
            "it has a document type declaration (<!DOCTYPE>), which is not allowed in a mesh"
        )

    def begin(name: str, _) -> None:
        if name.rpartition(":")[2].rpartition("}")[2] == "include":
            raise ValueError("it includes another file; a mesh must be in one file")

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler = begin
    data = path.read_bytes()
    raw = data.find(b"<AppendedData")  # raw bytes, not necessarily XML
    try:
        parser.Parse(data if raw < 0 else data[:raw], raw < 0)
    except expat.ExpatError as error:
        raise ValueError(f"it is not XML: {error}") from None
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        refuse()


def _check_hdf5_links(path: Path) -> None:
    """Reject HDF5 files that refer to data in other files."""
    import h5py

    with h5py.File(path, "r") as file:
        seen: set[int] = set()
        groups: list = [file]
        while groups:
            group = groups.pop()
            number = h5py.h5o.get_info(group.id).addr
            if number in seen:
                continue
            seen.add(number)
            for name in group:
                link = group.get(name, getlink=True)
                if not isinstance(link, h5py.HardLink):
                    raise ValueError(f"its entry {name!r} is a link; a mesh must be in one file")
                entry = group[name]
                if isinstance(entry, h5py.Group):
                    groups.append(entry)
                elif isinstance(entry, h5py.Dataset) and (entry.external or entry.is_virtual):
                    raise ValueError(f"its entry {name!r} is stored in another file")


def _read_xdmf(path: Path) -> SimpleNamespace:
    """Mesh of an XDMF file with one grid, with data in it or in an HDF5 file next to it."""
    from xml.etree import ElementTree as ET

    from meshio.xdmf.common import xdmf_to_meshio_type as types

    grids = ET.parse(path).getroot().findall("./Domain/Grid")
    if len(grids) != 1 or grids[0].get("GridType", "Uniform") != "Uniform":
        raise ValueError("an .xdmf file must have one uniform grid")
    parts = {tag: grids[0].findall(tag) for tag in ("Geometry", "Topology", "Attribute")}
    if len(parts["Geometry"]) != 1 or len(parts["Topology"]) != 1:
        raise ValueError("the grid needs one Geometry and one Topology")
    geometry, topology = parts["Geometry"][0], parts["Topology"][0]
    width = {"XY": 2, "XYZ": 3}.get(_type(geometry, "Geometry") or "XYZ", 0)
    points = _item(path, geometry).reshape(-1, width) if width else None
    if points is None:
        raise ValueError(f"points of type {_type(geometry, 'Geometry')} are not supported")
    kind, data = _type(topology, "Topology"), _item(path, topology)
    if kind == "Mixed":
        cells, at = _mixed(data.ravel())
    elif kind in types:
        cells = [(types[kind], data.reshape(len(data), -1))]
        at = [np.arange(len(data))]
    else:
        raise ValueError(f"cells of type {kind} are not supported in .xdmf")
    values = {
        str(entry.get("Name")): _item(path, entry)
        for entry in parts["Attribute"]
        if entry.get("Center") == "Cell"
    }
    of_blocks = {}
    for name, value in values.items():
        if len(value) != sum(map(len, at)):
            raise ValueError(f"the attribute {name} must have one value per cell")
        squeezed = value[:, 0] if value.ndim == 2 and value.shape[1] == 1 else value
        of_blocks[name] = [squeezed[members] for members in at]
    return SimpleNamespace(points=points, cells=cells, cell_data=of_blocks, point_data={})


def _type(entry, tag: str) -> str | None:
    return entry.get(f"{tag}Type", entry.get("Type"))


def _item(path: Path, entry) -> np.ndarray:
    """Data of an element, in the file or in an HDF5 file next to it."""
    items = entry.findall("DataItem")
    if len(items) != 1 or "Reference" in items[0].attrib:
        raise ValueError(f"a {entry.tag} needs exactly one DataItem")
    item = items[0]
    kind = item.get("DataType", item.get("NumberType", "Float"))
    if kind not in ("Float", "Int", "UInt"):
        raise ValueError(f"data of type {kind} are not supported")
    shape = [int(word) for word in (item.get("Dimensions") or "").split()]
    text = (item.text or "").strip()
    if item.get("Format", "XML") == "XML":
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # for words that are not numbers
            values = np.fromstring(text, float if kind == "Float" else np.int64, sep=" ")
    elif item.get("Format") == "HDF":
        values = _hdf5_dataset(path, text)
    else:
        raise ValueError(f"data of the format {item.get('Format')} are stored in other files")
    if values.size != np.prod(shape, dtype=float):
        raise ValueError(f"a DataItem of {entry.tag} contradicts its dimensions")
    return values.reshape(shape)


def _hdf5_dataset(path: Path, text: str) -> np.ndarray:
    """Data set of an HDF5 file in the same folder."""
    import h5py

    name, _, inside = text.partition(":")
    beside = path.parent / name
    if Path(name).name != name or not beside.is_file() or beside.is_symlink():
        raise ValueError(f"its data are in {name!r}, which is not a file in the same folder")
    _check_hdf5_links(beside)
    with h5py.File(beside, "r") as file:
        return np.asarray(file[inside][()])


def _mixed(data: np.ndarray) -> tuple[list[tuple[str, np.ndarray]], list[np.ndarray]]:
    """Blocks of cells of one type each, and indices of the cells in the file."""
    nodes: dict[int, list[np.ndarray]] = {}
    members: dict[int, list[np.ndarray]] = {}
    at, cell = 0, 0
    while at < len(data):
        number = int(data[at])
        if number not in _MIXED:
            raise ValueError(f"cells of XDMF's type {number} are not supported")
        kind, count = _MIXED[number]
        head = [number, count] if number in _COUNTED else [number]
        if data[at : at + len(head)].tolist() != head:
            raise ValueError(f"cells of type {kind} must have {count} nodes")
        rows = _equal_rows(data[at:], head, len(head) + count)
        nodes.setdefault(number, []).append(rows[:, len(head) :])
        members.setdefault(number, []).append(cell + np.arange(len(rows)))
        at, cell = at + rows.size, cell + len(rows)
    blocks = [(_MIXED[n][0], np.concatenate(parts)) for n, parts in nodes.items()]
    return blocks, [np.concatenate(parts) for parts in members.values()]


def _equal_rows(data: np.ndarray, head: list[int], width: int) -> np.ndarray:
    """First rows of a width that begin with the same numbers, shape (n, width)."""
    most = len(data) // width
    if most == 0:
        raise ValueError("the last cell is incomplete")
    count, alike = 1, np.ones(1, dtype=bool)
    while count < most and alike.all():
        count = min(2 * count, most)
        rows = data[: count * width].reshape(count, width)
        alike = np.all(rows[:, : len(head)] == head, axis=1)
    count = count if alike.all() else int(alike.argmin())
    return data[: count * width].reshape(count, width)


def _set_limits(memory: int) -> None:
    """Limit memory [bytes] and processor time of this process, and forbid writing of files."""
    import resource

    for limit, most in (
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_CPU, _SECONDS),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
    ):
        _, hard = resource.getrlimit(limit)
        bound = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(limit, (bound, hard))


def main(path: str, ending: str, memory: str) -> int:
    """Write the arrays, or one line with the reason of a failure."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of the libraries goes to stderr
    _set_limits(int(memory))
    try:
        arrays = read(Path(path), ending)
        packed = io.BytesIO()
        np.savez(packed, allow_pickle=False, **arrays)
    except MemoryError:
        reason = "it exceeds the memory limit of a mesh"
    except (Exception, SystemExit) as error:  # readers raise any exception for a malformed file
        reason = " ".join(str(error).split()) or type(error).__name__
        reason = {"KeyError": f"it has no entry {reason}"}.get(type(error).__name__, reason)
    else:
        out.write(packed.getbuffer())
        out.close()
        return 0
    sys.stderr.write(f"\n{reason}")
    return 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
