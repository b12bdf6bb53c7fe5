"""A contact face of several materials, each wearing by its own law, all as one body."""

from dataclasses import replace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.geometry.cad.design import write_table
from thermowear.geometry.mesh.tagged import compact
from thermowear.geometry.reading.export import write_mesh
from thermowear.simulation import run
from thermowear.simulation.analyses.static import steady_design
from thermowear.simulation.runtime.observer import Observer
from thermowear.verification.cases.wear.composite_face import (
    BORDER,
    COEFFICIENTS,
    HEIGHT,
    MODULI,
    PRESSURE,
    SPEED,
    TIME,
    Composite,
)

from ..systems import built

STEADY = {"type": "steady"}
RUNNING_IN = {"type": "transient", "end_time": f"{TIME} s", "tolerance": 1e-3}
PLANE, SPACE = Composite("plane-strain"), Composite("3d", "hexahedron")
BOTH = replace(PLANE, bodies=("upper", "lower"))
CONDUCTIVITIES = {"upper": 2.0, "insert": 50.0, "lower": 50.0, "inlay": 50.0}


def law(k, **keys):
    return {"coefficient": f"{k} 1/Pa", "per": "pressure"} | keys


def hot(case, analysis, wear=None, **heat):
    """Run with friction heat; the upper material insulates."""
    materials = {
        name: {
            "young_modulus": f"{MODULI[name]} Pa",
            "poisson_ratio": 0.3,
            "conductivity": f"{k} W/(m K)",
            "expansion": "1e-5 1/K",
            "density": "7800 kg/m^3",
            "specific_heat": "500 J/(kg K)",
        }
        for name, k in CONDUCTIVITIES.items()
    }
    sets = {"upper": ("upper", "insert"), "lower": ("lower", "inlay")}
    tables = {
        "bodies": {b: {"materials": {n: materials[n] for n in ns}} for b, ns in sets.items()},
        "contact": {"friction": 0.3},
        "heat": {
            "ambient": "20 degC",
            "temperature": {"upper_end": "20 degC", "lower_end": "20 degC"},
        }
        | heat,
    }
    return case.run(analysis, **tables, **({} if wear is None else {"wear": wear}))


def test_alike_laws_are_one_law():
    """
    requirement: a law given twice, by part, is that of the body: the same points and pressures.
    """
    k = 5e-14
    parts = {"materials": {name: law(k) for name in ("upper", "insert")}}
    found, known = (
        PLANE.run(RUNNING_IN, wear={"upper": wear}).interface for wear in (parts, law(k))
    )
    np.testing.assert_array_equal(found.pressure, known.pressure)
    np.testing.assert_array_equal(found.wear_1, known.wear_1)


def test_parts_without_a_law_have_that_of_the_body():
    """
    requirement: the body's own law fills in; the border has a point on either side.
    """
    k, own = COEFFICIENTS["upper"], {"insert": law(COEFFICIENTS["insert"])}
    found = PLANE.run(STEADY, wear={"upper": law(k) | {"materials": own}})
    known = PLANE.run(STEADY)
    np.testing.assert_allclose(found.interface.pressure, known.interface.pressure, rtol=1e-13)
    assert (np.abs(known.interface.x - BORDER) < 1e-9).sum() == 2
    assert known.summary["wear_coefficient_per"] == {
        "upper.upper": "pressure",
        "upper.insert": "pressure",
    }


@pytest.mark.parametrize("case", [PLANE, SPACE, Composite("axisymmetric")])
def test_pressure_before_running_in(case):
    """
    requirement: wear laws change the unworn contact by the space of its pressures alone.
    """
    found, known = (
        case.run({"type": "initial"}, wear=wear)
        for wear in (case.tables("")["wear"], {"upper": law(1e-14)})
    )
    assert found.summary["approach_m"] == pytest.approx(known.summary["approach_m"], rel=5e-3)
    assert found.summary["equilibrium_relative_error"] < 1e-9
    i = found.interface
    assert i.weight @ i.pressure == pytest.approx(PRESSURE * case.area, rel=1e-12)
    assert np.all(i.pressure > 0)
    k = np.where(i.pressure == 0, 0, i.wear_rate_1 / i.pressure)
    assert len(np.unique(np.round(k / k.max(), 9))) == 2  # each material wears by its own law


@pytest.mark.parametrize("case", [PLANE, SPACE, Composite("axisymmetric")])
def test_only_the_other_body_wears(case):
    """
    requirement: pressures and wear rates are those of the materials of body 2.
    """
    case = replace(case, bodies=("lower",))
    result = case.run(STEADY)
    np.testing.assert_allclose(result.interface.pressure, case.pressure(result), rtol=1e-9)
    np.testing.assert_allclose(result.interface.wear_rate_2, case.effective * PRESSURE * SPEED)
    assert not result.interface.wear_rate_1.any()


@pytest.mark.parametrize("case", [PLANE, SPACE, Composite("axisymmetric")])
def test_hot_steady_state(case):
    """
    requirement: with friction heat the steady pressures are the same, and the balances hold.
    """
    result = hot(case, STEADY, case.tables("")["wear"])
    np.testing.assert_allclose(result.interface.pressure, case.pressure(result), rtol=1e-9)
    np.testing.assert_allclose(result.interface.wear_rate_1, case.effective * PRESSURE * SPEED)
    assert result.summary["heat_balance_relative_error"] < 1e-9
    assert result.interface.temperature_1.max() > 297.0


@pytest.mark.parametrize("transient", [False, True])
def test_hot_running_in(transient):
    """
    requirement: the running-in with friction heat ends in that state, the mesh having followed.
    """
    result = hot(PLANE, RUNNING_IN, **({"transient": True} if transient else {}))
    np.testing.assert_allclose(result.interface.pressure, PLANE.pressure(result), rtol=5e-3)
    assert result.summary["geometry_updates"] >= 2
    assert result.summary["heat_balance_relative_error"] < 1e-9


def test_a_rate_that_depends_on_the_temperature_in_one_part():
    """
    requirement: k_i(T_i) p_i is uniform, T being that of the point; other parts do not see it.
    """
    k = COEFFICIENTS["insert"]
    rate = {"rate": f"{k}/Pa*p*v*(1 + 0.01*(T - 293.15 K)/(1 K))"}
    wear = {"upper": law(COEFFICIENTS["upper"]) | {"materials": {"insert": rate}}}
    i = hot(PLANE, STEADY, wear).interface
    insert = i.pressure < PRESSURE
    hotter = np.where(insert, 1 + 0.01 * (i.temperature_1 - 293.15), 1.0)
    each = np.where(insert, k, COEFFICIENTS["upper"])
    np.testing.assert_allclose(each * hotter * i.pressure * SPEED, i.wear_rate_1, rtol=1e-9)
    assert np.ptp(i.wear_rate_1) < 1e-8 * i.wear_rate_1.mean()
    assert np.ptp(i.pressure[insert]) > 1e-3 * PRESSURE


def test_a_tilting_holder():
    """
    requirement: the whole face wears as a rigid body, whose tilt keeps the moment zero.
    """
    pivot = 33e-3
    holder = {"free": ["z", "rotation"], "pivot": [f"{pivot} m", f"{HEIGHT} m"]}
    i = PLANE.run(STEADY, holder=holder).interface
    insert = np.cumsum(np.abs(i.x - BORDER) < 1e-9) + (i.x > BORDER) >= 2
    k = np.where(insert, COEFFICIENTS["insert"], COEFFICIENTS["upper"])
    np.testing.assert_allclose(i.wear_rate_1, k * i.pressure * SPEED, rtol=1e-12)
    tilt = np.polynomial.Polynomial.fit(i.x, i.wear_rate_1, 1)
    np.testing.assert_allclose(tilt(i.x), i.wear_rate_1, rtol=1e-9)
    assert np.ptp(i.wear_rate_1) > 0.1 * i.wear_rate_1.max()
    assert abs((i.weight * i.pressure) @ (i.x - pivot)) < 1e-9 * pivot * PRESSURE * PLANE.area


@pytest.mark.parametrize("case", [PLANE, replace(SPACE, cells="tetrahedron")])
def test_faces_that_do_not_match(case, tmp_path):
    """
    requirement: body 2 of one wear law may be meshed in any way.
    """
    path, mesh = tmp_path / "blocks.msh", shifted(case.mesh())
    write_mesh(compact(mesh), path)
    for analysis, allowed in ((STEADY, 1e-9), (RUNNING_IN, 1e-3)):
        result = run(load(case.tables(path) | {"analysis": analysis}))
        np.testing.assert_allclose(result.interface.pressure, case.pressure(result), rtol=allowed)


def shifted(mesh):
    """Mesh with the nodes of body 2 moved along the face, but its ends."""
    lower = np.isin(mesh.cell_tags, [mesh.bodies.index(name) + 1 for name in ("lower", "inlay")])
    own, points = np.unique(mesh.cells[lower]), mesh.points.copy()
    within = np.clip((points[own, 0] - 0.02) / 0.03, 0.0, 1.0)
    points[own, 0] += 1e-3 * np.sin(np.pi * within)
    return replace(mesh, points=points)


def test_friction_stress_and_factors_by_part():
    """
    requirement: ``per`` and the factors of a part act in this part alone.
    """
    stress = {"coefficient": f"{COEFFICIENTS['upper'] / 0.25} 1/Pa", "per": "friction-stress"}
    factor = {"pressure": {"at": ["0 MPa", "100 MPa"], "factor": [3.0, 3.0]}}
    parts = {"upper": stress, "insert": law(COEFFICIENTS["insert"] / 3, factor=factor)}
    result = PLANE.run(STEADY, wear={"upper": {"materials": parts}}, contact={"friction": 0.25})
    np.testing.assert_allclose(result.interface.pressure, PLANE.pressure(result), rtol=1e-9)


@pytest.fixture(scope="module")
def blocks(tmp_path_factory):
    """Path of a mesh file."""
    path = tmp_path_factory.mktemp("blocks") / "blocks.msh"
    write_mesh(compact(PLANE.mesh()), path)
    return path


class Notes(Observer):
    """Notes of a run."""

    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def test_steps_between_materials_of_both_faces_remain_in_the_gap(blocks):
    """
    requirement: no mesh follows a step in the common face; that is noted, and the state right.
    """
    told = Notes()
    result = run(load(BOTH.tables(blocks) | {"analysis": RUNNING_IN}), observer=told)
    assert [text for text in told.notes if "no mesh follows the step between them" in text]
    assert "geometry_updates" not in result.summary
    np.testing.assert_allclose(result.interface.pressure, BOTH.pressure(result), rtol=1e-6)
    alone = Notes()
    assert run(load(PLANE.tables(blocks) | {"analysis": RUNNING_IN}), observer=alone).summary[
        "geometry_updates"
    ]
    assert not alone.notes


@pytest.mark.parametrize("case", [PLANE, SPACE])
def test_parts_made_in_their_worn_shape(case, tmp_path):
    """
    requirement: a face of that shape presses from the start as in its steady state.
    """
    mesh, design = tmp_path / "blocks.msh", tmp_path / "design.csv"
    write_mesh(compact(case.mesh()), mesh)
    tables = case.tables(mesh)
    steady = load(tables | {"analysis": STEADY})
    write_table(steady_design(built(steady, MPI.COMM_SELF), 0, 0), design)
    shaped = tables["geometry"] | {"initial_shape": str(design)}
    result = run(load(tables | {"geometry": shaped, "analysis": {"type": "initial"}}))
    np.testing.assert_allclose(result.interface.pressure, case.pressure(result), rtol=1e-6)


def test_the_shape_at_the_end_of_the_running_in_is_a_shape_to_start_from(blocks, tmp_path):
    """
    requirement: places that are listed twice, at the border of materials, are one.
    """
    i = PLANE.run(RUNNING_IN).interface
    path = tmp_path / "profile.csv"
    rows = np.column_stack([i.s, i.shape])
    np.savetxt(path, rows, delimiter=",", header="s_m,shape_m", comments="")
    tables = PLANE.tables(blocks)
    shaped = tables["geometry"] | {"initial_shape": str(path)}
    result = run(load(tables | {"geometry": shaped, "analysis": {"type": "initial"}}))
    np.testing.assert_allclose(result.interface.pressure, PLANE.pressure(result), rtol=2e-2)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"wear": {"upper": {"materials": {"insert": law(1e-14)}}}},
            r"^wear\.upper\.materials\.upper: missing; the contact face upper_face has cells",
        ),
        (
            {"wear": {"upper": {"materials": {"inserts": law(1e-14)}} | law(1e-14)}},
            r"^wear\.upper\.materials\.inserts: the file has no cells named 'inserts'; one of: "
            "inlay, insert, lower, upper",
        ),
        ({"mesh": {"degree": 1}}, r"^mesh\.degree: found 1; .* the pressure jumps"),
        ({"contact": {"pressure_degree": 2}}, r"^contact\.pressure_degree: .* below mesh\.degree"),
        ({"contact": {"pressure_degree": "lobatto"}}, r"^contact\.pressure_degree: "),
        ({"contact": {"method": "nitsche"}}, r"^contact\.method: 'nitsche' is not supported"),
    ],
)
def test_faults(blocks, changes, message):
    with pytest.raises(CaseError, match=message) as caught:
        run(load(PLANE.tables(blocks) | {"analysis": STEADY} | changes))
    assert len(caught.value.faults) == 1


def test_elements_across_a_border_of_the_other_face(tmp_path):
    """
    requirement: materials of body 2 may not end inside elements of body 1.
    """
    path = tmp_path / "across.msh"
    write_mesh(compact(shifted(BOTH.mesh())), path)
    with pytest.raises(CaseError, match=r"^geometry\.contact: elements of upper_face lie across"):
        run(load(BOTH.tables(path) | {"analysis": STEADY}))
