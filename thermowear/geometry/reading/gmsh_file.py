"""Reader of gmsh meshes: ``.msh`` of the formats 2 and 4, as text or binary.

gmsh itself executes a file that does not begin as a mesh as a script, so it is never used to
open one. The grammar is in the reference manual of gmsh, section "MSH file format".
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from .contents import MeshContents, numbering, shown
from .gmsh_numbers import Binary, Numbers, Text, elements_2, elements_4, entities, nodes_2, nodes_4

_NUMBERS = ("Entities", "Nodes", "Elements")
_READ = ("MeshFormat", "PhysicalNames", *_NUMBERS)
_PASSED_OVER = (
    *("Comments", "Periodic", "PartitionedEntities", "GhostElements", "Parametrizations"),
    *("NodeData", "ElementData", "ElementNodeData", "InterpolationScheme"),
)
_SECTION = re.compile(rb"\$(\w+)[ \t]*\r?\n")
_NAME = re.compile(r'\s*(\d+)\s+(-?\d+)\s+"([^"\n]*)"\s*')


def read_gmsh(data: bytes) -> MeshContents:
    """Read the bytes of a file.

    Raises
    ------
    ValueError
        If it is not a mesh, or malformed.
    """
    sections = dict(_sections(data))
    for name in ("MeshFormat", "Nodes", "Elements"):
        if name not in sections:
            raise ValueError(f"it has no section ${name}")
    form = _format(sections["MeshFormat"])
    names = _physical_names(sections.get("PhysicalNames", b""))
    sources = {name: form.numbers(sections, name) for name in _NUMBERS if name in sections}
    if form.version == 2:
        sources.pop("Entities", None)
        tags, points = nodes_2(sources["Nodes"])
        blocks = elements_2(sources["Elements"])
    else:
        groups = entities(sources["Entities"], form.minor) if "Entities" in sources else {}
        tags, points = nodes_4(sources["Nodes"], form.minor)
        blocks = elements_4(sources["Elements"], form.minor, groups)
    for source in sources.values():
        if source.left_over():
            raise ValueError(f"the section ${source.name} holds more data than announced")
    positions = numbering(tags)
    return MeshContents(points, [block.named(names, positions) for block in blocks])


def _sections(data: bytes) -> Iterator[tuple[str, bytes]]:
    """Name and body of each section; a mesh contains nothing else."""
    at = 0
    found: set[str] = set()
    while at < len(data):
        start = _SECTION.match(data, at)
        if start is None:
            if data[at : at + 1].isspace():
                at += 1
                continue
            line, number = data[at:].split(b"\n", 1)[0], 1 + data.count(b"\n", 0, at)
            raise ValueError(
                f"line {number}, {shown(line)}, belongs to no section of a "
                "mesh; commands are never executed"
            )
        name = start[1].decode("ascii", "replace")
        if name not in (*_READ, *_PASSED_OVER):
            raise ValueError(f"the section ${name} is not part of a mesh")
        if name in found and name in _READ:
            raise ValueError(f"the section ${name} occurs twice")
        end = data.find(b"$End" + start[1], start.end())
        if end < 0:
            raise ValueError(f"the section ${name} has no end")
        if not found - {"Comments"} and name not in ("MeshFormat", "Comments"):
            raise ValueError("it does not begin with $MeshFormat")
        found.add(name)
        yield name, data[start.end() : end]
        at = end + len(b"$End") + len(name)


@dataclass(frozen=True)
class _Format:
    """Major and minor version, byte order (empty: text), and number of bytes of a ``size_t``."""

    version: int
    minor: int
    order: str
    size: int

    def numbers(self, sections: dict[str, bytes], name: str) -> Numbers:
        body, count = sections[name], None
        if not self.order:
            return Text(name, body)
        if self.version == 2:
            first, _, body = body.partition(b"\n")
            count = int(first)
        return Binary(name, body, self.order, self.size, count)


def _format(body: bytes) -> _Format:
    first, _, rest = body.partition(b"\n")
    words = first.split()
    version, _, minor = words[0].decode("ascii").partition(".") if words else ("", "", "")
    if len(words) != 3 or version not in ("2", "4") or minor[:1] not in ("", "0", "1", "2"):
        raise ValueError(
            f"the format {shown(first)} is not supported; save it as version 4.1 or 2.2"
        )
    size = int(words[2])
    if words[1] == b"0":
        return _Format(int(version), int(minor[:1] or 0), "", size)
    order = {b"\1\0\0\0": "<", b"\0\0\0\1": ">"}.get(rest[:4])
    if order is None or size not in (4, 8) or (version == "4" and minor[:1] in ("", "0")):
        raise ValueError("this type of binary file is not supported; save it as version 4.1")
    return _Format(int(version), int(minor[:1] or 0), order, size)


def _physical_names(body: bytes) -> dict[tuple[int, int], str]:
    """Names by dimension and number of their group."""
    first, *lines = body.decode("utf-8", "replace").strip().splitlines() or ["0"]
    found: dict[tuple[int, int], str] = {}
    for line in lines:
        entry = _NAME.fullmatch(line)
        if entry is None:
            raise ValueError(f"{shown(line.encode())} is not a physical name")
        if found.setdefault((int(entry[1]), int(entry[2])), entry[3]) != entry[3]:
            raise ValueError(f"the group {entry[2]} of dimension {entry[1]} has two names")
    if first.strip() != str(len(found)):
        raise ValueError(
            f"the section $PhysicalNames announces {first.strip()} names and has {len(found)}"
        )
    return found
