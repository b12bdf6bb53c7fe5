"""Fretting of bodies in space from Python: a block between two others, on dolfinx meshes."""

from dataclasses import replace

from mpi4py import MPI

import dolfinx
import numpy as np
import pytest
from dolfinx.mesh import CellType, locate_entities_boundary, meshtags

import thermowear as tw

BELOW, ABOVE, END = 7, 8, 9
WIDTH, FORCE, K, FRICTION = 0.02, 600.0, 2e-14, 0.3
STEEL = tw.Material("2 GPa", 0.3)


def block(name, bottom, top):
    """Box of hexahedra between two heights."""
    ends, divisions = [[0.0, 0.0, bottom], [WIDTH, WIDTH, top]], (3, 3, 2)
    mesh = dolfinx.mesh.create_box(MPI.COMM_SELF, ends, divisions, CellType.hexahedron)
    places = (2, bottom), (2, top), (0, 0.0)
    found = [
        locate_entities_boundary(mesh, 2, lambda x, k=k, at=at: np.isclose(x[k], at))
        for k, at in places
    ]
    facets, counts = np.concatenate(found), [len(each) for each in found]
    order, tags = np.argsort(facets), np.repeat(np.array([BELOW, ABOVE, END], np.int32), counts)
    return tw.Body(name, mesh, None, meshtags(mesh, 2, facets[order], tags[order]), STEEL)


def rubbing(one, other):
    return tw.Interface(one, other, friction=FRICTION, wear={one.body: tw.PowerWear(K)})


@pytest.fixture(scope="module")
def clamped():
    """A block that is held at its end, between two others."""
    upper, middle, lower = (
        block(name, z, z + 0.01) for name, z in (("upper", 0.01), ("middle", 0.0), ("lower", -0.01))
    )
    return tw.Model(
        [
            rubbing(upper.surface(BELOW), middle.surface(ABOVE)),
            rubbing(lower.surface(ABOVE), middle.surface(BELOW)),
        ],
        [
            tw.Holder(upper.surface(ABOVE), force=FORCE),
            tw.Holder(lower.surface(BELOW), free=()),
            tw.Holder(middle.surface(END), force=0.0),
        ],
        degree=2,
    )


def pulled(model, **history):
    press, base, middle = model.holders
    history = tw.LoadHistory(["0 s", "1 s"], **history)
    return replace(model, holders=[press, base, replace(middle, history=history)])


def test_a_block_that_is_pulled_obliquely(clamped):
    """requirement: both contacts slip, friction of 2 mu F opposes the motion in the plane, and each
    wears by its energy.
    """
    model = pulled(
        clamped,
        tangential_displacement=["0 um", "90 um"],
        tangential_displacement_y=["0 um", "120 um"],
    )
    solution = model.fretting(increments=4)
    force = solution.summary["holders"]["middle"]["tangential_force_N"]
    assert force == pytest.approx(2 * FRICTION * FORCE * 0.6, rel=5e-2)
    row = solution.result.friction.tangential[-1]
    assert row.holder == 3
    assert np.hypot(row.force_x, row.force_y) == pytest.approx(2 * FRICTION * FORCE, rel=1e-2)
    assert row.displacement_y == pytest.approx(120e-6, rel=1e-12)
    for name in ("upper-middle", "lower-middle"):
        found = solution.summary["contacts"][name]
        assert found["friction_force_N"] == pytest.approx(FRICTION * FORCE, rel=1e-2)
        worn = K / FRICTION * found["dissipated_energy_J"]
        assert found["wear_volume_1_m3"] == pytest.approx(worn, rel=1e-3, abs=0.0)


def test_a_force_along_a_diagonal(clamped):
    """requirement: the friction of both contacts carries 2 mu F, along the diagonal as well."""
    below = [f"{0.66 * FRICTION * 2 * FORCE} N"]
    forces = {"tangential_force": ["0 N", *below], "tangential_force_y": ["0 N", *below]}
    row = pulled(clamped, **forces).fretting(increments=4).result.friction.tangential[-1]
    assert row.force_x == pytest.approx(row.force_y, rel=1e-9)
    beyond = ["0 N", f"{0.72 * FRICTION * 2 * FORCE} N"]
    forces = {"tangential_force": beyond, "tangential_force_y": beyond}
    with pytest.raises(tw.ComputationError, match=r"holders.middle: the holder slides"):
        pulled(clamped, **forces).fretting(increments=4)


def test_quantities_of_histories(clamped):
    """requirement: wrong units and too large turns are refused, with the argument."""
    for key, values, text in (
        ("twist", ["0 mrad", "1 N"], "LoadHistory.twist"),
        ("twist", ["0 deg", "30 deg"], "LoadHistory.twist"),
        ("torque", ["0 N m", "1 N"], "LoadHistory.torque"),
    ):
        with pytest.raises(tw.CaseError, match=text):
            pulled(clamped, **{key: values})
