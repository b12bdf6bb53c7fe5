"""Models in Python on a user's mesh give the results of a case file."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseNote

from ..case.starter import FRETTING, RECIPROCATING, STEADY
from .from_case import python_model, same

COARSE = ("mesh.degree=3", "mesh.elements=6")
IN_TIME = (*COARSE, "analysis.type=transient", "analysis.end_time=200 s")
STORED = (
    *COARSE,
    "analysis.type=transient",
    "analysis.end_time=0.5 s",
    "heat.transient=true",
    "mesh.degree=2",
    "bodies.punch.density=7800 kg/m^3",
    "bodies.punch.specific_heat=460 J/(kg K)",
)


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("apart", [False, True])
def test_the_steady_state_of_a_case(apart, backwards):
    """requirement: the same to 1e-12 with own tags, bodies in any order, on one mesh or on two."""
    model, face, case = python_model(STEADY, *COARSE, apart=apart, backwards=backwards)
    steady, known = model.steady(), tw.run(case)
    same(steady.result, known)
    own = steady.result.interface
    assert not np.array_equal(own.temperature_1, own.temperature_2)
    bodies = {body.name: body for body in model.bodies}
    for name, rise in (("punch", own.temperature_1), ("plate", own.temperature_2)):
        np.testing.assert_array_equal(steady.surface_temperature(face, bodies[name]), rise)


@pytest.mark.parametrize(("overrides", "until"), [(IN_TIME, "200 s"), (STORED, "0.5 s")])
def test_the_running_in_of_a_case(overrides, until):
    """requirement: the same to 1e-12, all at once or step by step."""
    model, face, case = python_model(STEADY, *overrides)
    known = tw.run(case)
    same(model.transient(until).result, known)
    states = list(model.march(until))
    for name in ("time", "max_pressure", "max_temperature", "wear_volume_1"):
        found = [getattr(state.row, name) for state in states]
        assert found == pytest.approx([getattr(row, name) for row in known.history], rel=1e-12)
    same(states[-1].snapshot, known)
    assert np.max(states[-1].pressure(face)) == known.interface.pressure.max()


@pytest.mark.parametrize(
    ("name", "overrides", "analysis"),
    [
        ("rectangular-punch", ("mesh.degree=2", "mesh.elements=3"), "steady"),
        ("disk-sector", ("mesh.degree=2", "mesh.elements=3", "geometry.hub=true"), "steady"),
        ("punch-on-strip-tilting", ("mesh.degree=2", "load.moment=0.5 N m"), "steady"),
        ("stacked-blocks", ("mesh.degree=2",), "steady"),
        ("stacked-blocks", ("mesh.degree=2", "analysis.type=initial"), "initial"),
        ("stacked-blocks", ("mesh.degree=2", "analysis.type=stability"), "stability"),
        (FRETTING, ("mesh.degree=2", "mesh.elements=10", "analysis.increments=4"), "fretting"),
        (RECIPROCATING, ("mesh.degree=2", "mesh.elements=6", "analysis.cycles=200"), None),
    ],
)
def test_all_analyses(name, overrides, analysis):
    """requirement: sections and space, every analysis: the same to 1e-12 as from a case file."""
    model, _, case = python_model(name, *overrides)
    known = tw.run(case)
    if analysis == "fretting":
        found = model.fretting(increments=4).result
        assert [row.dissipated for row in found.friction.rows] == pytest.approx(
            [row.dissipated for row in known.friction.rows], rel=1e-12
        )
    elif analysis is None:
        found = model.reciprocating(
            "5 mm", "2 Hz", end_time=100.0, output_times=(10.0, 100.0)
        ).result
    else:
        found = getattr(model, analysis)().result
    same(found, known)
    if analysis == "stability":
        assert found.summary["critical_speed_m_per_s"] == pytest.approx(
            known.summary["critical_speed_m_per_s"], rel=1e-12
        )


def test_other_supports_of_the_same_mesh():
    """requirement: a body with other supports is not solved with the factors of the first one."""
    model, face, _ = python_model("disk-sector", "mesh.elements=3", "geometry.hub=true")
    disk = face.other.body
    before = model.steady().result.interface.shape
    bent = replace(disk, mid_plane=())
    (motion,) = model.motions.values()
    faces = [replace(face, other=bent.surface(face.other.tag))]
    after = replace(model, interfaces=faces, motions={bent: motion})
    found = after.steady().result.interface.shape
    anew = replace(after, _shared={}).steady().result.interface.shape
    np.testing.assert_allclose(found, anew, rtol=0.0, atol=1e-12 * np.ptp(anew))
    assert np.ptp(found) > 1.1 * np.ptp(before)


def test_a_mesh_in_millimetres():
    """requirement: bodies of tens of metres are noted."""
    model, _, _ = python_model(STEADY, "mesh.degree=1", "mesh.elements=3")
    for mesh in {id(body.mesh): body.mesh for body in model.bodies}.values():
        mesh.geometry.x[:] *= 1e3
    with pytest.warns(CaseNote, match=r"^Body\.mesh: 'punch' is 100 m large; wrong unit"):
        replace(model, _shared={})


def test_only_the_relative_motion_matters():
    """requirement: body 2 moving one way is body 1 moving the other; friction tells them apart."""
    model, face, _ = python_model("punch-on-strip-tilting", "mesh.degree=2")
    punch, strip = sorted(model.bodies, key=lambda body: body.name)
    forth, back, passing = (
        np.asarray(replace(model, motions={body: tw.Translation(speed)}).steady().pressure(face))
        for body, speed in ((punch, 0.05), (punch, -0.05), (strip, 0.05))
    )
    np.testing.assert_allclose(passing, back, rtol=1e-12)
    assert np.abs(forth - back).max() > 0.01 * back.max()


@pytest.mark.parametrize("backwards", [False, True])
def test_the_partition_counts_from_the_first_surface(backwards):
    """requirement: a fraction into the first surface given, whichever body is held."""
    words = (*COARSE, "heat.partition=0.2", "heat.conductance=1e4 W/(m^2 K)")
    model, face, case = python_model(STEADY, *words, backwards=backwards)
    assert (face.one.body is model.bodies[0]) is not backwards
    into_one = replace(face, partition=0.8 if backwards else 0.2)
    same(replace(model, interfaces=[into_one]).steady().result, tw.run(case))
    with pytest.raises(tw.CaseError, match=r"^Interface\.partition: found 1\.5; must be a number"):
        replace(model, interfaces=[replace(face, partition=1.5)])
