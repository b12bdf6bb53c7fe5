"""Contact of curved faces of any extent: whole half circles, whole circles, whole balls."""

import numpy as np
import pytest

import thermowear as tw
from thermowear import CaseError, ComputationError
from thermowear.geometry.reading.export import write_mesh
from thermowear.reference.elastic_contact.hertz import contact_modulus, line_contact

from .cylinders import ball, case_tables, cylinder, on_cylinder, pin_in_bush

R = 100e-3
FORCE = 15.0
"""On a millimetre of thickness [N]: 93 µm to both sides, 102 MPa."""
ZONE = 0.1e-3


def pressed(path, mesh, force=FORCE, **changes):
    """The result of a case with a mesh."""
    write_mesh(mesh, path)
    return tw.run(tw.load(case_tables(path, force, **changes)))


@pytest.fixture(scope="module")
def round_body():
    return cylinder(R, ZONE, 20)


@pytest.mark.parametrize("edges", [pytest.param("curved", marks=pytest.mark.slow), "straight"])
def test_whole_half_circles_touch_as_short_arcs_do(tmp_path, round_body, edges):
    """requirement: extent of the contact faces does not matter; Hertz's peak within 0.5 %."""
    found = []
    for angle in (14.5, 45.0, 90.0):
        mesh = on_cylinder(round_body, round_body, angle, edges)
        found.append(pressed(tmp_path / "a.msh", mesh).summary)
    peaks, approaches = ([s[key] for s in found] for key in ("max_pressure_Pa", "approach_m"))
    exact = line_contact(FORCE / 1e-3, R / 2, contact_modulus((200e9, 0.3), (200e9, 0.3)))
    assert peaks == pytest.approx([peaks[0]] * 3, rel=1e-9)
    assert approaches == pytest.approx([approaches[0]] * 3, rel=1e-9)
    assert peaks[0] == pytest.approx(exact.peak, rel=5e-3)
    assert approaches[0] > 0.0


def test_a_whole_ball_touches_as_its_lower_cap_does(tmp_path):
    """requirement: axisymmetric, up to its equator and beyond it."""
    found = []
    for angle in (20.0, 90.0):
        path = tmp_path / "ball.msh"
        write_mesh(ball(R, ZONE, 12, angle), path)
        tables = case_tables(path, 1.0, model="axisymmetric")
        del tables["geometry"]["thickness"]
        found.append(tw.run(tw.load(tables)).summary)
    assert found[1]["max_pressure_Pa"] == pytest.approx(found[0]["max_pressure_Pa"], rel=1e-9)
    assert found[1]["approach_m"] == pytest.approx(found[0]["approach_m"], rel=1e-9)


def test_a_whole_pin_in_a_whole_bush(tmp_path):
    """requirement: closed curves are contact faces; conforming, as arcs round the contact do."""
    whole, arcs = (
        pressed(tmp_path / "pin.msh", pin_in_bush(angle), 200.0) for angle in (180.0, 75.0)
    )
    for key in ("max_pressure_Pa", "approach_m"):
        assert whole.summary[key] == pytest.approx(arcs.summary[key], rel=1e-6)
    assert whole.summary["approach_m"] > 0.0
    i = whole.interface
    pressing = np.flatnonzero(i.pressure > 0)
    assert np.ptp(pressing) == len(pressing) - 1  # in one piece: opened far from it
    assert abs(i.weight @ (i.pressure * i.x)) < 1e-6 * (i.weight @ i.pressure) * 10e-3


def fretted(path, mesh, moduli=("200 GPa", "200 GPa"), friction=0.6):
    """Pressed by `FORCE` and pushed along by half of what friction can hold."""
    bodies = {
        name: {"young_modulus": modulus, "poisson_ratio": 0.3}
        for name, modulus in zip(("upper", "lower"), moduli, strict=True)
    }
    history = {"time": ["0 s", "1 s"], "tangential_force": ["0 N", f"{friction * FORCE / 2!r} N"]}
    return pressed(
        path,
        mesh,
        bodies=bodies,
        load={"force": f"{FORCE} N", "history": history},
        contact={"friction": friction},
        analysis={"type": "fretting", "increments": 4},
    ).friction.last


def test_the_shear_of_equal_cylinders_is_symmetric(tmp_path, round_body):
    """requirement: q(-x) = q(x), also where the cylinders are much bent: tractions of both bodies
    follow the common face, not that of one of them."""
    for radius, body in ((R, round_body), (2e-3, cylinder(2e-3, 17e-6, 12))):
        found = fretted(tmp_path / f"{radius}.msh", on_cylinder(body, body, 60.0))
        limit = 0.6 * found.pressure.max()
        assert np.abs(found.shear - found.shear[::-1]).max() < 1e-8 * limit
        assert np.abs(found.pressure - found.pressure[::-1]).max() < 1e-8 * limit


@pytest.mark.parametrize(("radius", "near"), [(R, 1e-8), (R / 2, 1e-5)])
def test_exchanged_bodies_answer_alike(tmp_path, round_body, radius, near):
    """requirement: which body is held does not matter, of unlike stiffness either; of unlike radii
    up to the error of the mesh, as the pressure has the facets of body 1."""
    soft, stiff = "70 GPa", "200 GPa"
    other = round_body if radius == R else cylinder(radius, ZONE, 20)
    first = fretted(tmp_path / "a.msh", on_cylinder(round_body, other, 60.0), (soft, stiff))
    second = fretted(tmp_path / "b.msh", on_cylinder(other, round_body, 60.0), (stiff, soft))
    x = np.linspace(-2 * ZONE, 2 * ZONE, 400)
    for name in ("pressure", "shear"):  # half a turn: x becomes -x
        one, two = (
            np.interp(x, sign * f.x[::sign], getattr(f, name)[::sign])
            for sign, f in ((1, first), (-1, second))
        )
        assert np.abs(one - two).sum() < near * np.abs(one).sum()


def test_faces_side_by_side_are_refused(tmp_path, round_body):
    """Turned round, neither faces the other."""
    mesh = on_cylinder(round_body, round_body, 90.0)
    path = tmp_path / "a.msh"
    write_mesh(mesh, path)
    tables = case_tables(path, FORCE)
    tables["geometry"] |= {"contact": ["upper_end", "lower_end"]}
    tables["geometry"] |= {"held": "upper_face", "fixed": "lower_face"}
    with pytest.raises(CaseError, match="does not face down"):
        tw.run(tw.load(tables))


def test_a_holder_that_goes_back_is_no_result(tmp_path, round_body):
    """requirement: bodies drawn into each other by more than 0.1 % of the face end with the reason,
    results kept; the pressure of a lesser overlap is that of bodies that just touch."""
    little, much = (
        pressed(tmp_path / "a.msh", on_cylinder(round_body, round_body, 30.0, overlap=overlap))
        for overlap in (20e-6, 400e-6)
    )
    assert isinstance(much.stopped, ComputationError)
    assert "overlap by up to" in str(much.stopped)
    assert much.summary["approach_m"] < little.summary["approach_m"] < 0.0
    touching = pressed(tmp_path / "a.msh", on_cylinder(round_body, round_body, 30.0))
    peaks = [result.summary["max_pressure_Pa"] for result in (little, touching)]
    assert little.stopped is None
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)
