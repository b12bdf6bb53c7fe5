"""Several bodies from a mesh file or a file each: reading, names, and one line for every fault."""

import math
import warnings

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.errors import CaseNote
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.geometry.reading.export import write_mesh

from ..case.starter import changed
from ..conftest import two_blocks
from ..ring_meshes import STARTER_MESH, starter_rings, write_rings
from ..solid_meshes import DISK, PAD, write_blocks

STEEL = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}
NAMED = {
    "pad": {"face": "FACE", "back": "PAD_BACK"},
    "disk": {"track": "FACE", "bottom": "DISK_BOTTOM"},
}
"""Surfaces of the bodies of `write_blocks` that share the nodes of their joint."""


def blocks(path, **changes):
    """Tables of a pad on a block in space, whose contact is the joint of a fragmented mesh."""
    case = {
        "model": "3d",
        "geometry": {
            "type": "file",
            "path": str(path),
            "length_unit": "1 mm",
            "bodies": {"pad": "PAD", "disk": "DISK"},
            "surfaces": NAMED,
        },
        "mesh": {"degree": 2},
        "bodies": {"pad": STEEL, "disk": STEEL | {"fixed": "bottom"}},
        "contact": {"friction": 0.2},
        "contacts": {"rubbing": {"between": ["face", "track"]}},
        "holders": {"arm": {"surface": "back", "force": "100 N"}},
        "motions": {"disk": {"velocity": "-1 m/s"}},
        "wear": {"pad": {"coefficient": "1e-8 1/MPa", "per": "pressure"}},
        "analysis": {"type": "steady"},
    }
    return changed(case, {key.replace("__", "."): value for key, value in changes.items()})


@pytest.fixture(scope="module")
def joined(tmp_path_factory):
    """File of two bodies that share the nodes of their joint."""
    return write_blocks(tmp_path_factory.mktemp("joined") / "joined.msh", glued=True, size=12.0)


def test_shared_nodes_are_split(joined):
    """requirement: bodies of one fragment are apart, and each has its own side of their joint."""
    mesh = tw.load(blocks(joined)).tagged_mesh()
    owners = [
        set(mesh.cells[mesh.cell_tags == mesh.bodies.index(name) + 1].ravel())
        for name in ("pad", "disk")
    ]
    assert not owners[0] & owners[1]
    face, track = (mesh.facets_of(name) for name in ("face", "track"))
    assert len(face) == len(track) > 0
    assert set(face.ravel()) <= owners[0]
    assert set(track.ravel()) <= owners[1]
    places = [np.unique(mesh.points[of].reshape(-1, 3), axis=0) for of in (face, track)]
    np.testing.assert_allclose(*places)
    sizes = [np.ptp(mesh.points[list(own)], axis=0) for own in owners]
    np.testing.assert_allclose(sizes, 1e-3 * np.array([PAD, DISK]), rtol=1e-9)


def test_a_case_written_and_read_again_is_the_same(joined):
    """requirement: the resolved case has the keys of the file, and gives the same case."""
    from thermowear.case.tables.schema import as_plain

    case = tw.load(blocks(joined))
    assert tw.load(as_plain(case)) == case
    assert case.geometry.surfaces == ("face", "back", "track", "bottom")
    assert [case.geometry.body_of(name) for name in case.geometry.surfaces] == [
        *("pad", "pad", "disk", "disk")
    ]


def test_a_pair_gives_the_numbers_of_the_pair_geometry(joined):
    """requirement: the same bodies, as an assembly and as a pair, have the same pressure."""
    assembly = tw.run(tw.load(blocks(joined)))
    pair = blocks(joined)
    for key in ("contacts", "holders", "motions"):
        del pair[key]
    del pair["bodies"]["disk"]["fixed"]
    pair["geometry"] |= {"contact": ["face", "track"], "held": "back", "fixed": "bottom"}
    pair["geometry"]["surfaces"] = {k: v for names in NAMED.values() for k, v in names.items()}
    pair |= {"load": {"force": "100 N"}, "motion": {"velocity": "1 m/s"}}
    expected = tw.run(tw.load(pair))
    scale = expected.interface.pressure.max()
    np.testing.assert_allclose(
        assembly.interface.pressure, expected.interface.pressure, 0.0, 1e-9 * scale
    )
    size = np.ptp(expected.interface.shape)
    np.testing.assert_allclose(assembly.interface.shape, expected.interface.shape, 0.0, 1e-6 * size)


def test_a_file_for_each_body_with_the_same_names(tmp_path):
    """requirement: bodies in files of their own, in a section."""
    mesh = two_blocks()
    for name in ("upper", "lower"):
        write_mesh(mesh, tmp_path / f"{name}.inp")
    case = {
        "model": "plane-strain",
        "geometry": {
            "type": "file",
            "paths": {name: str(tmp_path / f"{name}.inp") for name in ("upper", "lower")},
            "thickness": "10 mm",
            "bodies": {"upper": "upper", "lower": "lower"},
            "surfaces": {
                "upper": ["upper_face", "upper_end"],
                "lower": ["lower_face", "lower_end"],
            },
        },
        "mesh": {"degree": 2},
        "bodies": {"upper": STEEL, "lower": STEEL | {"fixed": "lower_end"}},
        "contacts": {"middle": {"between": ["upper_face", "lower_face"]}},
        "holders": {"press": {"surface": "upper_end", "force": "1 kN"}},
        "analysis": {"type": "initial"},
    }
    result = tw.run(tw.load(case))
    mean = result.summary["contacts"]["middle"]["mean_pressure_Pa"]
    assert mean == pytest.approx(1000.0 / (0.04 * 0.01), rel=1e-9)


def test_materials_by_cell_set(tmp_path):
    """requirement: cell sets of a body have their own materials, and each cell has one."""
    file = layered_blocks(tmp_path / "layers.msh")
    soft = {"young_modulus": "1 GPa", "poisson_ratio": 0.3}
    case = blocks(file, geometry__bodies={"pad": ["PAD", "CORE"], "disk": "DISK"})
    case["geometry"]["surfaces"]["disk"]["track"] = "TRACK"
    case["bodies"]["pad"] = {
        "materials": {"PAD": STEEL, "CORE": soft},
    }
    loaded = tw.load(case)
    assert loaded.tagged_mesh().bodies == ("pad", "disk", "pad.PAD", "pad.CORE")
    from thermowear.simulation.from_case import model_of

    materials = model_of(loaded).bodies[0].materials
    assert materials["pad.CORE"].young_modulus == 1e9
    assert materials["pad.PAD"].young_modulus == 200e9
    with pytest.raises(tw.CaseError, match=r"bodies\.pad\.young_modulus: missing; cells of 'CORE'"):
        tw.load(changed(case, {"bodies.pad.materials": {"PAD": STEEL}}))


def test_a_face_of_two_materials(tmp_path):
    """requirement: parts of a face wear by laws of their own, all as one body.

    By hand: on a level face of one speed ``k p`` is uniform, so that the pressures of the halves
    are in the ratio of the coefficients, and their mean is the force over the area.
    """
    file = layered_blocks(tmp_path / "layers.msh")
    case = blocks(file, geometry__bodies={"pad": ["PAD", "CORE"], "disk": "DISK"})
    case["geometry"]["surfaces"]["disk"]["track"] = "TRACK"
    laws = {
        name: {"coefficient": f"{k}e-8 1/MPa", "per": "pressure"}
        for name, k in (("PAD", 1), ("CORE", 3))
    }
    case["wear"] = {"pad": {"materials": laws}}
    found = tw.run(tw.load(case)).interface
    left = found.x < -1e-9
    right = found.x > 1e-9
    mean = 100.0 / (20e-3 * 20e-3)
    np.testing.assert_allclose(found.pressure[left], 1.5 * mean, rtol=1e-9)
    np.testing.assert_allclose(found.pressure[right], 0.5 * mean, rtol=1e-9)
    assert tw.load(changed(case, {"contact.friction": 0.0})).wear
    del case["wear"]["pad"]["materials"]["CORE"]
    with pytest.raises(tw.CaseError, match=r"^wear\.pad"):
        tw.run(tw.load(case))


def layered_blocks(path):
    """A pad of two halves that share their nodes, on a block."""
    with gmsh_model("layers") as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        halves = [occ.addBox(x, -10, 0, 10, 20, 10) for x in (-10, 0)]
        occ.fragment([(3, halves[0])], [(3, halves[1])])
        disk = occ.addBox(-20, -20, -10, 40, 40, 10)
        occ.synchronize()
        groups = {"FACE": [], "PAD_BACK": [], "DISK_BOTTOM": [], "TRACK": []}
        for _, tag in model.getEntities(2):
            owner, z = list(model.getAdjacencies(2, tag)[0]), occ.getCenterOfMass(2, tag)[2]
            levels = {10: "PAD_BACK", -10: "DISK_BOTTOM", 0: "TRACK" if disk in owner else "FACE"}
            name = next((n for level, n in levels.items() if math.isclose(z, level)), None)
            if abs(z) < 1e-9:
                name = levels[0]
            if name is not None:
                groups[name].append(tag)
        for name, tag in (("PAD", halves[0]), ("CORE", halves[1]), ("DISK", disk)):
            model.addPhysicalGroup(3, [tag], name=name)
        for name, tags in groups.items():
            model.addPhysicalGroup(2, tags, name=name)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 10)
        model.mesh.generate(3)
        gmsh.write(str(path))
    return path


FAULTS = {
    "one body": ({"geometry.bodies": {"pad": "PAD"}}, "geometry.bodies: needs two or more"),
    "both files": ({"geometry.paths": {"pad": "a.msh"}}, "geometry.paths: only one of path and"),
    "thickness": ({"geometry.thickness": "1 mm"}, "geometry.thickness: requires a plane model"),
    "names": (
        {"geometry.surfaces": {"pad": ["FACE", "PAD_BACK"], "disk": ["FACE", "DISK_BOTTOM"]}},
        "geometry.surfaces.disk: 'FACE' is a surface of pad, too; give it a name of its own",
    ),
    "body of names": (
        {"geometry.surfaces.plate": ["X"]},
        "geometry.surfaces.plate: unknown body; must be one of: pad, disk",
    ),
    "not in the file": (
        {"geometry.surfaces.pad.face": "NOSE"},
        "geometry.surfaces.pad: the file has no surface named 'NOSE'",
    ),
    "another body's": (
        {"geometry.surfaces.pad.face": "DISK_BOTTOM"},
        "geometry.surfaces.pad: 'DISK_BOTTOM' is not on the boundary of body 'pad'",
    ),
    "held face": (
        {"holders.arm.surface": "face"},
        "holders.arm.surface: 'face' is a face of contacts.rubbing",
    ),
    "clamped face": (
        {"bodies.disk.fixed": ["track"]},
        "bodies.disk.fixed: 'track' is a face of contacts.rubbing",
    ),
    "support of another": (
        {"bodies.disk.rollers": ["back"]},
        "bodies.disk.rollers: 'back' is a surface of pad",
    ),
    "pressed face": (
        {"load.pressure": {"track": "1 MPa"}},
        "load.pressure: 'track' is a face of contacts.rubbing",
    ),
    "facing away": (
        {"contacts.rubbing.between": ["back", "track"], "holders.arm.surface": "face"},
        "contacts.rubbing.between: 'track' does not face 'back'",
    ),
    "plane": (
        {"bodies.disk.symmetry": ["bottom"], "motions.disk": {"angular_velocity": "1 rad/s"}},
        "bodies.disk.symmetry: 'bottom' does not lie in a plane x = const",
    ),
    "sliding across a plane": (
        {"bodies.disk.symmetry": ["bottom"]},
        "bodies.disk.symmetry: sliding friction along x is not symmetric",
    ),
    "two names of a facet": (
        {"geometry.surfaces.pad.again": "FACE"},
        "geometry.surfaces: 'face' and 'again' share",
    ),
    "same cells": (
        {
            "geometry.bodies.disk": "PAD",
            "geometry.surfaces.disk": {"track": "FACE", "bottom": "PAD_BACK"},
        },
        "cells are in both 'PAD' and 'PAD'",
    ),
    "wrong unit": ({"geometry.length_unit": "1 um"}, "holders.arm.force: a mean pressure of"),
    "wrong unit of a way": (
        {
            "holders.arm": {"surface": "back", "approach": "20 mm"},
            "analysis": {"type": "initial"},
        },
        "holders.arm.approach: 20 mm is",
    ),
    "unknown set": (
        {"bodies.pad": {"materials": {"X": STEEL}} | STEEL},
        "bodies.pad.materials.X: the file has no cells named 'X'",
    ),
    "no holder": ({"holders": {}}, "holders: nothing is pressed"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults(joined, fault, capsys):
    """requirement: one line, at the key."""
    changes, expected = FAULTS[fault]
    case = changed(blocks(joined), changes)
    with pytest.raises(tw.CaseError) as error:
        tw.load(case).tagged_mesh()
    lines = [line for line in str(error.value).splitlines() if line.strip()]
    assert any(expected in line for line in lines), lines
    assert len(lines) == 1, lines


@pytest.mark.parametrize(("moved", "expected"), [(-5.0, "overlap by 5 mm"), (20.0, "lie 20 mm")])
def test_bodies_apart(tmp_path, moved, expected):
    """requirement: bodies that overlap or lie apart are refused with the distance."""
    mesh = two_solids(tmp_path, moved)
    with pytest.raises(tw.CaseError, match=rf"^contacts\.rubbing\.between: .*{expected}"):
        tw.load(mesh).tagged_mesh()


def test_glued_faces_touch(tmp_path):
    """requirement: glued faces with a gap are refused."""
    case = tw.load(two_solids(tmp_path, 1.0))
    glued = case.contacts["rubbing"].model_copy(update={"tie": True})
    case = case.model_copy(update={"contacts": {"glue": glued}})
    with pytest.raises(tw.CaseError, match=r"^contacts\.glue\.between: the glued faces lie 1 mm"):
        case.tagged_mesh()


def notes_on(case):
    """Notes on the mesh of a case."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", CaseNote)
        tw.load(case).tagged_mesh()
    return [str(one.message) for one in found]


def test_a_lower_body_that_is_pressed(joined):
    """requirement: the default direction is named where it points away from the contacts."""
    lower = {
        "bodies": {"pad": STEEL | {"fixed": "back"}, "disk": STEEL},
        "holders": {"arm": {"surface": "bottom", "force": "100 N"}},
    }
    (found,) = notes_on(blocks(joined) | lower)
    assert found == (
        "holders.arm: presses 'disk' along -z by default, away from its contacts; towards them "
        "with direction = [0.0, 0.0, 1.0]"
    )
    upwards = changed(lower, {"holders.arm.direction": [0.0, 0.0, 1.0]})
    assert notes_on(blocks(joined) | upwards) == notes_on(blocks(joined)) == []


def test_several_bodies_of_a_wrong_unit(joined):
    """requirement: bodies of some metres under a small force ask for the unit, twice."""
    found = notes_on(blocks(joined, geometry__length_unit="1 m", holders__arm__force="1 mN"))
    assert [line.split(":")[0] for line in found] == [
        *(2 * ["geometry.length_unit"]),
        "holders.arm.force",
    ]
    assert all(line.endswith("wrong length_unit?") for line in found)


def test_a_surface_of_the_file_that_is_not_listed(tmp_path, joined):
    """requirement: a name in the file is said to be there, and where to list it."""
    named = {body: dict(names) for body, names in NAMED.items()}
    del named["disk"]["bottom"]
    case = blocks(joined, geometry__surfaces=named, bodies__disk__fixed="DISK_BOTTOM")
    with pytest.raises(tw.CaseError) as found:
        tw.load(case)
    assert found.value.faults == [
        "bodies.disk.fixed: found 'DISK_BOTTOM'; in the file, but not listed: add it to "
        "geometry.surfaces.BODY"
    ]


def two_solids(folder, moved):
    """The pad and the block in files of their own, the pad moved upwards [mm]."""
    file = write_blocks(folder / "block.msh", size=12.0)
    with gmsh_model("moved") as gmsh:
        gmsh.open(str(file))
        gmsh.model.mesh.affineTransform([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, moved])
        gmsh.write(str(folder / "pad.msh"))
    case = blocks(file)
    del case["geometry"]["path"]
    case["geometry"]["paths"] = {"pad": str(folder / "pad.msh"), "disk": str(file)}
    case["geometry"]["surfaces"] = {
        "pad": {"face": "PAD_FACE", "back": "PAD_BACK"},
        "disk": {"track": "DISK_FACE", "bottom": "DISK_BOTTOM"},
    }
    return case


def test_bodies_drawn_into_each_other(tmp_path):
    """requirement: a pressed holder that ends far behind where it was drawn is no result."""
    case = changed(two_solids(tmp_path, -0.2), {"analysis": {"type": "initial"}})
    result = tw.run(tw.load(case))
    assert "the holder ends 0.0002 m behind where it was drawn" in str(result.stopped)


def test_validate_describes_all_bodies(joined, tmp_path, capsys):
    """requirement: `validate` reads the file and prints the size of each body."""
    import tomli_w

    path = tmp_path / "case.toml"
    path.write_text(tomli_w.dumps(blocks(joined)))
    assert main(["validate", str(path)]) == 0
    said = capsys.readouterr().out
    assert "pad 20 mm by 30 mm by 10 mm" in said
    assert "disk 40 mm by 50 mm by 15 mm" in said


def test_the_mesh_of_the_starter(tmp_path):
    """requirement: the mesh beside the starter is the one that its script makes."""
    import meshio

    made = meshio.read(write_rings(tmp_path / "made.msh", starter_rings()))
    kept = meshio.read(STARTER_MESH)
    ordered = [of.points[np.lexsort(np.round(of.points.T, 6))] for of in (made, kept)]
    np.testing.assert_allclose(*ordered, atol=1e-6)
    assert set(kept.field_data) == set(made.field_data)
