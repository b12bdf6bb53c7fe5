"""Disk between two pads in space, meshed with gmsh, with glued back plates that do not match."""

import shutil

import numpy as np
import pytest

import thermowear as tw

from ..test_parallel import same_on_two_ranks
from . import two_pads

FIELDS = ("pressure", "shape", "wear_rate_1", "wear_1")
HOT = ("temperature_1", "temperature_2")
KINDS = ("none", "spread", "resolved")


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """Mesh files of the whole brake and of its half."""
    folder = tmp_path_factory.mktemp("meshes")
    return {half: two_pads.write_mesh(folder / f"{half}.msh", half) for half in (False, True)}


def placed(result, own):
    """Columns at some points, in the order of their places in the plane."""
    found = {name: values[own] for name, values in two_pads.columns(result).items()}
    x, y = (np.round(found[axis], 9) for axis in "xy")
    order = np.lexsort((y, x))
    return {name: values[order] for name, values in found.items() if values is not None}


def compared(meshes, make, names, tolerance=1e-8):
    """Compare both contacts of the whole brake with that of its half; returns both results."""
    whole, half = (tw.run(tw.load(make(meshes[one], one))) for one in (False, True))
    for result in (whole, half):
        assert result.stopped is None, result.stopped
        assert abs(result.summary["equilibrium_relative_error"]) < 1e-9
    count = len(half.interface.pressure)
    assert len(whole.interface.pressure) == 2 * count
    expected = placed(half, slice(None))
    for own in (slice(count), slice(count, None)):
        found = placed(whole, own)
        for name in names:
            size = np.abs(expected[name]).max()
            assert size > 0.0, name
            allowed = tolerance * size
            np.testing.assert_allclose(found[name], expected[name], 0.0, allowed, err_msg=name)
    return whole, half


def test_cold_steady_state_is_that_of_the_half(meshes):
    """requirement: two pads on a whole disk give the numbers of one on its half.

    By hand: with ``rate = k p v`` in place, the pressure is ``p0 r0 / r`` on a face that its
    holder keeps level, so that the torque is ``mu F`` times the mean radius ``A / ∫ dA / r``. The
    disk turns anticlockwise and drags the pads along +y, by ``mu F`` times the mean cosine.
    """
    whole, _ = compared(meshes, two_pads.tables, ("pressure", "shape", "wear_rate_1"))
    dragged = two_pads.FRICTION * two_pads.FORCE * np.sin(two_pads.ANGLE) / two_pads.ANGLE
    for holder in whole.summary["holders"].values():
        assert holder["guide_force_y_N"] == pytest.approx(-dragged, rel=1e-5)
    for contact in whole.summary["contacts"].values():
        assert contact["normal_force_N"] == pytest.approx(two_pads.FORCE, rel=1e-9)
        mean = (80e-3 + 130e-3) / 2  # (R² - r²)/2 over R - r
        torque = two_pads.FRICTION * two_pads.FORCE * mean
        assert contact["friction_torque_Nm"] == pytest.approx(torque, rel=1e-5)
        assert contact["between"][1] == "disk"


@pytest.mark.parametrize("advection", KINDS)
def test_hot_steady_state_is_that_of_the_half(meshes, advection):
    """requirement: the same with friction heat, of a disk at rest, fast, and at its speed."""

    def make(path, half):
        return two_pads.tables(path, half, {"advection": advection})

    whole, half = compared(meshes, make, ("pressure", "shape", *HOT))
    for result, sides in ((whole, 2), (half, 1)):
        summary = result.summary
        assert abs(summary["heat_balance_relative_error"]) < 1e-9
        heat = sum(of["contact_heat_W"] for of in summary["bodies"].values())
        assert heat == pytest.approx(summary["friction_power_W"], rel=1e-9)
        power = sides * two_pads.FRICTION * two_pads.FORCE * two_pads.SPEED * 0.105
        assert summary["friction_power_W"] == pytest.approx(power, rel=1e-5)


def test_hot_running_in_is_that_of_the_half(meshes):
    """requirement: running-in with temperatures in time, wear of the pads in place."""
    whole, half = compared(meshes, two_pads.running_in, (*FIELDS, *HOT))
    worn = whole.summary["bodies"]
    assert worn["disk"]["wear_volume_m3"] == 0.0
    for pad in ("left", "right"):
        expected = half.summary["bodies"]["left"]["wear_volume_m3"]
        assert worn[pad]["wear_volume_m3"] == pytest.approx(expected, rel=1e-8)
        # Archard: k F times the way at the mean radius, once the pressure has settled
        way = two_pads.SPEED * 100.0 * 0.105
        assert worn[pad]["wear_volume_m3"] == pytest.approx(
            two_pads.K * two_pads.FORCE * way, rel=0.05
        )


def test_the_order_of_faces_does_not_matter(meshes):
    """requirement: with the disk first and its part of the heat, the same numbers to 1e-12."""
    case = two_pads.tables(meshes[True], True, {})
    expected = tw.run(tw.load(case))
    case["contacts"]["left"] = {"between": ["DISK_TOP", "left_face"], "partition": 0.9}
    found = tw.run(tw.load(case))
    for name, other in zip(
        ("pressure", "shape", *HOT), ("pressure", "shape", *HOT[::-1]), strict=True
    ):
        wanted = two_pads.columns(expected)[name]
        size = np.abs(wanted).max()
        np.testing.assert_allclose(two_pads.columns(found)[other], wanted, 0.0, 1e-12 * size)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
def test_two_ranks_give_the_serial_numbers(meshes, tmp_path):
    """requirement: the hot steady state on two ranks as on one."""
    serial = two_pads.columns(tw.run(tw.load(two_pads.tables(meshes[False], heat={}))))
    expected = {name: serial[name] for name in ("pressure", "shape", *HOT)}
    same_on_two_ranks("tests.simulation.two_pads", tmp_path, expected, meshes[False], rtol=1e-7)


def unglued(path):
    """The brake without back plates."""
    case = two_pads.tables(path, heat={})
    for side in ("left", "right"):
        plate, back = f"{side}_plate", f"{side}_back"
        del case["contacts"][f"{side}_joint"], case["bodies"][plate]
        del case["geometry"]["bodies"][plate], case["geometry"]["surfaces"][plate]
        case["holders"][side]["surface"] = back
        case["heat"]["cooling"][back] = case["heat"]["cooling"].pop(f"{plate}_back")
    return case


def test_multigrid(meshes):
    """requirement: the factor's numbers without glued bodies; with them, one line."""
    case = unglued(meshes[False])
    each = [tw.run(tw.load(case, (f"mesh.solver={solver}",))) for solver in ("direct", "multigrid")]
    direct, multigrid = map(two_pads.columns, each)
    assert each[1].summary["solver"] == "multigrid"
    for name in ("pressure", "shape", *HOT):
        size = np.abs(direct[name]).max()
        np.testing.assert_allclose(multigrid[name], direct[name], 0.0, 1e-6 * size, err_msg=name)
    with pytest.raises(tw.CaseError, match=r"^mesh\.solver: glued bodies are solved by a factor"):
        tw.run(tw.load(two_pads.tables(meshes[False]), ("mesh.solver=multigrid",)))


def test_what_is_glued_to_the_disk_would_carry_heat(meshes):
    """requirement: advection in one of several glued bodies is refused in one line."""
    case = two_pads.tables(meshes[False], heat={"advection": "spread"})
    case["contacts"]["right"]["tie"] = True
    del case["wear"]["right"]
    case["bodies"]["disk"] = {k: v for k, v in case["bodies"]["disk"].items() if k != "fixed"}
    with pytest.raises(tw.CaseError, match=r"^heat\.advection: right is glued to disk"):
        tw.run(tw.load(case))


def test_a_disk_that_does_not_turn_about_its_axis(meshes):
    """
    requirement: heat is carried along by a body of revolution about its axis only: 1 mm off, also
    in the limit of high speed, and about an axis in place, it is refused in one line.
    """
    case = two_pads.tables(meshes[True], True, heat={"advection": "resolved"})
    off = 'motions.disk.center=["1 mm", "0 mm"]'
    for overrides in ((off,), (off, "heat.advection=spread")):
        with pytest.raises(tw.CaseError, match=r"^heat\.advection: 'disk' has a wall at"):
            tw.run(tw.load(case, overrides))
    case["motions"]["disk"]["axis"] = {"point": ["0 m"] * 3, "direction": [0.0, 0.1, 1.0]}
    with pytest.raises(tw.CaseError, match=r"^heat\.advection: is for one moving body that passes"):
        tw.load(case)
