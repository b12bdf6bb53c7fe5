"""Contact of bodies whose cells differ in type or order."""

import json
from dataclasses import replace

from mpi4py import MPI

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.geometry.mesh.mixed import joined
from thermowear.geometry.mesh.nodes import boundary
from thermowear.geometry.meshing.cells import Sheet, grid, level, mesh_body, tagged_bodies
from thermowear.geometry.reading.export import write_mesh
from thermowear.serialise import pack
from thermowear.verification.cases.contact.contact_methods import HEIGHTS, MODULI, PRESSURE
from thermowear.verification.cases.contact.patch_in_space import SIZE, PatchInSpace

from ..conftest import NAMES
from ..test_parallel import summaries

CONDUCTIVITIES, HOT, COLD = (5.0, 40.0), 360.0, 300.0


def tables_of(geometry, **more):
    return {
        "model": "3d",
        "geometry": geometry,
        "mesh": {"degree": 2},
        "bodies": {
            name: {
                "young_modulus": f"{E} Pa",
                "poisson_ratio": 0.0,
                "conductivity": f"{k} W/(m K)",
                "expansion": "0 1/K",
            }
            for name, E, k in zip(PatchInSpace.bodies, MODULI, CONDUCTIVITIES, strict=True)
        },
        "load": {"mean_pressure": f"{PRESSURE} Pa"},
        "analysis": {"type": "initial"},
    } | more


MIXTURES = [
    ((True, False), (1, 2)),
    ((False, True), (2, 1)),
    ((True, False), (2, 2)),
    ((False, True), (1, 1)),
]


@pytest.mark.parametrize(("tetrahedra", "orders"), MIXTURES)
@pytest.mark.parametrize("method", ["condensed", "penalty", "nitsche"])
def test_uniform_pressure_is_exact(tetrahedra, orders, method):
    """requirement: the patch test of tetrahedra on hexahedra and the reverse, 1e-10."""
    contact = {"method": method} | ({"penalty": "1e15 Pa/m"} if method == "penalty" else {})
    geometry = PatchInSpace(columns=(4, 3), orders=orders, tetrahedra=tetrahedra)
    result = tw.run(tw.load(tables_of(geometry, contact=contact)))
    assert result.interface.pressure == pytest.approx(PRESSURE, rel=1e-10)
    expected = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
    expected += PRESSURE / 1e15 if method == "penalty" else 0.0
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize(("tetrahedra", "orders"), MIXTURES)
def test_heat_through_perfect_contact(tetrahedra, orders):
    """requirement: temperatures of two slabs in series at the contact, 1e-9, and in the bodies."""
    geometry = PatchInSpace(columns=(2, 3), orders=orders, tetrahedra=tetrahedra)
    given = {"upper_end": f"{HOT} K", "lower_end": f"{COLD} K"}
    result = tw.run(tw.load(tables_of(geometry, heat={"temperature": given})))
    resistance = [h / k for h, k in zip(HEIGHTS, CONDUCTIVITIES, strict=True)]
    flux = (HOT - COLD) / sum(resistance)
    joint = COLD + flux * resistance[1]
    i = result.interface
    for side in (i.temperature_1, i.temperature_2):
        np.testing.assert_allclose(side - COLD, joint - COLD, rtol=1e-9)
    np.testing.assert_allclose(i.heat_flux_2, flux, rtol=1e-9)
    assert len(result.fields.blocks) == 2
    for fields, body in zip(result.fields.blocks, (1, 2), strict=True):
        assert set(fields.body) == {body}
        z = fields.points[..., 2]
        expected = joint + flux * z / CONDUCTIVITIES[body - 1]
        # samples lie within the cells by 1e-6 of their size
        np.testing.assert_allclose(fields.temperature, expected, atol=1e-6 * (HOT - COLD))


def measured(path):
    """Volume of the cells of each body in a file of fields, and its largest displacement."""
    mesh = meshio.read(path)
    found = {}
    for block, body in zip(mesh.cells, mesh.cell_data["body"], strict=True):
        corners = mesh.points[block.data]
        axes = [1, 2, 3] if block.type == "tetra" else [1, 3, 4]
        edges = corners[:, axes] - corners[:, :1]
        volume = np.abs(np.linalg.det(edges)) / (6 if block.type == "tetra" else 1)
        (number,) = set(body)
        moved = np.abs(mesh.point_data["displacement_m"][block.data]).max()
        found[int(number)] = block.type, volume.sum(), moved
    return found


@pytest.mark.parametrize("ending", ["msh", "vtu"])
def test_from_file_to_results(tmp_path, ending):
    """
    requirement: a mesh file of linear tetrahedra on quadratic hexahedra, through the program, on
    one and two ranks; `fields.vtu` holds the cells of both types.
    """
    made = PatchInSpace(columns=(2, 3), orders=(1, 2), tetrahedra=(True, False)).build(None)
    write_mesh(made, tmp_path / f"mesh.{ending}")
    keys = NAMES
    if ending == "vtu":
        names = (*made.bodies, *made.surfaces)
        numbers = {name: str(i) for i, name in enumerate(names, start=1)}
        keys = NAMES | {"bodies": {name: numbers[name] for name in made.bodies}}
        keys["surfaces"] = {name: numbers[name] for name in made.surfaces}
    geometry = {"type": "file", "path": f"mesh.{ending}"} | keys
    more = {
        "motion": {"velocity": "0.1 m/s"},
        "contact": {"friction": 0.2},
        "wear": {"upper": {"coefficient": "1e-8 1/MPa", "per": "pressure"}},
        "heat": {"cooling": {"upper_end": "1e3 W/(m^2 K)", "lower_end": "2e3 W/(m^2 K)"}},
        "analysis": {"type": "steady"},
    }
    case = tmp_path / "case.toml"
    tables = tables_of(geometry, **more)
    tables["load"] = {"force": "10 kN"}
    case.write_text(_toml(tables))
    if ending == "vtu":
        assert main(["run", str(case), "-o", str(tmp_path / "on1"), "--no-pictures"]) == 0
        runs = [(json.loads((tmp_path / "on1/summary.json").read_text()), tmp_path / "on1")]
    else:
        runs = summaries(tmp_path, case)
    for key in ("max_pressure_Pa", "shape_range_m", "max_temperature_K", "approach_m"):
        assert runs[0][0][key] == pytest.approx(runs[-1][0][key], rel=1e-8)
    for summary, folder in runs:
        assert summary["heat_balance_relative_error"] < 1e-9
        found = measured(folder / "fields.vtu")
        assert [found[body][0] for body in (1, 2)] == ["tetra", "hexahedron"]
        for body, height in enumerate(HEIGHTS, start=1):
            # curved cells are drawn by flat pieces
            assert found[body][1] == pytest.approx(np.prod(SIZE) * height, rel=1e-2)
            assert found[body][2] > 0.0


def _toml(tables):
    import tomli_w

    return tomli_w.dumps(tables)


def sections(triangles, orders):
    """Block on a block in a plane, each of triangles or quadrilaterals."""
    meshes = []
    spans = (0.0, HEIGHTS[0]), (-HEIGHTS[1], 0.0)
    columns = zip(("upper", "lower"), triangles, orders, spans, (3, 4), strict=True)
    for name, of_body, order, span, n in columns:
        cells = grid(np.linspace(0.0, SIZE[0], n + 1), np.linspace(*span, 3))
        body = mesh_body([Sheet(cells)], order)
        claims = {f"{name}_face": level(1, 0.0), f"{name}_end": level(1, sum(span))}
        if of_body:
            assert order == 1
            halves = body.cells[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
            body = replace(body, cells=halves, facets=boundary("triangle", 1, halves))
        tagged = tagged_bodies({name: body}, claims)
        meshes.append(replace(tagged, cell_type="triangle" if of_body else "quadrilateral"))
    return joined(meshes)


@pytest.mark.parametrize("triangles", [(True, False), (False, True)])
@pytest.mark.parametrize("method", ["condensed", "nitsche"])
def test_sections(tmp_path, triangles, method):
    """requirement: linear triangles on quadratic quadrilaterals and the reverse, 1e-10."""
    made = sections(triangles, [1 if of_body else 2 for of_body in triangles])
    assert len(made.blocks) == 2
    write_mesh(made, tmp_path / "mesh.msh")
    geometry = {"type": "file", "path": str(tmp_path / "mesh.msh"), "thickness": "1 m"} | NAMES
    case = tables_of(geometry, contact={"method": method}, model="plane-strain")
    case["load"] = {"force": f"{PRESSURE * SIZE[0]} N"}
    result = tw.run(tw.load(case))
    assert result.interface.pressure == pytest.approx(PRESSURE, rel=1e-10)
    expected = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-10)
    shapes = [fields.pieces.shape[1] for fields in result.fields.blocks]
    assert shapes == [3 if of_body else 4 for of_body in triangles]


def worn(tmp_path, body):
    """Case of a body that wears by some percent of its height, tetrahedra on hexahedra."""
    made = PatchInSpace(columns=(2, 2), orders=(1, 1), tetrahedra=(True, False)).build(None)
    write_mesh(made, tmp_path / "mesh.msh")
    case = tables_of({"type": "file", "path": str(tmp_path / "mesh.msh")} | NAMES)
    return case | {
        "mesh": {"degree": 1},
        "load": {"force": "10 kN"},
        "motion": {"velocity": "0.1 m/s"},
        "wear": {body: {"coefficient": "1e-6 1/MPa", "per": "pressure"}, "update": 0.02},
        "contact": {"friction": 0.0},
        "analysis": {"type": "transient", "end_time": "1500 s"},
    }


@pytest.mark.parametrize(("body", "number"), [("upper", 1), ("lower", 2)])
def test_one_block_follows_its_wear(tmp_path, body, number):
    """requirement: geometry updates of tetrahedra or hexahedra; the volume is the worn one."""
    case = worn(tmp_path, body)
    case["holder"] = {"free": ["z"]}
    summary = tw.run(tw.load(case)).summary
    assert summary["geometry_updates"] > 0
    expected = 1e-12 * 1e4 * 0.1 * 1500  # k F s: no part of the face leaves the contact
    for key in ("wear", "geometry"):
        found = summary[f"{key}_volume_{number}_m3"]
        assert found == pytest.approx(expected, rel=1e-6, abs=0.0)
    assert summary[f"geometry_volume_{3 - number}_m3"] == 0.0


def test_a_mixed_mesh_is_saved_and_restored():
    """requirement: worn meshes in checkpoints."""
    made = PatchInSpace(columns=(2, 3), orders=(1, 2), tetrahedra=(True, False)).build(None)
    again = pack(MPI.COMM_SELF, made).state(0)
    assert again.checksum() == made.checksum()
