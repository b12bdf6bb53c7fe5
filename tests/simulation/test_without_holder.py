"""Bodies without a holder: on supports alone, or hanging on their contact."""

import math

import numpy as np
import pytest

import thermowear as tw
from thermowear.geometry.mesh.gmsh_session import gmsh_model

from ..ring_meshes import Ring, write_rings

STEEL = {"young_modulus": "210 GPa", "poisson_ratio": 0.3}
OVERLAP, RADII = 2.5e-3, (10.0, 20.0, 30.0)
"""Radial overlap of the rings, and their radii [mm]."""


def lame(overlap, one=210e9, other=210e9, nu=0.3):
    """Pressure of a ring pressed into another by a radial overlap [m] (Lamé)."""
    a, R, b = (1e-3 * r for r in RADII)
    inner = ((R**2 + a**2) / (R**2 - a**2) - nu) / one
    outer = ((b**2 + R**2) / (b**2 - R**2) + nu) / other
    return overlap / (R * (inner + outer))


def write_sections(path, rectangles):
    """Write rectangles, ``name: (r_0, r_1, z_0, z_1)`` [mm], with their sides by names."""
    with gmsh_model("sections") as gmsh:
        for tag, (name, (left, right, low, high)) in enumerate(rectangles.items(), start=1):
            gmsh.model.occ.addRectangle(left, low, 0.0, right - left, high - low, tag)
            gmsh.model.occ.synchronize()
            gmsh.model.addPhysicalGroup(2, [tag], name=name)
            for _, side in gmsh.model.getBoundary([(2, tag)], oriented=False):
                x, y, _ = gmsh.model.occ.getCenterOfMass(1, side)
                ends = (x, left, "IN"), (x, right, "OUT"), (y, low, "BOTTOM"), (y, high, "TOP")
                end = next(n for at, v, n in ends if math.isclose(v, at, abs_tol=1e-9))
                gmsh.model.addPhysicalGroup(1, [side], name=f"{name}_{end}")
                gmsh.model.mesh.setTransfiniteCurve(side, 5)
            gmsh.model.mesh.setTransfiniteSurface(tag)
            gmsh.model.mesh.setRecombine(2, tag)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(path))
    return path


def case(path, model, bodies, between, **tables):
    surfaces = {
        "axisymmetric": ("IN", "OUT", "BOTTOM", "TOP"),
        "3d": ("INSIDE", "OUTSIDE", "BOTTOM", "START", "END"),
    }
    geometry = {
        "type": "file",
        "path": str(path),
        "length_unit": "1 mm",
        "bodies": {name: name.upper() for name in bodies},
        "surfaces": {n: [f"{n.upper()}_{s}" for s in surfaces[model]] for n in bodies},
    }
    return {
        "model": model,
        "geometry": geometry,
        "mesh": {"degree": 3},
        "bodies": bodies,
        "contacts": {"fit": {"between": between}},
        "analysis": {"type": "initial"},
    } | tables


@pytest.fixture(scope="module")
def rings(tmp_path_factory):
    """Sections of a ring with an overlap inside another one, and without any."""

    def write(overlap):
        inner, middle, outer = RADII
        fit = {"SHAFT": (inner, middle + overlap, 0.0, 20.0), "HUB": (middle, outer, 0.0, 20.0)}
        return write_sections(tmp_path_factory.mktemp("rings") / "fit.msh", fit)

    return write


def test_press_fit(rings):
    """requirement: an overlap presses rings on rollers alone: uniform pressure of Lamé."""
    bodies = {name: STEEL | {"rollers": f"{name.upper()}_BOTTOM"} for name in ("shaft", "hub")}
    given = case(rings(OVERLAP), "axisymmetric", bodies, ["SHAFT_OUT", "HUB_IN"])
    result = tw.run(tw.load(given))
    assert result.interface.pressure == pytest.approx(lame(1e-3 * OVERLAP), rel=1e-3)
    expected = lame(1e-3 * OVERLAP) * 2 * math.pi * 0.02 * 0.02
    assert result.summary["contacts"]["fit"]["contact_force_N"] == pytest.approx(expected, rel=1e-3)
    assert result.summary["contacts"]["fit"]["normal_force_N"] < 1e-9 * expected
    assert result.summary["holders"] == {}


def test_press_fit_in_space(tmp_path):
    """requirement: the same of a quarter in space, on three planes of symmetry."""
    inner, middle, outer = RADII
    quarter, cells = (0.0, math.pi / 2), (3, 8, 1)
    fit = Ring("SHAFT", (inner, middle + OVERLAP), (0.0, 8.0), quarter, cells)
    path = write_rings(
        tmp_path / "fit.msh", [fit, Ring("HUB", (middle, outer), (0.0, 8.0), quarter, cells)]
    )
    bodies = {
        name: STEEL
        | {
            "rollers": f"{name.upper()}_START",
            "symmetry": f"{name.upper()}_END",
            "mid_plane": f"{name.upper()}_BOTTOM",
        }
        for name in ("shaft", "hub")
    }
    given = case(path, "3d", bodies, ["SHAFT_OUTSIDE", "HUB_INSIDE"], mesh={"degree": 2})
    result = tw.run(tw.load(given))
    assert result.interface.pressure == pytest.approx(lame(1e-3 * OVERLAP), rel=0.01)
    del bodies["hub"]["mid_plane"]
    with pytest.raises(tw.CaseError, match=r"^bodies\.hub: .* contacts hold it along z; needs"):
        tw.run(tw.load(given))


def test_a_warm_ring_in_another(rings):
    """requirement: heat presses rings that touch: overlap ``R T (α_1 - α_2)`` of free rings."""
    bodies = {
        name: STEEL
        | {"young_modulus": f"{E} Pa", "conductivity": "10 W/(m K)", "expansion": f"{α} 1/K"}
        | {"rollers": f"{name.upper()}_BOTTOM"}
        for name, E, α in (("shaft", 200e9, 2e-5), ("hub", 100e9, 1e-5))
    }
    warm = {"SHAFT_IN": "120 degC", "HUB_OUT": "120 degC"}
    given = case(rings(0.0), "axisymmetric", bodies, ["SHAFT_OUT", "HUB_IN"])
    given["heat"] = {"ambient": "20 degC", "temperature": warm}
    result = tw.run(tw.load(given))
    expected = lame(0.02 * 100 * 1e-5, 200e9, 100e9)
    assert result.interface.pressure == pytest.approx(expected, rel=1e-3)


def test_nothing_presses(rings):
    """requirement: faces that just touch and no load: one line, at the check of the case."""
    bodies = {name: STEEL | {"rollers": f"{name.upper()}_BOTTOM"} for name in ("shaft", "hub")}
    given = case(rings(0.0), "axisymmetric", bodies, ["SHAFT_OUT", "HUB_IN"])
    with pytest.raises(tw.CaseError, match=r"^holders: nothing is pressed"):
        tw.load(given).tagged_mesh()


@pytest.mark.parametrize("method", ["alone", "glued"])
def test_a_body_that_hangs_on_its_contact(tmp_path, method):
    """requirement: a disk without supports, pressed by a pressure, lies on the plate with exactly
    its resultant; so does one that is glued to it.
    """
    disks = {"PLATE": (0.0, 20.0, 0.0, 10.0), "DISK": (0.0, 10.0, 10.0, 20.0)}
    disks |= {"CAP": (0.0, 10.0, 20.0, 25.0)} if method == "glued" else {}
    path = write_sections(tmp_path / "disks.msh", disks)
    bodies = {"plate": STEEL | {"fixed": "PLATE_BOTTOM"}} | {
        name.lower(): STEEL for name in disks if name != "PLATE"
    }
    top = "CAP_TOP" if method == "glued" else "DISK_TOP"
    given = case(path, "axisymmetric", bodies, ["DISK_BOTTOM", "PLATE_TOP"])
    given["load"] = {"pressure": {top: "3 MPa"}}
    if method == "glued":
        given["contacts"]["joint"] = {"between": ["CAP_BOTTOM", "DISK_TOP"], "tie": True}
    result = tw.run(tw.load(given))
    force = float(result.interface.weight @ result.interface.pressure)
    assert force == pytest.approx(3e6 * math.pi * 0.01**2, rel=1e-9)
    assert result.summary["equilibrium_relative_error"] < 1e-9
    assert np.all(np.isfinite(result.interface.gap))
