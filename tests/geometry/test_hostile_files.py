"""Files that want more than to be read."""

from __future__ import annotations

import gzip
import os
import pickle
import sys
import zlib
from base64 import b64encode
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.errors import CaseError
from thermowear.geometry.geometries.mesh_file import MeshFile
from thermowear.geometry.reading import file_contents
from thermowear.output.checkpoint import CHECKPOINT, read_checkpoint

from .plain import NAMES, NUMBERED, blocks, inp, meshio_file, msh
from .test_mesh_file import GMSH_NAMES, gmsh_blocks

CALL = 'SystemCall "touch {mark}";\n'
GOOD = msh(blocks())
DECK = inp(blocks())
HEAD = "<?xml version='1.0'?>\n"
INCLUDED = '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="{secret}" parse="text"/>'
GRID = """<?xml version="1.0"?><Xdmf Version="3.0"><Domain><Grid Name="g">
<Geometry GeometryType="XY">
<DataItem DataType="Float" Dimensions="4 2" Format="{form}" Precision="8">{text}</DataItem>
</Geometry><Topology TopologyType="Quadrilateral" NumberOfElements="1">
<DataItem DataType="Int" Dimensions="1 4" Format="XML">0 1 2 3</DataItem></Topology>
</Grid></Domain></Xdmf>"""
SECTION = "belongs to no section of a mesh; commands are never executed"
NO_SECTION = "only meshes are read, commands are never executed"

TEXTS = {
    "script.msh": (CALL, NO_SECTION),
    "include.msh": ('Include "{secret}";\n', NO_SECTION),
    "merge.msh": ('Merge "{secret}";\n', NO_SECTION),
    "behind.msh": (GOOD + CALL, SECTION),
    "before_the_end.msh": (GOOD.replace("$EndMeshFormat\n", "$EndMeshFormat\n" + CALL), SECTION),
    "in_the_format.msh": (
        "$MeshFormat\n2.2 0 8\n" + CALL + "$EndMeshFormat\n",
        "no section $Nodes",
    ),
    "comments_first.msh": ("$Comments\nhello\n$EndComments\n" + CALL, SECTION),
    "comments_only.msh": ("$Comments\n" + CALL + "$EndComments\n", "no section $MeshFormat"),
    "own_section.msh": (
        GOOD + "$Script\n" + CALL + "$EndScript\n",
        "$Script is not part of a mesh",
    ),
    "among_nodes.msh": (
        GOOD.replace("$EndNodes", CALL + "$EndNodes"),
        "where a number is expected",
    ),
    "views.msh": ("$PostFormat\n1.4 0 8\n$EndPostFormat\n" + CALL, NO_SECTION),
    "script.inp": (CALL, NO_SECTION),
    "include.inp": (DECK + "*INCLUDE, INPUT={secret}\n", "*INCLUDE includes another file"),
    "nodes_elsewhere.inp": ("*NODE, INPUT={secret}\n" + DECK, "*NODE includes another file"),
    "script.vtu": (CALL, NO_SECTION),
    "entity.vtu": (
        HEAD + '<!DOCTYPE v [<!ENTITY x SYSTEM "file://{secret}">]><VTKFile>&x;</VTKFile>',
        "document type declaration",
    ),
    "bomb.vtu": (
        HEAD
        + '<!DOCTYPE v [<!ENTITY a "ha">'
        + "".join(f'<!ENTITY {b} "{10 * f"&{a};"}">' for a, b in pairwise("abcdefghij"))
        + "]><VTKFile>&j;</VTKFile>",
        "document type declaration",
    ),
    "include.vtu": (HEAD + "<VTKFile>" + INCLUDED + "</VTKFile>", "includes another file"),
    "script.xdmf": (CALL, NO_SECTION),
    "entity.xdmf": (
        '<!DOCTYPE Xdmf [<!ENTITY % x SYSTEM "file://{secret}"> %x;]><Xdmf Version="3.0"/>',
        "document type declaration",
    ),
    "include.xdmf": (HEAD + "<Xdmf><Domain>" + INCLUDED + "</Domain></Xdmf>", "includes another"),
    "binary.xdmf": (GRID.replace("{form}", "Binary").replace("{text}", "{secret}"), "other files"),
    "heavy_elsewhere.xdmf": (
        GRID.replace("{form}", "HDF").replace("{text}", "../secret:/x"),
        "which is not a file in the same folder",
    ),
    "heavy_anywhere.xdmf": (
        GRID.replace("{form}", "HDF").replace("{text}", "{secret}:/x"),
        "which is not a file in the same folder",
    ),
    "nodes_of_a_file.inp": (DECK + "*ELEMENT, TYPE=CPS4, FILE={secret}\n", "includes another file"),
    "on_the_next_line.inp": (DECK + "*NODE,\n INPUT={secret}\n", "includes another file"),
    "old_lines.msh": (GOOD.replace("\n", "\r") + CALL, SECTION),
    "nothing_first.msh": (GOOD.replace("$Nodes", "\0$Nodes"), SECTION),
    "unsaid.msh": (
        GOOD.replace("$EndNodes", "99 0 0 0\n$EndNodes"),
        "holds more data than announced",
    ),
    "script.geo": (CALL, "unknown file ending"),
    "script.MSH": (CALL, NO_SECTION),
    "hidden_include.vtu": (
        HEAD + "<VTKFile type='UnstructuredGrid'><!-- <AppendedData -->" + INCLUDED + "</VTKFile>",
        "Unknown main tag",
    ),
    "codec.vtu": ('<?xml version="1.0" encoding="zlib_codec"?><VTKFile/>', "not a text encoding"),
    "pieces.vtu": (
        '<VTKFile type="PUnstructuredGrid"><Piece Source="{secret}"/></VTKFile>',
        "found PUnstructuredGrid",
    ),
    "group.xdmf": (
        GRID.replace("{form}", "HDF").replace("{text}", "..:/x"),
        "not a file in the same folder",
    ),
    "script.med": (CALL, NO_SECTION),
    "archive.msh": ("\x1f\x8b\x08\x00", "it is not a gmsh mesh"),
}
"""Name of a file, its text, and part of the answer."""


class _Spy:
    """Notes what this process opens and starts while it is on."""

    def __init__(self) -> None:
        self.on, self.seen = False, []
        sys.addaudithook(self._hear)

    def _hear(self, event: str, args) -> None:
        if self.on and event in (
            "open",
            "os.system",
            "os.exec",
            "subprocess.Popen",
            "socket.connect",
        ):
            self.seen.append((event, args[:2]))


@pytest.fixture(scope="module")
def spy():
    return _Spy()


@pytest.fixture
def place(tmp_path):
    """A folder with a mesh file's place, a secret beside it and a mark that must not appear."""
    (tmp_path / "secret").write_text("0 0 1 0 1 1 0 1\n*NODE\n1, 2, 3\n")
    (tmp_path / "folder").mkdir()
    return tmp_path


def refused(place: Path, name: str, keys=NAMES) -> str:
    """One line, and nothing else in the folder than before."""
    before = {path: path.lstat().st_mtime_ns for path in place.rglob("*")}
    geometry = {"type": "file", "path": str(place / "folder" / name)} | keys
    with pytest.raises(CaseError) as error:
        MeshFile.model_validate(geometry).build(None, None)
    assert {path: path.lstat().st_mtime_ns for path in place.rglob("*")} == before
    (line,) = error.value.faults
    assert "\n" not in line
    assert line.startswith("geometry.path: ")
    return line


@pytest.mark.parametrize("name", TEXTS)
def test_hostile_texts(name, place, spy):
    """
    requirement: scripts under every ending, behind and within sections, other files by inclusion,
    entities and references: refused in one line, with nothing carried out, written or read.
    """
    text, expected = TEXTS[name]
    filled = text.replace("{mark}", str(place / "mark")).replace("{secret}", str(place / "secret"))
    (place / "folder" / name).write_text(filled, encoding="latin-1")
    spy.seen.clear()
    spy.on = True
    try:
        line = refused(place, name)
    finally:
        spy.on = False
    assert expected in line
    assert not any(str(args[0]).endswith(("secret", "mark")) for _, args in spy.seen)
    started = [args[0] for event, args in spy.seen if event != "open"]
    assert all(name.endswith((".vtu", ".xdmf")) and "python" in str(what) for what in started)


@pytest.mark.parametrize("section", ["Nodes", "Elements", "EndElements"])
@pytest.mark.parametrize("version", [2.2, 4.1])
def test_commands_in_binary_meshes(version, section, place):
    """
    requirement: what stands behind the numbers of a binary section, or behind the last one, is not
    passed over.
    """
    path = place / "folder" / "mesh.msh"
    gmsh_blocks(path, version, Binary=1)
    mark = b"$End" + section.removeprefix("End").encode()
    at = path.read_bytes().index(mark) + (len(mark) if section == "EndElements" else 0)
    content, call = path.read_bytes(), CALL.replace("{mark}", str(place / "mark")).encode()
    path.write_bytes(content[:at] + b"\n" + call + content[at:])
    line = refused(place, "mesh.msh", GMSH_NAMES)
    assert SECTION in line or f"the section ${section} holds more data than announced" in line


@pytest.mark.parametrize("ending", ["msh", "vtu", "xdmf"])
def test_archives(ending, place):
    """
    requirement: what is compressed is not unpacked.
    """
    (place / "folder" / f"mesh.{ending}").write_bytes(gzip.compress(GOOD.encode()))
    assert NO_SECTION in refused(place, f"mesh.{ending}")


@pytest.mark.parametrize("target", ["loop.msh", "/dev/stdin", "/proc/self/environ"])
def test_symbolic_links(target, place):
    """
    requirement: a link is what it leads to: nothing, no file, or no mesh.
    """
    os.symlink(target, place / "folder" / "loop.msh")
    assert "cannot be read: " in refused(place, "loop.msh")


def test_options_beside_a_mesh(place):
    """
    requirement: what gmsh would take for options of a model is not read.
    """
    path = place / "folder" / "mesh.msh"
    path.write_text(GOOD)
    for beside in ("mesh.msh.opt", "mesh.opt", ".gmshrc"):
        path.with_name(beside).write_text(CALL.replace("{mark}", str(place / "mark")))
    geometry = MeshFile.model_validate({"type": "file", "path": str(path)} | NAMES)
    assert len(geometry.build(None, None).cells) == 20
    assert not (place / "mark").exists()


def _external_link(file, secret) -> None:
    import h5py

    file["ENS_MAA"] = h5py.ExternalLink(str(secret), "/ENS_MAA")


def _soft_link(file, secret) -> None:
    import h5py

    file["a"] = h5py.SoftLink("/a")


def _raw_file(file, secret) -> None:
    file.create_group("ENS_MAA").create_dataset("x", (4,), "i4", external=[(str(secret), 0, 16)])


def _virtual(file, secret) -> None:
    import h5py

    layout = h5py.VirtualLayout((4,), "i4")
    layout[:] = h5py.VirtualSource(str(secret), "x", (4,))
    file.create_virtual_dataset("x", layout)


@pytest.mark.parametrize("hide", [_external_link, _soft_link, _raw_file, _virtual])
@pytest.mark.parametrize("ending", ["med", "xdmf"])
def test_hdf5_files_that_lead_elsewhere(hide, ending, place):
    """
    requirement: links, raw files and virtual data in .med, and in what an .xdmf refers to.
    """
    import h5py

    name = "mesh.med" if ending == "med" else "heavy.h5"
    with h5py.File(place / "folder" / name, "w") as file:
        hide(file, place / "secret")
    if ending == "xdmf":
        text = GRID.replace("{form}", "HDF").replace("{text}", "heavy.h5:/x")
        (place / "folder" / "mesh.xdmf").write_text(text)
    line = refused(place, f"mesh.{ending}")
    assert "a mesh must be in one file" in line or "is stored in another file" in line


@pytest.mark.parametrize("content", [b"", b"\x89HDF\r\n\x1a\n" + 300 * b"\xff", b"\0" * 999])
def test_hdf5_files_that_are_broken(content, place):
    """
    requirement: one line, whatever the library does with them.
    """
    (place / "folder" / "mesh.med").write_bytes(content)
    assert "cannot be read: " in refused(place, "mesh.med")


def test_data_that_swell(place, monkeypatch):
    """
    requirement: a file of some kilobytes cannot take all memory.
    """
    monkeypatch.setattr(file_contents, "_MEMORY", 5 * 2**27)
    maker = zlib.compressobj(9)
    first = maker.compress(bytes(2**20)) + maker.flush(zlib.Z_FULL_FLUSH)
    again = maker.compress(bytes(2**20)) + maker.flush(zlib.Z_FULL_FLUSH)
    data = first + 900 * again
    head = np.array([1, 2**31 - 1, 0, len(data)], dtype="<u4").tobytes()
    text = b64encode(head).decode() + b64encode(data).decode()
    (place / "folder" / "mesh.vtu").write_text(
        '<VTKFile type="UnstructuredGrid" compressor="vtkZLibDataCompressor" '
        'byte_order="LittleEndian"><UnstructuredGrid><Piece NumberOfPoints="1" NumberOfCells="0">'
        '<Points><DataArray type="Float64" NumberOfComponents="3" format="binary">'
        f"{text}</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"
    )
    assert "it exceeds the memory limit of a mesh" in refused(place, "mesh.vtu")


@pytest.mark.parametrize("ending", ["msh", "inp", "vtu", "xdmf", "med"])
def test_what_is_no_file(ending, place):
    """
    requirement: pipes and devices neither hang nor fill the memory.
    """
    os.mkfifo(place / "folder" / f"pipe.{ending}")
    os.symlink("/dev/zero", place / "folder" / f"zero.{ending}")
    for name in ("pipe", "zero"):
        assert "a pipe or a device" in refused(place, f"{name}.{ending}")


def test_files_that_are_too_large(place):
    """
    requirement: the size of a file is bounded.
    """
    path = place / "folder" / "mesh.msh"
    path.write_text(GOOD)
    os.truncate(path, 2**40)
    assert "it has 1048576 MB; at most 32 MB are allowed" in refused(place, "mesh.msh")


def test_ranges_without_end(place):
    """
    requirement: a range costs no more than the numbers that there are; in 64 bits or not.
    """
    path = place / "folder" / "mesh.inp"
    path.write_text(f"{DECK}*NSET, NSET=ALL, GENERATE\n1, 99999999999, 1\n")
    geometry = MeshFile.model_validate({"type": "file", "path": str(path)} | NAMES)
    assert len(geometry.build(None, None).cells) == 20
    path.write_text(f"{DECK}*NSET, NSET=ALL, GENERATE\n1, {10**30}, 1\n")
    assert len(geometry.build(None, None).cells) == 20
    path.write_text(f"{DECK}*NSET, NSET=ALL\n{10**30}\n")
    assert "cannot be read: " in refused(place, "mesh.inp")


class _Touch:
    """Unpickled, it makes a file."""

    def __init__(self, mark: Path):
        self.mark = mark

    def __reduce__(self):
        return os.system, (f"touch {self.mark}",)


@pytest.mark.parametrize("raw", [False, True])
def test_pickles_in_checkpoints(raw, place):
    """
    requirement: no pickle is ever loaded, in an archive or instead of one.
    """
    bomb = np.array([_Touch(place / "mark")], dtype=object)
    path = place / CHECKPOINT
    if raw:
        path.write_bytes(pickle.dumps(bomb))
    else:
        np.savez(path, about=bomb, x=bomb)
    with pytest.raises(CaseError) as error:
        read_checkpoint(path)
    (line,) = error.value.faults
    assert line.startswith(f"{path}: cannot be read: ")
    assert not (place / "mark").exists()


@pytest.mark.parametrize("name", ["shape.csv", "shape.npz", "shape.msh", "shape.vtu", "shape.step"])
def test_pickles_and_scripts_as_initial_shapes(name, place, capsys):
    """
    requirement: tables of worn shapes are read as text, whatever the file is called.
    """
    path, case = place / name, place / "case.toml"
    bomb = np.array([_Touch(place / "mark")], dtype=object)
    if name.endswith(".npz"):
        np.savez(path, shape=bomb)
    else:
        path.write_text(CALL.replace("{mark}", str(place / "mark")))
    assert main(["init", "cylinder-on-block", "-o", str(case)]) == 0
    capsys.readouterr()
    overrides = (f"geometry.initial_shape={name}", "mesh.degree=2", "contact.positioning=false")
    with pytest.raises(CaseError) as error:
        tw.run(tw.load(case, overrides))
    (line,) = error.value.faults
    assert line.startswith("geometry.initial_shape: ")
    assert not (place / "mark").exists()


@pytest.mark.parametrize("ending", ["vtu", "xdmf", "med"])
def test_good_files_are_read_apart(ending, place):
    """
    requirement: the bounds leave room for meshes.
    """
    path = place / "folder" / f"mesh.{ending}"
    meshio_file(blocks(), path)
    keys = NAMES if ending == "med" else NUMBERED
    geometry = MeshFile.model_validate({"type": "file", "path": str(path)} | keys)
    assert len(geometry.build(None, None).cells) == 20
