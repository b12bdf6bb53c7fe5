"""Bodies from CAD files: solids, faces and contact faces by all their ways, sizes, and refusals."""

import math
import random
from functools import partial

import numpy as np
import pytest
from pydantic import ValidationError

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.section import MODEL
from thermowear.errors import CaseError
from thermowear.geometry.from_cad import meshing_process
from thermowear.geometry.geometries.solids.cad_assembly import CadAssembly
from thermowear.geometry.geometries.solids.cad_file import CadFile
from thermowear.geometry.mesh.tagged import scaled_jacobians

from ..cad_parts import PAD, PLATE, UNITS, bush, cad_pad, write, write_blocks
from .test_solid_files import outward, volume

BACK, BOTTOM = {"point": ["3 mm", "4 mm", "10 mm"]}, {"plane": "z", "at": "-15 mm"}
KEYS = {
    "type": "cad",
    "held": "back",
    "fixed": "bottom",
    "surfaces": {"back": BACK, "bottom": BOTTOM},
}


def geometry(keys, kind=CadFile):
    return kind.model_validate(keys, context={MODEL: "3d"})


def meshed(keys, **sizes):
    return geometry(KEYS | keys).build(MeshTable(size="8 mm", **sizes), None)


def refusal(keys, **sizes):
    with pytest.raises(CaseError) as found:
        meshed(keys, **sizes)
    (line,) = found.value.faults
    assert "\n" not in line
    return line


@pytest.fixture(scope="module")
def blocks(tmp_path_factory):
    return write_blocks(tmp_path_factory.mktemp("blocks"))


@pytest.fixture(scope="module")
def starter(tmp_path_factory):
    """STEP files of the starter, drawn anew."""
    folder, script = tmp_path_factory.mktemp("starter"), cad_pad()
    script.write(folder / "pad.step", script.draw_pad, ["LINING", "PLATE"])
    script.write(folder / "disk.step", script.draw_disk, ["DISK"])
    return folder


def check_blocks(mesh, unit=1e-3):
    pad, plate = (np.array(size) * unit for size in (PAD, PLATE))
    assert mesh.bodies == ("pad", "plate")
    assert mesh.order == 2
    assert volume(mesh, "pad") == pytest.approx(pad.prod(), rel=1e-9)
    assert volume(mesh, "plate") == pytest.approx(plate.prod(), rel=1e-9)
    assert scaled_jacobians(mesh).min() > 0.05
    areas = {"pad_face": -pad[0] * pad[1], "plate_face": plate[0] * plate[1]}
    areas |= {"back": pad[0] * pad[1], "bottom": -plate[0] * plate[1]}
    for surface, area in areas.items():
        assert outward(mesh, surface) == pytest.approx([0, 0, area], rel=1e-9, abs=1e-9 * unit**2)


def test_faces_by_point_and_plane_and_contact_found(blocks):
    """requirement: volumes and areas are those of the drawing, with outward normals."""
    check_blocks(meshed({"paths": blocks}))


@pytest.mark.parametrize("unit", UNITS)
def test_the_unit_of_a_step_file(unit, tmp_path):
    """requirement: lengths of files in millimetres, metres and inches come in metres."""
    size = UNITS[unit][2]
    surfaces = {
        "back": {"point": [f"{x * size} m" for x in (3, 4, 10)]},
        "bottom": {"plane": "z", "at": f"{-15 * size} m"},
    }
    keys = KEYS | {"paths": write_blocks(tmp_path, unit), "surfaces": surfaces}
    check_blocks(geometry(keys).build(MeshTable(size=f"{8 * size} m"), None), size)


def test_the_unit_of_a_brep_file(tmp_path):
    """requirement: a BREP file has no unit, the case has it; a STEP file has its own."""
    files = write_blocks(tmp_path, ending=".brep")
    check_blocks(meshed({"paths": files, "length_unit": "1 mm"}))
    surfaces = {"back": {"plane": "z", "at": "10 m"}, "bottom": {"plane": "z", "at": "-15 m"}}
    keys = KEYS | {"paths": files, "length_unit": "1 m", "surfaces": surfaces}
    check_blocks(geometry(keys).build(MeshTable(size="8 m"), None), 1.0)
    with pytest.raises(ValueError, match="a BREP file has no unit"):
        geometry(KEYS | {"paths": files})
    with pytest.raises(ValueError, match="STEP files have a unit of their own"):
        geometry(KEYS | {"paths": {"a": "a.step", "b": "b.step"}, "length_unit": "1 mm"})


def test_one_file_of_all_bodies(tmp_path):
    """requirement: solids are named by a point inside; the same mesh as of a file each."""
    files = write_blocks(tmp_path)
    script = cad_pad()
    both = write(
        tmp_path / "both.step",
        lambda occ: occ.addBox(-PAD[0] / 2, -PAD[1] / 2, 0, *PAD),
        lambda occ: occ.addBox(-PLATE[0] / 2, -PLATE[1] / 2, -PLATE[2], *PLATE),
    )
    inside = {"pad": {"point": ["0 mm", "0 mm", "5 mm"]}}
    inside |= {"plate": {"point": ["0 mm", "0 mm", "-5 mm"]}}
    by_point = meshed({"path": str(both), "bodies": inside})
    check_blocks(by_point)
    both.write_text(script.labelled(both.read_text(), ["PAD", "PLATE"], [""] * 12))
    by_label = meshed({"path": str(both), "bodies": {"pad": "PAD", "plate": ["PLATE"]}})
    assert by_label.checksum() == by_point.checksum()
    assert volume(meshed({"paths": files}), "pad") == pytest.approx(volume(by_label, "pad"))
    line = refusal({"path": str(both), "bodies": {"pad": "PAD", "plate": "DISK"}})
    assert line.startswith("geometry.bodies.plate: ")
    assert "no solid labelled 'DISK'; it has 2 solids; labels: PAD, PLATE" in line
    inside["plate"] = {"point": ["0 mm", "0 mm", "0 mm"]}
    line = refusal({"path": str(both), "bodies": inside})
    assert line == "geometry.bodies.plate: the point lies on 2 solids; name one inside one"
    line = refusal({"path": str(both), "bodies": {"pad": "PAD", "plate": "PAD"}})
    assert "the solid 'PAD' of" in line
    assert "is 'pad' already" in line


def test_the_same_mesh_each_time(blocks, monkeypatch):
    """requirement: meshing is deterministic; an equal request and file are not meshed again."""
    keys, runs = {"paths": blocks}, []
    run = meshing_process._run
    monkeypatch.setattr(meshing_process, "_run", lambda *of: runs.append(of) or run(*of))
    meshing_process._meshed.cache_clear()
    first = meshed(keys).checksum()
    assert meshed(keys).checksum() == first
    assert len(runs) == 1
    meshing_process._meshed.cache_clear()
    assert meshed(keys).checksum() == first
    assert len(runs) == 2


def sizes_of(mesh, body):
    """Centres of the cells of a body [mm], and their edges: the cube root of six volumes [mm]."""
    corners = 1e3 * mesh.points[mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1][:, :4]]
    edges = corners[:, 1:] - corners[:, :1]
    return corners.mean(axis=1), np.abs(np.linalg.det(edges) * math.sqrt(2)) ** (1 / 3)


def test_sizes(blocks):
    """requirement: small elements at the contact and smaller ones at its edge, large ones far."""
    mesh = meshed({"paths": blocks}, contact_size="2 mm", grading=0.5)
    places, sizes = sizes_of(mesh, "plate")
    x, y, depth = np.abs(places[:, 0]), np.abs(places[:, 1]), -places[:, 2]
    shallow = depth < 1.5
    within = shallow & (x < 6) & (y < 11)
    edge = shallow & (np.abs(x - 10) < 1) & (y < 14)
    far = (depth > 10) | (x > 17) | (y > 22)
    assert np.median(sizes[within]) == pytest.approx(2.0, rel=0.25)
    assert np.median(sizes[edge]) == pytest.approx(1.1, rel=0.3)
    assert np.median(sizes[far]) > 3.5
    own = meshed({"paths": blocks}, contact_size="2 mm", bodies={"pad": {"contact_size": "6 mm"}})
    assert len(sizes_of(own, "pad")[1]) < len(sizes_of(mesh, "pad")[1]) / 2
    line = refusal({"paths": blocks}, contact_size="0.05 mm")
    assert line.startswith("mesh.size: the sizes lead to about ")


def _round(occ, radius=5.0, across=None):
    """Cap of a sphere on the origin, or of a barrel with the other radius along x."""
    box = occ.addBox(-1.5, -1.5, -1.0, 3, 3, 2)
    if across is None:
        whole = occ.addSphere(0, 0, radius, radius)
    else:
        whole = occ.addTorus(0, 0, radius, radius - across, across)
        occ.rotate([(3, whole)], 0, 0, radius, 1, 0, 0, math.pi / 2)
    occ.intersect([(3, whole)], [(3, box)])


def _roller(occ, length=2.0):
    whole = occ.addCylinder(-length / 2, 0, 5, length, 0, 0, 5)
    occ.intersect([(3, whole)], [(3, occ.addBox(-3, -1.5, -1, 6, 3, 2))])


def _filleted(occ):
    box = occ.addBox(-1.5, -1.5, 0, 3, 3, 1)
    occ.synchronize()
    centres = {tag: occ.getCenterOfMass(1, tag) for _, tag in occ.getEntities(1)}
    low = [tag for tag, (x, _, z) in centres.items() if z < 1e-6 and abs(x) > 1]
    occ.fillet([box], low, [0.4])


def _ring(occ):
    whole = occ.addTorus(0, 0, 1.0, 1.5, 1.0)
    occ.intersect([(3, whole)], [(3, occ.addBox(-3, -3, -1, 6, 6, 2))])


def _flat(occ):
    occ.addBox(-2, -2, -2, 4, 4, 2)


def _grooved(occ, radius=6.0):
    cut = occ.addCylinder(-3, 0, radius - 0.1, 6, 0, 0, radius)
    occ.cut([(3, occ.addBox(-2, -2, -2, 4, 4, 2))], [(3, cut)])


E_STAR = 210e9 / (2 * (1 - 0.3**2))
HERTZ = (3 * 10.0 * 5e-3 / (4 * E_STAR)) ** (1 / 3)
"""Radius of the contact of a ball of 5 mm under 10 N."""


ORIGIN = ((0.0, 0.0, 0.0),)
HALVES = (0.0, 0.5, 0.0505), (0.0, -0.5, 0.0505)


def line(radius):
    """Half-width of the contact of a roller of 2 mm under 10 N."""
    return math.sqrt(4 * 5e3 * radius / (math.pi * E_STAR))


def case_of(folder, draw, below=_flat, lowest=0.0, chosen=ORIGIN, **tables):
    """Case of a part that 10 N press on another one, with faces at points of the upper part."""
    paths = {
        name: str(write(folder / f"{name}.step", drawing))
        for name, drawing in (("upper", draw), ("lower", below))
    }
    points = [{"point": [f"{x} mm" for x in place], "body": "upper"} for place in chosen]
    low = {"point": ["0 mm", "0 mm", f"{lowest} mm"], "body": "lower"}
    surfaces = {"on": points, "under": low, "back": {"plane": "z", "at": "1 mm"}}
    surfaces["bottom"] = {"plane": "z", "at": "-2 mm"}
    steel = {"young_modulus": "210 GPa", "poisson_ratio": 0.3}
    given = {
        "model": "3d",
        "geometry": KEYS
        | {"paths": paths, "contact": ["on", "under"], "surfaces": surfaces}
        | {"held": "back", "fixed": "bottom"},
        "mesh": {"degree": 2},
        "bodies": {"upper": steel, "lower": steel},
        "load": {"force": "10 N"},
        "analysis": {"type": "initial"},
    }
    return tw.load(given | tables)


def zones_of(*args, **tables):
    return case_of(*args, **tables).meshed_geometry._zones


@pytest.mark.parametrize(
    ("draw", "below", "lowest", "on", "length", "width"),
    [
        (_round, _flat, 0.0, ORIGIN, HERTZ, HERTZ),
        # by the elliptic integrals of Johnson (4.26) to (4.28)
        (partial(_round, across=2.5), _flat, 0.0, HALVES, 7.663e-5, 4.832e-5),
        (_roller, _flat, 0.0, ORIGIN, 1e-3, line(5e-3)),
        (_roller, _grooved, -0.1, ORIGIN, 1e-3, line(30e-3)),
    ],
)
def test_the_zone_that_a_load_closes(draw, below, lowest, on, length, width, tmp_path):
    """requirement: half-axes of Hertz's contact of the curvatures that remain between both faces,
    at their closest points; a roller touches all along.
    """
    (zone,) = zones_of(tmp_path, draw, below, lowest, on)
    assert zone.length == pytest.approx(length, rel=0.01)
    assert zone.width == pytest.approx(width, rel=0.01)
    centres = np.array(zone.centres)
    np.testing.assert_allclose(centres, [[0, 0, 0], [0, 0, 1e-3 * lowest]], atol=1e-9)
    if length > width:
        assert np.abs(zone.along) == pytest.approx([1, 0, 0], abs=1e-6)


def test_faces_that_conform_have_no_zone(tmp_path):
    """requirement: none for a block with rounded edges, a roller in a bed of its radius, wear that
    goes on for ever, nor for element sizes that are given; a ring that touches along a circle has
    none either.
    """
    rounded = (0.0, 0.0, 0.0), (1.383, 0.0, 0.117), (-1.383, 0.0, 0.117)
    assert not zones_of(tmp_path, _filleted, chosen=rounded)
    assert not zones_of(tmp_path, _roller, partial(_grooved, radius=5.0), -0.1)
    assert not zones_of(tmp_path, _ring, chosen=((1.5, 0.0, 0.0),))
    wear = {"upper": {"coefficient": "1e-8 1/MPa", "per": "pressure"}}
    moving = {"wear": wear, "motion": {"velocity": "1 m/s"}, "analysis": {"type": "steady"}}
    assert not zones_of(tmp_path, _round, **moving)
    assert not zones_of(tmp_path, _round, mesh={"degree": 2, "contact_size": "0.2 mm"})
    assert zones_of(tmp_path, _round, mesh={"degree": 2, "size": "0.4 mm"})


def test_supports_share_the_load(tmp_path):
    """requirement: each of three balls under a plate bears a third of the load."""
    places = (1.0, 0.0, 0.0), (-0.6, 0.9, 0.0), (-0.6, -0.9, 0.0)

    def draw(occ):
        balls = [(3, occ.addSphere(x, y, 0.5, 0.5)) for x, y, _ in places]
        occ.fuse([(3, occ.addBox(-1.5, -1.5, 0.3, 3, 3, 0.7))], balls)

    found = zones_of(tmp_path, draw, chosen=places)
    np.testing.assert_allclose([z.width for z in found], HERTZ * (0.1 / 3) ** (1 / 3), rtol=0.01)
    near = np.array([zone.centres[0] for zone in found])
    for place in places:
        assert np.linalg.norm(1e3 * near - place, axis=1).min() < 1e-3


def test_a_force_of_a_holder_of_an_assembly(tmp_path):
    """requirement: several bodies have the zones of a pair."""
    pair = case_of(tmp_path, _round)
    tables = {
        "model": "3d",
        "geometry": {
            "type": "cad",
            "paths": pair.geometry.paths,
            "surfaces": {
                "upper": {"on": {"point": ["0 mm"] * 3}, "back": {"plane": "z", "at": "1 mm"}},
                "lower": {
                    "under": {"point": ["0 mm"] * 3},
                    "bottom": {"plane": "z", "at": "-2 mm"},
                },
            },
        },
        "mesh": {"degree": 2},
        "bodies": {
            "upper": pair.bodies["upper"].model_dump(exclude_none=True),
            "lower": {"like": "upper", "fixed": "bottom"},
        },
        "contacts": {"ball": {"between": ["on", "under"]}},
        "holders": {"press": {"surface": "back", "force": "10 N"}},
        "analysis": {"type": "initial"},
    }
    assert tw.load(tables).meshed_geometry._zones == pair.meshed_geometry._zones


@pytest.mark.slow
def test_the_default_mesh_resolves_the_contact_of_a_ball(tmp_path):
    """requirement: the largest pressure is Hertz's within 3 %, and the mesh is affordable."""
    case = case_of(tmp_path, _round)
    summary = tw.run(case).summary
    assert summary["max_pressure_Pa"] == pytest.approx(15.0 / (math.pi * HERTZ**2), rel=0.03)
    assert summary["dofs_displacement"] < 200_000


def test_labels_of_faces(starter):
    """requirement: faces are named by their labels in the file, several faces by one label."""
    keys = {
        "type": "cad",
        "paths": {"plate": str(starter / "pad.step"), "disk": str(starter / "disk.step")},
        "bodies": {"plate": "PLATE"},
        "contact": ["below", "top"],
        "held": "PISTON",
        "fixed": "DISK_INSIDE",
        "surfaces": {
            "below": {"plane": [0.0, 0.0, -2.0], "at": "-11 mm"},
            "top": [{"plane": "z", "at": "0 mm", "body": "disk"}],
            "back": {"label": "PLATE_BACK"},
        },
    }
    mesh = geometry(keys).build(MeshTable(size="12 mm", grading=1.0), None)
    script = cad_pad()
    (inner, outer, half, _), radius = script.PLATE, script.PISTON[1]
    whole, piston = math.radians(half) * (outer**2 - inner**2), math.pi * radius**2
    assert 1e6 * outward(mesh, "PISTON")[2] == pytest.approx(piston, rel=1e-3)
    assert 1e6 * outward(mesh, "back")[2] == pytest.approx(whole - piston, rel=1e-3)
    assert 1e6 * outward(mesh, "below")[2] == pytest.approx(-whole, rel=1e-4)
    inner, outer, thick = script.DISK
    area = math.pi * (outer**2 - inner**2)
    assert 1e6 * outward(mesh, "top")[2] == pytest.approx(area, rel=1e-4)
    assert 1e9 * volume(mesh, "disk") == pytest.approx(area * thick, rel=1e-4)
    keys["held"] = "PISTONS"
    with pytest.raises(CaseError) as found:
        geometry(keys).build(MeshTable(size="12 mm"), None)
    assert str(found.value) == (
        "geometry.held: no face labelled 'PISTONS'; 'plate' has 7 faces; labels: PISTON, "
        'PLATE_BACK; a face is also named by { point = ["0 mm", "0 mm", "5 mm"] } or { plane = "z"'
        ", at = \"5 mm\" }; geometry.held needs a surface of the first body, 'plate'"
    )


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        (
            {"point": ["10 mm", "2 mm", "10 mm"]},
            "2 faces are equally near the point (10, 2, 10) mm: face of 'pad' of 300 mm² about "
            "(10, 0, 5) mm, face of 'pad' of 600 mm² about (0, 0, 10) mm; name a point inside one",
        ),
        (
            {"point": ["3 mm", "2 mm", "12 mm"]},
            "no face near the point (3, 2, 12) mm; the nearest one is the face of 'pad' of 600 mm² "
            "about (0, 0, 10) mm, 2 mm away; 'pad' has 6 faces",
        ),
        (
            {"plane": "z", "at": "9 mm"},
            "no face in the plane at 9 mm; 'pad' has 6 faces, parallel to this plane at 0, 10 mm",
        ),
        (
            {"plane": [1.0, 0.0, 1.0], "at": "9 mm"},
            "no face in the plane at 9 mm; 'pad' has 6 faces, parallel to this plane nowhere",
        ),
        ("BACK", "no face labelled 'BACK'; 'pad' has 6 faces; none of them has a label"),
        ({"label": "A", "body": "plate"}, "body: this surface belongs to another body"),
        ({"label": "A", "body": "disk"}, "body: unknown body; must be one of: pad, plate"),
    ],
)
def test_missing_and_ambiguous_faces(choice, words, blocks):
    """requirement: one line with the faces that there are."""
    line = refusal({"paths": blocks, "surfaces": {"back": choice, "bottom": BOTTOM}})
    assert line.startswith("geometry.surfaces.back")
    assert words in line
    of_role = "; geometry.held needs a surface of the first body, 'pad'" in line
    assert of_role is ("unknown body" not in line)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"surfaces": {"a": {}}}, "found none; needs one of: label, point, plane"),
        ({"surfaces": {"a": {"label": "b", "plane": "x", "at": "1 m"}}}, "found label and plane"),
        ({"surfaces": {"a": {"plane": "x"}}}, "a plane needs its distance"),
        ({"surfaces": {"a": {"label": "b", "at": "1 m"}}}, "requires a plane"),
        ({"surfaces": {"a": {"plane": [0.0, 0.0, 0.0], "at": "1 m"}}}, "no direction"),
        ({"surfaces": {"a": []}}, "found an empty list"),
        ({"surfaces": {"pad_face": "A"}}, 'is found by contact = "auto"'),
        ({"bodies": {"pad": []}}, "found an empty list"),
        ({"bodies": {"disk": "A"}}, "unknown body; must be one of: pad, plate"),
        ({"contact": ["a", "b"], "contact_tolerance": "1 mm"}, 'requires contact = "auto"'),
        ({"contact": "all"}, "auto"),
        ({"path": "a.step"}, "only one of path and paths"),
    ],
)
def test_inconsistent_keys(keys, words):
    """requirement: keys are checked before a file is read."""
    known = {"paths": {"pad": "a.step", "plate": "b.step"}}
    with pytest.raises(ValidationError) as found:
        geometry(KEYS | known | keys)
    assert words in str(found.value)


def test_bodies_apart(tmp_path):
    """requirement: bodies that do not touch are reported with their distance, unless allowed."""
    files = {
        "pad": str(write(tmp_path / "a.step", lambda o: o.addBox(-10, -15, 0.05, 20, 30, 10))),
        "plate": str(write(tmp_path / "b.step", lambda o: o.addBox(-20, -25, -15, 40, 50, 15))),
    }
    keys = {
        "paths": files,
        "surfaces": {"back": {"plane": "z", "at": "10.05 mm"}, "bottom": BOTTOM},
    }
    line = refusal(keys)
    assert "geometry.contact: 'pad' and 'plate' do not touch; they lie 0.05 mm apart" in line
    mesh = meshed(keys | {"contact_tolerance": "0.1 mm"})
    assert 1e6 * outward(mesh, "pad_face")[2] == pytest.approx(-PAD[0] * PAD[1])


def test_an_edge_on_a_face_is_no_contact(tmp_path):
    """requirement: bodies that touch along a line have no common faces."""

    def prism(occ):
        points = [occ.addPoint(x, -5, z) for x, z in ((0, 0), (8, 8), (-8, 8))]
        lines = [occ.addLine(points[k - 1], points[k]) for k in range(3)]
        occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(lines)]))], 0, 10, 0)

    files = {
        "pad": str(write(tmp_path / "a.step", prism)),
        "plate": str(write(tmp_path / "b.step", lambda o: o.addBox(-20, -25, -15, 40, 50, 15))),
    }
    line = refusal(
        {"paths": files, "surfaces": {"back": {"plane": "z", "at": "8 mm"}, "bottom": BOTTOM}}
    )
    assert "touch, but no faces of them coincide" in line


def test_faces_with_equal_normals_are_no_contact(tmp_path):
    """requirement: bodies lie on both sides of a contact face; sides that coincide are none."""
    files = {
        "pad": str(write(tmp_path / "a.step", lambda o: o.addBox(-20, -15, -3, 40, 30, 10))),
        "plate": str(write(tmp_path / "b.step", lambda o: o.addBox(-20, -25, -15, 40, 50, 15))),
    }
    back = {"plane": "z", "at": "7 mm"}
    line = refusal({"paths": files, "surfaces": {"back": back, "bottom": BOTTOM}})
    assert "touch, but no faces of them coincide" in line


def test_conforming_cylinders_touch(tmp_path):
    """requirement: curved faces are found, only those that touch; nodes lie on the cylinders."""
    files = {
        "shoe": str(write(tmp_path / "a.step", lambda occ: bush(occ, 30, 40, 40, 20))),
        "drum": str(write(tmp_path / "b.step", lambda occ: bush(occ, 40, 46, 70, 20))),
    }
    keys = {
        "type": "cad",
        "paths": files,
        "held": "inner",
        "fixed": "outer",
        "surfaces": {
            "inner": {"point": ["30 mm", "0 mm", "10 mm"]},
            "outer": {"point": ["46 mm", "0 mm", "10 mm"]},
        },
    }
    mesh = geometry(keys).build(MeshTable(size="8 mm", contact_size="4 mm", grading=1.0), None)
    for surface, radius, half in (("shoe_face", 40, 40), ("drum_face", 40, 70), ("inner", 30, 40)):
        facets = mesh.points[mesh.facets_of(surface)].reshape(-1, 3)
        assert np.hypot(facets[:, 0], facets[:, 1]) == pytest.approx(1e-3 * radius, rel=1e-6)
        way = 1 if surface == "shoe_face" else -1
        chord = 2 * 1e-3 * radius * math.sin(math.radians(half)) * 20e-3
        assert outward(mesh, surface) == pytest.approx([way * chord, 0, 0], rel=1e-3, abs=1e-9)
    area = math.radians(80) * (40**2 - 30**2) / 2
    assert 1e9 * volume(mesh, "shoe") == pytest.approx(area * 20, rel=1e-4)


def assembly(folder, **keys):
    """The lining, its plate and the disk of the starter."""
    pad = str(folder / "pad.step")
    return {
        "type": "cad",
        "paths": {"lining": pad, "plate": pad, "disk": str(folder / "disk.step")},
        "bodies": {"lining": "LINING", "plate": "PLATE"},
        "surfaces": {"plate": ["PISTON"], "disk": {"hub": "DISK_INSIDE"}},
    } | keys


@pytest.mark.slow
def test_pairs_of_bodies_that_touch(starter):
    """requirement: the contact of a slotted face with chamfers consists of both of its halves."""
    pairs = {"rubbing": ["lining", "disk"], "joint": ["plate", "lining"]}
    keys = assembly(starter, contact=pairs)
    bodies = geometry(keys, CadAssembly)
    assert bodies.contacts["rubbing"] == ("lining_rubbing", "disk_rubbing")
    assert bodies.body_of("plate_joint") == "plate"
    mesh = bodies.build(MeshTable(size="12 mm", grading=1.0))
    script = cad_pad()
    inner, outer, half, _ = script.LINING
    whole = math.radians(half) * (outer**2 - inner**2)
    assert 1e6 * outward(mesh, "lining_joint")[2] == pytest.approx(whole, rel=1e-4)
    # the chamfers are cut along the tangent at the ends, the slot along x
    points, weights = np.polynomial.legendre.leggauss(60)
    r = (outer + inner) / 2 + (outer - inner) / 2 * points
    ends = 2 * script.CHAMFER[0] * _along_ends(r, half, script.CHAMFER[0])
    lost = (outer - inner) / 2 * weights @ (ends + 2 * np.arcsin(script.SLOT[0] / 2 / r) * r)
    assert 1e6 * outward(mesh, "lining_rubbing")[2] == pytest.approx(lost - whole, rel=2e-3)
    automatic = geometry(assembly(starter, contact="auto"), CadAssembly)
    assert automatic.contacts == {
        "lining-plate": ("lining-plate", "plate-lining"),
        "lining-disk": ("lining-disk", "disk-lining"),
    }
    again = automatic.build(MeshTable(size="12 mm", grading=1.0))
    assert again.points == pytest.approx(mesh.points)
    assert outward(again, "disk-lining") == pytest.approx(outward(mesh, "disk_rubbing"))
    wrong = geometry(assembly(starter, contact={"a": ["plate", "disk"]}), CadAssembly)
    with pytest.raises(CaseError) as found:
        wrong.build(MeshTable(size="12 mm"))
    words = "geometry.contact.a: 'plate' and 'disk' do not touch; they lie 11 mm apart"
    assert str(found.value).startswith(words)


def _along_ends(r, half, long):
    """Length of the path of radius r through a chamfer, relative to that of the chamfer."""
    # the edge of the chamfer is parallel to the end of the sector, at the distance `long`
    return np.arcsin(np.minimum(long / r, 1.0)) * r / long


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"contact": {"a": ["lining", "rim"]}}, "found 'rim'; must be two of: lining, plate, disk"),
        ({"contact": {"a": ["disk", "disk"]}}, "must be two bodies that no other contact has"),
        (
            {"contact": {"a": ["disk", "plate"], "b": ["plate", "disk"]}},
            "must be two bodies that no other contact has",
        ),
        (
            {"contact": {"a": ["disk", "plate"]}, "surfaces": {"disk": {"disk_a": "B"}}},
            "has the name of a face that is found by contact",
        ),
        ({"contact_tolerance": "1 mm"}, "requires contact"),
        ({"surfaces": {"disk": ["A", "A"]}}, "names a surface twice"),
    ],
)
def test_inconsistent_keys_of_assemblies(keys, words, tmp_path):
    """requirement: keys are checked before a file is read."""
    with pytest.raises(ValidationError) as found:
        geometry(assembly(tmp_path) | keys, CadAssembly)
    assert words in str(found.value)


def test_solids_of_one_body_that_touch_are_refused(starter):
    """requirement: two solids that touch are not silently left apart in one body."""
    keys = assembly(starter, surfaces={}, contact={})
    keys["paths"] = {"pad": keys["paths"]["plate"], "disk": keys["paths"]["disk"]}
    keys["bodies"] = {}
    with pytest.raises(CaseError, match="the solids 'LINING' and 'PLATE' of 'pad' touch; unite"):
        geometry(keys, CadAssembly).build(MeshTable(size="12 mm"))


def test_malformed_files(blocks, tmp_path):
    """requirement: files that are no CAD, or refer to others, are refused in one line."""
    step = (tmp_path / "x.step", tmp_path / "y.txt", tmp_path / "z.brep")
    texts = {
        "system('rm -rf');\n": "it is not a STEP file: it begins with \"system('rm -rf');\"",
        "": "it is empty",
        "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n": "",
        "ISO-10303-21;\n#1=DOCUMENT_FILE('a.step');\n": "it refers to another file",
    }
    for text, words in texts.items():
        step[0].write_text(text)
        line = refusal({"paths": blocks | {"pad": str(step[0])}})
        assert line.startswith("geometry.paths.pad: ")
        assert words in line
    line = refusal({"paths": blocks | {"pad": str(step[1])}})
    assert "unknown file ending; must be one of: .step, .stp, .brep" in line
    line = refusal({"paths": blocks | {"pad": str(tmp_path / "none.step")}})
    assert "No such file" in line
    step[2].write_text("DBRep_DrawableShape\nCASCADE Topology V1, (c) Matra-Datavision\n7 7 7\n")
    line = refusal({"paths": blocks | {"pad": str(step[2])}, "length_unit": "1 mm"})
    assert line.startswith("geometry.paths.pad: ")


def test_coarse_meshes(starter):
    """requirement: elements larger than slots and thicknesses give a valid mesh."""
    keys = assembly(starter, contact={"joint": ["lining", "plate"]})
    for size in ("20 mm", "40 mm", "100 mm"):
        mesh = geometry(keys, CadAssembly).build(MeshTable(size=size, grading=1.0))
        assert scaled_jacobians(mesh).min() > 1e-3


PLACED = "#16 = CARTESIAN_POINT('',(0.,0.,0.));"


def test_labels_of_a_part_that_an_assembly_moves(starter, tmp_path):
    """requirement: labels of faces are found wherever the assembly places their part."""
    text = (starter / "disk.step").read_text() + (starter / "pad.step").read_text()
    assert PLACED in text
    moved = tmp_path / "pad.step"
    labelled = (
        (starter / "pad.step").read_text().replace("ADVANCED_FACE(''", "ADVANCED_FACE('A'", 1)
    )
    moved.write_text(labelled.replace(PLACED, PLACED.replace("0.,0.,0.", "0.,0.,-200.")))
    keys = assembly(starter, contact={}, surfaces={"lining": ["A"], "plate": ["PISTON"]})
    keys["paths"] |= {"lining": str(moved)}
    meshes = [geometry(keys, CadAssembly).build(MeshTable(size="20 mm", grading=1.0))]
    keys["paths"] |= {"lining": str(tmp_path / "still.step")}
    (tmp_path / "still.step").write_text(labelled)
    meshes.append(geometry(keys, CadAssembly).build(MeshTable(size="20 mm", grading=1.0)))
    low, high = (mesh.points[mesh.facets_of("A")].reshape(-1, 3) for mesh in meshes)
    assert low.min(axis=0) == pytest.approx(high.min(axis=0) - [0, 0, 0.2])
    assert low.max(axis=0) == pytest.approx(high.max(axis=0) - [0, 0, 0.2])


MUTATED = ((17, 3), (19, 1), (23, 2), (29, 0), (33, 1))
"""Seeds, and kinds of malformed files."""


@pytest.mark.parametrize(("seed", "kind"), MUTATED)
def test_malformed_steps_end_in_one_line(seed, kind, starter, tmp_path):
    """requirement: whatever OpenCASCADE makes of a file, there is a mesh or one line."""
    rng, path = random.Random(seed), tmp_path / "pad.step"
    lines = (starter / "pad.step").read_text().split(";\n")
    for _ in range(5):
        at, other = (rng.randrange(20, len(lines) - 3) for _ in range(2))
        number, _, entity = lines[at].partition("=")
        lines[at] = (
            f"{number}={lines[other].partition('=')[2]}",
            "",
            lines[at].replace("0.", "1.E9", 1),
            f"{number}={entity.replace('#', '#1', 1)}",
        )[kind]
    path.write_text(";\n".join(lines))
    keys = assembly(starter, surfaces={"disk": ["DISK_INSIDE"]}, contact={})
    keys["paths"] |= {"lining": str(path), "plate": str(path)}
    try:
        mesh = geometry(keys, CadAssembly).build(MeshTable(size="20 mm"))
    except CaseError as error:
        (line,) = error.faults
        assert "\n" not in line
        assert line.startswith(("geometry.", "mesh.size: "))
    else:
        assert scaled_jacobians(mesh).min() > 0


def test_a_crash_or_a_hang_ends_in_one_line(blocks, monkeypatch):
    """requirement: meshing runs in a process of its own, with limits of time and memory."""
    meshing_process._meshed.cache_clear()
    with monkeypatch.context() as patch:
        patch.setattr(meshing_process, "_SECONDS", 0.05)
        assert "took more than 0.05 s" in refusal({"paths": blocks})
    with monkeypatch.context() as patch:
        patch.setattr(meshing_process, "_MEMORY", 2**28)
        assert refusal({"paths": blocks}).startswith("geometry.paths.pad: ")


def test_a_number_of_elements_of_a_part_from_cad(tmp_path, monkeypatch):
    """requirement: mesh.elements has no effect there and is refused; sizes and grading have one."""
    monkeypatch.chdir(tmp_path)
    assert main(["init", "cad-pad"]) == 0
    with pytest.raises(CaseError) as found:
        tw.load("cad-pad.toml", ("mesh.elements=20", "mesh.bodies.disk.elements=8"))
    assert found.value.faults == [
        f"mesh.{key}elements: has no effect on geometry.type = 'cad'; remove this key (for other "
        "elements, set mesh.size and mesh.contact_size)"
        for key in ("", "bodies.disk.")
    ]
    tw.load("cad-pad.toml", ("mesh.grading=0.5", "mesh.bodies.disk.grading=0.4"))
