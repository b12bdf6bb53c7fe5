"""Several materials in one body of a mesh file, by cell sets."""

import tomllib

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.bulk.mesh_motion import serial_extension
from thermowear.case.tables.schema import as_plain
from thermowear.errors import CaseError
from thermowear.geometry.moving.remeshed import meshed_anew
from thermowear.model.body import Facing
from thermowear.simulation.from_case import model_of

from ..case.starter import changed
from ..layered import layered_case, write_layered

SOFT = {"young_modulus": "1 GPa", "poisson_ratio": 0.0}
HARD = {"young_modulus": "50 GPa", "poisson_ratio": 0.0}
WARM_SOFT = SOFT | {"conductivity": "2 W/(m K)", "expansion": "4e-5 1/K"}
WARM_HARD = HARD | {"conductivity": "40 W/(m K)", "expansion": "1e-5 1/K"}
HEAT = {
    "model": "axisymmetric",
    "geometry.thickness": None,
    "bodies.block.conductivity": "50 W/(m K)",
    "bodies.block.expansion": "1e-5 1/K",
    "heat": {"ambient": "20 degC", "temperature": {"TOP": "120 degC", "BOTTOM": "20 degC"}},
    "motion": {"angular_velocity": "1e-9 rad/s"},
    "contact.friction": 0.1,
    "wear": {"pad": {"coefficient": "1e-7 1/MPa"}},
    "analysis": {"type": "steady"},
}


@pytest.fixture(scope="module")
def layers(tmp_path_factory):
    """A lining under its backing."""
    return write_layered(tmp_path_factory.mktemp("layers") / "layers.msh")


@pytest.fixture(scope="module")
def ring(tmp_path_factory):
    """A lining under its backing, in a ring."""
    return write_layered(tmp_path_factory.mktemp("ring") / "ring.msh", left=50.0)


def run(case, changes=None):
    return tw.run(tw.load(changed(case, changes or {})))


def refused(case, changes=None):
    with pytest.raises(CaseError) as error:
        tw.load(changed(case, changes or {})).tagged_mesh()
    return error.value.faults


def test_materials_in_series(layers):
    """
    requirement: layers give way by p h/E each, whatever the sets are called.
    """
    result = run(layered_case(layers, LINING=SOFT, BACKING=HARD))
    np.testing.assert_allclose(result.interface.pressure, 1e6, rtol=1e-7)
    expected = 1e6 * (10e-3 / 1e9 + 5e-3 / 50e9 + 20e-3 / 4e9)
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-9)
    assert result.summary["equilibrium_relative_error"] < 1e-9
    turned = run(layered_case(layers, LINING=HARD, BACKING=SOFT))
    expected = 1e6 * (10e-3 / 50e9 + 5e-3 / 1e9 + 20e-3 / 4e9)
    assert turned.summary["approach_m"] == pytest.approx(expected, rel=1e-9)


def test_materials_side_by_side(tmp_path):
    """
    requirement: under one approach each presses by E δ/h, on a block that hardly gives way.
    """
    path = write_layered(tmp_path / "columns.msh", side_by_side=True)
    stiff = {
        "bodies.block.young_modulus": "1e6 GPa",
        "load": {"approach": "1 um"},
        "contact.pressure_degree": "lobatto",
    }
    i = run(layered_case(path, LINING=SOFT, BACKING=HARD), stiff).interface
    expected = 1e-4 * np.where(i.x < 19e-3, 1e9, 50e9)
    away = np.abs(i.x - 20e-3) > 1e-3
    np.testing.assert_allclose(i.pressure[away], expected[away], rtol=1e-3)


@pytest.mark.parametrize("by_set", ["BACKING", "LINING"])
def test_cells_in_no_set_have_the_material_of_the_body(layers, by_set):
    """
    requirement: a body by one set of the file, one of its parts named; ``like`` another body.
    """
    case = layered_case(layers, **{by_set: {"like": "block"}})
    result = run(case, {"geometry.bodies.pad": "PAD", "bodies.pad": case["bodies"]["pad"] | SOFT})
    heights = {"BACKING": (10e-3, 25e-3), "LINING": (5e-3, 30e-3)}[by_set]
    expected = 1e6 * (heights[0] / 1e9 + heights[1] / 4e9)
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-9)


def test_heat_through_layers(ring):
    """
    requirement: temperatures fall by q h/k in each layer; heat in balance.
    """
    result = run(layered_case(ring, LINING=WARM_SOFT, BACKING=WARM_HARD), HEAT)
    resistances = np.array([5e-3 / 40, 10e-3 / 2, 20e-3 / 50])
    flux = 100.0 / resistances.sum()
    i = result.interface
    np.testing.assert_allclose(i.temperature_1, 293.15 + flux * 20e-3 / 50, rtol=1e-6)
    np.testing.assert_allclose(i.heat_flux_2, flux, rtol=1e-6)
    assert result.summary["heat_balance_relative_error"] < 1e-9


def test_expansion_of_layers(ring):
    """
    requirement: distortion is linear in the expansions of the layers; alike, they are one body.
    """

    def shape(lining, backing):
        materials = {
            "LINING": WARM_SOFT | {"expansion": lining},
            "BACKING": WARM_HARD | {"expansion": backing},
        }
        found = run(layered_case(ring, **materials), HEAT).interface.shape
        return found - found[0]

    none, first, second, both = (
        shape(*given)
        for given in (
            ("0 1/K",) * 2,
            ("3e-5 1/K", "0 1/K"),
            ("0 1/K", "1e-5 1/K"),
            ("3e-5 1/K", "1e-5 1/K"),
        )
    )
    size = np.abs(both).max()
    np.testing.assert_allclose(both - none, first + second - 2 * none, atol=1e-9 * size, rtol=0)
    assert min(np.abs(found - none).max() for found in (first, second)) > 0.1 * size
    alike = run(layered_case(ring, LINING=WARM_SOFT, BACKING=WARM_SOFT), HEAT)
    one = layered_case(ring)
    one["bodies"]["pad"] = WARM_SOFT
    single = run(one, HEAT)
    for name in ("shape", "temperature_1"):
        values = getattr(alike.interface, name), getattr(single.interface, name)
        np.testing.assert_allclose(*values, rtol=1e-9, atol=1e-9 * size, err_msg=name)


def test_shares_and_conductance_are_those_of_the_material_that_touches(ring):
    """
    requirement: effusivity and hardness of the lining count, not those of its backing, which may
    be left out; a material that touches and has none is named.
    """
    lining = WARM_SOFT | {"density": "2 g/cm^3", "specific_heat": "1000 J/(kg K)"}
    block = {"density": "8 g/cm^3", "specific_heat": "500 J/(kg K)", "hardness": "3 GPa"}
    changes = HEAT | {f"bodies.block.{key}": value for key, value in block.items()}
    changes |= {
        "heat.partition": "effusivity",
        "heat.conductance": {"type": "pressure", "coefficient": "1e4 1/m"},
        "motion.angular_velocity": "1 rad/s",
        "heat.temperature.TOP": "20 degC",
    }
    hard = lining | {"hardness": "1 GPa"}
    case = layered_case(ring, LINING=hard, BACKING=WARM_HARD)
    i = run(case, changes).interface
    e1, e2 = np.sqrt([2 * 2e3 * 1e3, 50 * 8e3 * 500])
    k, hardness = 2 * 2 * 50 / 52, 2 * 1 * 3 / 4 * 1e9
    h = 1e4 * k * i.pressure / hardness
    made = 0.1 * i.pressure * i.x
    crossing = h * (i.temperature_2 - i.temperature_1)
    np.testing.assert_allclose(i.heat_flux_1, made * e1 / (e1 + e2) + crossing, rtol=1e-6)
    with pytest.raises(CaseError, match=r"bodies\.pad\.materials\.LINING\.hardness: missing"):
        run(layered_case(ring, LINING=lining, BACKING=WARM_HARD), changes)


def test_a_face_of_two_materials_shares_heat_point_by_point():
    """
    requirement: each point has the effusivities of what touches there.
    """
    storing = {"conductivity": "1 W/(m K)", "expansion": "0 1/K", "density": "1000 kg/m^3"}
    first, second = ({**SOFT, **storing, "specific_heat": f"{c} J/(kg K)"} for c in (400, 900))
    heat = HEAT | {f"bodies.block.{key}": value for key, value in storing.items()}
    heat |= {"bodies.block.specific_heat": "1600 J/(kg K)", "heat.partition": "effusivity"}
    case = tw.load(changed(layered_case("no.msh", LINING=first, BACKING=second), heat))
    parts = ("pad", "block", "pad.LINING", "pad.BACKING")
    model, at = model_of(case), (np.array([2, 3, 2]), np.array([1, 1, 1]))
    shares = model.interface.heat_partition(Facing(parts, at), model.materials)
    np.testing.assert_allclose(shares, [1 / 3, 3 / 7, 1 / 3], rtol=1e-12)


def test_wear_moves_the_mesh_of_a_lined_pad(layers):
    """
    requirement: cells keep their materials when meshes are moved and meshed anew.
    """
    wearing = {
        "motion": {"velocity": "1 m/s"},
        "contact.friction": 0.0,
        "wear": {"update": 0.2, "pad": {"coefficient": "1e-6 1/MPa", "per": "pressure"}},
        "mesh.degree": 2,
        "analysis": {"type": "transient", "end_time": "4000 s"},
    }
    result = run(layered_case(layers, LINING=SOFT, BACKING=HARD), wearing)
    np.testing.assert_allclose(result.interface.wear_1, 4e-3, rtol=1e-4)
    assert result.summary["geometry_updates"] >= 1
    expected = 1e6 * (6e-3 / 1e9 + 5e-3 / 50e9 + 20e-3 / 4e9) + 4e-3
    assert result.summary["approach_m"] == pytest.approx(expected, rel=1e-3)


def test_a_body_meshed_anew_keeps_its_layers(layers):
    """
    requirement: cells of each set where they were, though no cell has the body's own material.
    """
    case = tw.load(layered_case(layers, LINING=SOFT, BACKING=HARD))
    mesh, parts = case.tagged_mesh(), case.geometry.parts_of("pad")
    nodes = np.unique(mesh.facets[mesh.facet_tags == mesh.surfaces.index("FACE") + 1])
    face = nodes[np.argsort(mesh.points[nodes, 0])]
    sizes = np.diff(mesh.points[face, 0])
    anew, _ = meshed_anew(
        mesh, parts, face, sizes, lambda points: np.ones(len(points)), serial_extension
    )
    for part, span in {"pad.LINING": (0.0, 0.01), "pad.BACKING": (0.01, 0.015)}.items():
        cells = anew.cells[anew.cell_tags == anew.bodies.index(part) + 1]
        y = anew.points[cells, 1]
        assert (y.min(), y.max()) == pytest.approx(span, abs=1e-12)


def test_every_material_is_written_out():
    """
    requirement: the resolved case reads back the same.
    """
    case = tw.load(layered_case("no.msh", LINING=SOFT, BACKING={"like": "block"}))
    written = tomllib.loads(tomli_w.dumps(as_plain(case)))
    assert written["geometry"]["bodies"]["pad"] == ["LINING", "BACKING"]
    assert written["bodies"]["pad"]["materials"]["BACKING"]["like"] == "block"
    assert tw.load(written) == case


@pytest.mark.parametrize(
    ("changes", "path", "text"),
    [
        (
            {"bodies.pad.materials.OTHER": SOFT},
            "bodies.pad.materials.OTHER",
            "no cells named 'OTHER'",
        ),
        ({"bodies.pad.materials.BLOCK": SOFT}, "bodies.pad.materials.BLOCK", "36 of 36 cells"),
        (
            {"bodies.pad.materials.PAD": SOFT},
            "bodies.pad.materials.PAD",
            "36 cells are in both 'PAD' and",
        ),
        (
            {"geometry.bodies.pad": ["LINING", "ROOF"]},
            "geometry.bodies.pad",
            "no cells named 'ROOF'",
        ),
        (
            {"bodies.block.materials": {"LINING": SOFT}},
            "bodies.block.materials.LINING",
            "do not lie",
        ),
    ],
)
def test_sets_that_do_not_fit_the_file(layers, changes, path, text):
    """
    requirement: one line that names the table.
    """
    case = layered_case(layers, LINING=SOFT, BACKING=HARD)
    if path == "geometry.bodies.pad":
        changes = changes | {"bodies.pad": SOFT}
    (found,) = refused(case, changes)
    assert found.startswith(f"{path}: ")
    assert text in found


@pytest.mark.parametrize(
    ("changes", "path", "text"),
    [
        (
            {"bodies.pad.materials.LINING.poisson_ratio": None},
            "bodies.pad.materials.LINING.poisson_ratio",
            "missing",
        ),
        (
            {"bodies.pad.materials.LINING": {"like": "roof"}},
            "bodies.pad.materials.LINING.like",
            "names no body",
        ),
        (
            {"bodies.pad.materials.LINING.like": "block"},
            "bodies.pad.materials.LINING.poisson_ratio",
            "not allowed together with like",
        ),
        (
            {"bodies.pad.materials.LINING.materials": {}},
            "bodies.pad.materials.LINING.materials",
            "unknown key",
        ),
        ({"bodies.pad.materials.BACKING": None}, "bodies.pad.young_modulus", "cells of 'BACKING'"),
        ({"bodies": {"pad.LINING": SOFT}}, "bodies.pad.LINING", "one of: pad, block"),
        ({"geometry.bodies.pad": []}, "geometry.bodies.pad", "list of such names"),
    ],
)
def test_materials_that_are_not_complete(changes, path, text):
    """
    requirement: found without the file, one line a fault.
    """
    case = layered_case("no.msh", LINING=SOFT, BACKING=HARD)
    found = [line for line in refused(case, changes) if line.startswith(f"{path}: ")]
    assert len(found) == 1
    assert text in found[0]


def test_cell_sets_are_of_mesh_files():
    """
    requirement: other geometries say so.
    """
    from ..case.starter import STEADY, tables

    found = refused(tables(STEADY, {"bodies.punch.materials": {"COATING": SOFT}}))
    assert found == [
        "bodies.punch.materials: needs cell sets of a mesh file "
        "(geometry.type = \"file\"), found 'annular-punch'",
    ]
