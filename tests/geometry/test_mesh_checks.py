"""Meshes that cannot be meant."""

from __future__ import annotations

import copy
import warnings

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseError, CaseNote

from .measure import areas
from .plain import NAMES, Plain, blocks, msh

STEEL = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}


def case(path, mesh: Plain, load=None, **keys):
    """A case with a mesh file."""
    path = path / "mesh.msh"
    path.write_text(msh(mesh))
    return tw.load(
        {
            "model": "plane-strain",
            "geometry": {"type": "file", "path": str(path), "thickness": "1 mm"} | NAMES | keys,
            "bodies": {"punch": STEEL, "plate": STEEL},
            "load": load or {"force": "1 kN"},
            "analysis": {"type": "initial"},
        }
    )


def fault(path, mesh: Plain, **more) -> str:
    with pytest.raises(CaseError) as error:
        case(path, mesh, **more).tagged_mesh()
    (line,) = error.value.faults
    assert "\n" not in line
    return line


def gap(mesh) -> float:
    """Gap between the level faces of both blocks [m]."""
    upper, lower = (
        mesh.points[mesh.facets[mesh.facet_tags == mesh.surfaces.index(name) + 1]][..., 1]
        for name in NAMES["contact"]
    )
    return upper.min() - lower.max()


def quadratic(mesh: Plain) -> Plain:
    """Copy with straight cells of nine nodes and lines of three."""
    result, middle = Plain(copy.deepcopy(mesh.points)), {}

    def between(*nodes: int) -> int:
        key = tuple(sorted(nodes))
        if key not in middle:
            middle[key] = len(result.points)
            result.points.append(np.mean([mesh.points[n] for n in nodes], axis=0).tolist())
        return middle[key]

    for name, (a, b, c, d) in mesh.cells:
        sides = [between(a, b), between(b, c), between(c, d), between(d, a)]
        result.cells.append((name, [a, b, c, d, *sides, between(a, b, c, d)]))
    result.lines = [(name, [a, b, between(a, b)]) for name, (a, b) in mesh.lines]
    return result


def changed(change, mesh: Plain | None = None) -> Plain:
    result = copy.deepcopy(mesh or blocks())
    change(result)
    return result


def _tangled(mesh):
    mesh.points[mesh.cells[0][1][2]][0] += 0.015


def _bulged(mesh):
    mesh.points[mesh.cells[0][1][5]][0] += 0.007  # a node within an edge, far to one side


def _flat(mesh):
    a, b, *_ = mesh.cells[0][1]
    mesh.points[b] = list(mesh.points[a])


def _nowhere(mesh):
    mesh.points[3][1] = float("nan")


def _far(mesh):
    mesh.points[3][1] = 1e300


def _third(mesh):
    _, (_, b, c, _) = mesh.cells[0]
    mesh.points += [[0.0, 0.05], [0.0, 0.06]]
    mesh.cells.append(("PUNCH", [b, len(mesh.points) - 2, len(mesh.points) - 1, c]))


def _double(mesh):
    mesh.cells.append(mesh.cells[0])


def _crack(mesh):
    name, nodes = mesh.cells[0]
    extra = [len(mesh.points), len(mesh.points) + 1]
    mesh.points += [list(mesh.points[nodes[2]]), list(mesh.points[nodes[3]])]
    mesh.cells[0] = (name, [*nodes[:2], *extra])


def _hinge(mesh):
    mesh.cells = [cell for k, cell in enumerate(mesh.cells) if k not in (1, 4)]
    mesh.lines = [line for line in mesh.lines if line[0] != "PUNCH_FACE" or line[1] != [1, 2]]


def _loose(mesh):
    first = len(mesh.points)
    mesh.points += [[0.1, 0.0], [0.11, 0.0], [0.11, 0.01], [0.1, 0.01]]
    mesh.cells.append(("PUNCH", [first, first + 1, first + 2, first + 3]))


def _line_of_nothing(mesh):
    mesh.lines.append(("PUNCH_FACE", [0, 3]))


def _line_within(mesh):
    mesh.lines.append(("PUNCH_FACE", mesh.cells[0][1][1:3]))


def _two_names(mesh):
    mesh.lines.append(("PUNCH_TOP", mesh.lines[0][1]))


def _face_with_a_hole(mesh):
    faces = [line for line in mesh.lines if line[0] == "PUNCH_FACE"]
    mesh.lines.remove(faces[1])


def _node_twice_in_a_line(mesh):
    mesh.lines[0] = (mesh.lines[0][0], [0, 0])


SPOILT = {
    "tangled": (_tangled, "cells of 'punch' are tangled or flat (det J <= 0)"),
    "flat": (_flat, "cells of 'punch' are tangled or flat (det J <= 0)"),
    "nan": (_nowhere, "the coordinates of some nodes of the bodies are not finite"),
    "far": (_far, "a node lies at ("),
    "three cells on an edge": (_third, "1 edges of 'punch' have three or more cells"),
    "cell twice": (_double, "1 cells occur twice in 'PUNCH'"),
    "crack": (_crack, "cells of 'punch' are not joined along 2 edges"),
    "hinge": (_hinge, "are joined by a single node"),
    "loose piece": (_loose, "1 of 9 cells of 'punch' are not joined to those held at 'PUNCH_TOP'"),
    "line of nothing": (
        _line_of_nothing,
        "1 of 5 lines of 'PUNCH_FACE' are not on the boundary of any",
    ),
    "line within": (
        _line_within,
        "1 of 5 lines of 'PUNCH_FACE' are not on the boundary of any body",
    ),
    "two names": (_two_names, "'PUNCH_FACE' and 'PUNCH_TOP' share 1 edges"),
    "face with a hole": (_face_with_a_hole, "the edges of 'PUNCH_FACE' are in 2 pieces"),
    "node twice": (_node_twice_in_a_line, "an element of type line has a node twice"),
}


@pytest.mark.parametrize("name", SPOILT)
def test_spoilt_meshes(name, tmp_path):
    """
    requirement: one line that says what is wrong, and where.
    """
    change, expected = SPOILT[name]
    line = fault(tmp_path, changed(change))
    assert line.startswith("geometry.")
    assert expected in line


def test_curved_cells(tmp_path):
    """
    requirement: det J of curved cells is looked at all over, not at their corners.
    """
    sound = quadratic(blocks())
    assert len(case(tmp_path, sound).tagged_mesh().cells) == 20
    assert "of 'punch' are tangled or flat" in fault(tmp_path, changed(_bulged, sound))


def test_cells_listed_either_way(tmp_path):
    """
    requirement: cells may be listed clockwise, all or some, and a mesh may be mirrored: the bodies
    are the same.
    """
    known = case(tmp_path, blocks()).tagged_mesh()
    some, every = blocks(), blocks()
    some.cells[3] = (some.cells[3][0], some.cells[3][1][::-1])
    every.cells = [(name, nodes[::-1]) for name, nodes in every.cells]
    mirrored = blocks()
    mirrored.points = [[-x, y] for x, y in mirrored.points]
    for mesh in (some, every, mirrored):
        found = case(tmp_path, mesh).tagged_mesh()
        for body in known.bodies:
            np.testing.assert_allclose(areas(found, body).sum(), areas(known, body).sum())


def test_a_fold_is_not_taken_for_cells_listed_the_other_way(tmp_path):
    """
    requirement: triangles that a node has been pulled across are refused, not turned round.
    """
    mesh = blocks()
    mesh.cells = [
        (body, [n[k] for k in part]) for body, n in mesh.cells for part in ((0, 1, 2), (0, 2, 3))
    ]
    assert len(case(tmp_path, mesh).tagged_mesh().cells) == 40
    mesh.points[6][0] -= 0.025
    assert "of 'punch' are tangled or flat" in fault(tmp_path, mesh)


def test_pieces_that_are_all_held(tmp_path):
    """
    requirement: a body in two pieces, both on the holder, is said.
    """
    mesh = blocks()
    mesh.cells = [cell for k, cell in enumerate(mesh.cells) if k not in (2, 6)]
    mesh.lines = [
        x for x in mesh.lines if x not in [("PUNCH_FACE", [2, 3]), ("PUNCH_TOP", [12, 13])]
    ]
    mesh.lines = [x for x in mesh.lines if x != ("PUNCH_FACE", [3, 4])]
    with pytest.warns(CaseNote, match="'punch' has 2 pieces, all held by 'PUNCH_TOP'"):
        found = case(tmp_path, mesh).tagged_mesh()
    assert areas(found, "punch") == pytest.approx(6 * [1e-4])  # two of eight cells are gone


HALF = {"half": True, "symmetry": ["AXES"]}


def test_a_half_model(tmp_path):
    """
    requirement: a plane of symmetry x = const, on either side of the bodies.
    """
    mesh = blocks(half=True)
    right = case(tmp_path, mesh, **HALF).tagged_mesh()
    mesh.points = [[0.3 - x, y] for x, y in mesh.points]
    left = case(tmp_path, mesh, **HALF).tagged_mesh()
    for found, plane in ((right, 0.0), (left, 0.3)):
        axis = found.facets[found.facet_tags == found.surfaces.index("AXES") + 1]
        assert found.points[axis][..., 0] == pytest.approx(plane, abs=1e-15)
        assert areas(found, "punch").sum() == pytest.approx(20e-3 * 20e-3)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda m: m.points[0].__setitem__(0, 1e-3), "'AXES' does not lie in a plane x = const"),
        (
            lambda m: m.lines.__setitem__(
                slice(None), [x for x in m.lines if x[0] != "AXES" or x[1][0] > 14]
            ),
            "no surface of 'punch' is listed",
        ),
    ],
)
def test_symmetry_that_is_none(change, expected, tmp_path):
    """
    requirement: surfaces of symmetry off x = const, or of one body only.
    """
    mesh = changed(change, blocks(half=True))
    assert expected in fault(tmp_path, mesh, **HALF)


def test_a_whole_body_in_a_half_model(tmp_path):
    """
    requirement: all of both bodies lies on one side of the plane of symmetry.
    """
    mesh = blocks(half=True).moved("PLATE", -0.01, 0.0)
    mesh.lines = [x for x in mesh.lines if x[0] != "AXES" or x[1][0] < 15]
    assert "lie on both sides of the plane of symmetry x = 0" in fault(tmp_path, mesh, **HALF)


PLACED = {
    "overlap": ((0, -0.021), "the bodies overlap by 21 mm, 105% of 'punch', which is 20 mm high"),
    "apart": ((0, 0.5), "the bodies lie 500 mm apart, more than the height of '"),
    "beside": ((0.2, 0), "the contact faces do not lie opposite each other"),
}


@pytest.mark.parametrize("name", PLACED)
def test_bodies_that_are_placed_wrong(name, tmp_path):
    """
    requirement: bodies that overlap by their own size, lie far apart, or beside each other.
    """
    moved, expected = PLACED[name]
    assert expected in fault(tmp_path, blocks().moved("PUNCH", *moved))


def test_bodies_upside_down(tmp_path):
    """
    requirement: body 1 is pressed along -y, so it lies above.
    """
    mesh = blocks()
    mesh.points = [[x, -y] for x, y in mesh.points]
    assert "'PUNCH_FACE' does not face down" in fault(tmp_path, mesh)


def test_bodies_that_overlap_a_little(tmp_path):
    """
    requirement: an overlap of some percent may be meant, and is said; a thousandth is not.
    """
    with pytest.warns(CaseNote, match="the bodies overlap by 1 mm before loading, 5.0% of"):
        much = case(tmp_path, blocks().moved("PUNCH", 0, -1e-3)).tagged_mesh()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        little = case(tmp_path, blocks().moved("PUNCH", 0, -2e-5)).tagged_mesh()
    assert gap(much) == pytest.approx(-1e-3)
    assert gap(little) == pytest.approx(-2e-5)


LOADS = {
    "unit": (
        {"length_unit": "1 um"},
        {"approach": "0.05 mm"},
        "load.approach: 50 µm compresses the",
    ),
    "force": ({"length_unit": "1 um"}, {"force": "10 kN"}, "times the modulus of"),
    "open": ({"length_unit": "1 m"}, {"approach": "0.05 mm"}, "does not close the gap of 1 mm"),
    "atoms": ({"length_unit": "1e-9 m"}, {"force": "1 N"}, "the bodies have a size of 6e-11 m"),
}


@pytest.mark.parametrize("name", LOADS)
def test_loads_that_do_not_fit_the_size(name, tmp_path):
    """
    requirement: a wrong unit of length is found where the load would squeeze a body flat, or does
    not close the gap.
    """
    keys, load, expected = LOADS[name]
    mesh = blocks().moved("PUNCH", 0, 1e-3) if name == "open" else blocks()
    assert expected in fault(tmp_path, mesh, load=load, **keys)


def test_a_gap_that_the_approach_closes(tmp_path):
    """
    requirement: bodies may be drawn apart.
    """
    mesh = blocks().moved("PUNCH", 0, 1e-5)
    for load in ({"approach": "0.05 mm"}, None):
        assert gap(case(tmp_path, mesh, load).tagged_mesh()) == pytest.approx(1e-5)


def notes(path, mesh: Plain, **more) -> list[str]:
    """Notes on a case with a mesh file."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", CaseNote)
        case(path, mesh, **more).tagged_mesh()
    return [str(one.message) for one in found]


def test_bodies_of_a_wrong_unit(tmp_path):
    """
    requirement: bodies of some metres, or a pressure of less than 1 Pa, ask for the unit; a large
    punch of 1.9 m and a light load of 2 Pa do not.
    """
    metres = {"length_unit": "100 m", "load": {"force": "1 kN"}}
    found = notes(tmp_path, blocks(), **metres)
    assert found == [
        "geometry.length_unit: 'punch' is 4 m large; wrong length_unit?",
        "geometry.length_unit: 'plate' is 6 m large; wrong length_unit?",
    ]
    light = {"thickness": "1 m", "load": {"force": "20 mN"}}
    assert notes(tmp_path, blocks(), **light) == [
        "load: the mean pressure is 0.5 Pa; wrong length_unit?"
    ]
    light["load"] = {"force": "80 mN"}
    assert notes(tmp_path, blocks(), length_unit="32 m", **{"load": {"force": "1 MN"}}) == []
    assert notes(tmp_path, blocks(), **light) == []


def test_bodies_that_are_a_little_apart(tmp_path):
    """
    requirement: a gap of some percent of a body is said if no approach closes it.
    """
    (found,) = notes(tmp_path, blocks().moved("PUNCH", 0, 1e-3))
    assert found == (
        "geometry.path: the faces are 1 mm apart before loading, 5.0% of 'punch', which is 20 mm "
        "high; move the faces to initial contact"
    )
    assert notes(tmp_path, blocks().moved("PUNCH", 0, 1e-4)) == []
    closed = {"load": {"approach": "1.01 mm"}}
    assert notes(tmp_path, blocks().moved("PUNCH", 0, 1e-3), **closed) == []
