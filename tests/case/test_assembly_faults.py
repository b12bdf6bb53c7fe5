"""Faults of cases of several bodies: bodies that nothing holds, and keys without an effect."""

import pytest

import thermowear as tw
from thermowear.errors import CaseNote
from thermowear.simulation.from_case import model_of
from thermowear.verification.cases.assembly.pad_disk_pad import Brake
from thermowear.verification.check import starter

from .starter import GONE, changed

RING = Brake("floating", 9.0, heated=True).tables("steady")
"""Disk that floats between two pads, axisymmetric and hot."""
_SLIP = {"motions.disk": {"velocity": "1 m/s"}, "geometry.thickness": "1 m"}
SECTION = changed(RING, {"model": "plane-strain", "heat": GONE, **_SLIP})
"""Section of a bar between two blocks."""
GLUED = changed(
    RING,
    {
        "holders.hub": GONE,
        "contacts.left": {"between": ["left_bottom", "disk_top"], "tie": True},
        "wear.left": GONE,
    },
)
"""Pad glued on the disk."""
IN_TIME = {"analysis": {"type": "transient", "end_time": "1 s"}}
WARMER = {"time": ["0 s", "1 s"], "temperature": ["20 degC", "30 degC"]}
RISING = {"time": ["0 s", "1 s"], "force": ["1 N", "2 N"]}
COLD = {"heat": GONE}
FAULTS = [
    (RING, {"holders": {}}, "holders", "needs a force"),
    (GLUED, {"holders.hub": {"surface": "disk_inside"}}, "holders.hub.surface", "glued to left"),
    (GLUED, {"bodies.disk.fixed": "disk_inside"}, "bodies.disk.fixed", "glued to left"),
    (GLUED, {"wear.left": {"coefficient": "1e-7 1/MPa"}}, "wear.left", "no effect"),
    (GLUED, {"motions.left": {"angular_velocity": "1 rad/s"}}, "motions.left", "that of disk"),
    (RING, {"holders.left.moments": ["0 N m", "0 N m", "1 N m"]}, "holders.left.moments", "no eff"),
    (RING, {"holders.left.tangential_force": "1 N"}, "holders.left.tangential_force", "no effect"),
    (RING, {"holders.left.pivot": ["1 m", "0 m"]}, "holders.left.pivot", "no effect"),
    (RING, {"holders.left.direction": [0.5, -1]}, "holders.left.direction", "along the axis"),
    (RING, {"motions.disk.center": ["1 m", "0 m"]}, "motions.disk.center", "no effect"),
    (RING, COLD | {"contacts.left.conductance": "1 W/(m^2 K)"}, "contacts.left.conductance", "no"),
    (RING, COLD | {"contacts.left.partition": 0.5}, "contacts.left.partition", "no effect"),
    (
        RING,
        {"bodies.right": {"like": "left", "density": "1 kg/m^3"}},
        "bodies.right.density",
        "lik",
    ),
    (
        RING,
        {"heat.temperature": {"left_top": "20 degC"}},
        "heat.cooling.left_top",
        "already has a prescribed temperature",
    ),
    (RING, {"heat.initial": "50 degC"}, "heat.initial", "requires temperatures in time"),
    (
        RING,
        IN_TIME | {"heat.ambient_history": WARMER},
        "heat.ambient_history",
        "requires temperatures in time",
    ),
    (
        RING,
        {"contact.friction": 0.0, "wear": {"left": {"coefficient": "1 1/MPa", "per": "pressure"}}},
        "contacts",
        "friction heat needs friction",
    ),
    (
        RING,
        {"holders.left": {"surface": "left_top", "approach": "1 um"}},
        "holders",
        "wear unloads the contacts",
    ),
    (RING, IN_TIME | {"holders.left.history": RISING}, "holders.left.force", "cannot be given"),
    (
        RING,
        {
            "holders.hub": GONE,
            "bodies.disk.fixed": "disk_inside",
            "load": {"pressure": {"disk_inside": "1 MPa"}},
        },
        "load.pressure.disk_inside",
        "has no effect",
    ),
    (SECTION, {"holders.left.tangential_force": "1 N"}, "holders.left.tangential_force", '"x"'),
    (SECTION, {"holders.left.moments": ["0 J", "0 J", "1 J"]}, "holders.left.moments", "rotate"),
    (
        SECTION,
        {"holders.left.free": ["z", "rotation"], "holders.left.moments": ["1 J", "0 J", "0 J"]},
        "holders.left.moments",
        "only the last one",
    ),
    (SECTION, {"motions.disk.center": ["1 m", "0 m"]}, "motions.disk.center", "no effect"),
    (
        SECTION,
        {"motions.disk": {"angular_velocity": "1 rad/s", "across": True}},
        "motions.disk.across",
        "needs a velocity",
    ),
    (
        SECTION,
        IN_TIME
        | {"holders.left": {"surface": "left_top", "free": ["z", "x"], "history": RISING}}
        | {"holders.left.tangential_force": "1 N"},
        "holders.left.tangential_force",
        "cannot be combined with",
    ),
    (
        RING,
        COLD | {"contacts.left.friction": 0.0, "wear.left": {"rate": "1e-7/MPa*mu*p*v"}},
        "contacts.left.friction",
        "wear.left.rate depends on mu",
    ),
    (
        RING,
        {"contacts.left.pressure_degree": 4},
        "contacts.left.pressure_degree",
        "mesh.degree = 3",
    ),
    (
        RING,
        {"contacts.left.between": ["left_bottom", "disk_top", "right_top"]},
        "contacts.left.between",
        "must have at most 2 values",
    ),
    (GLUED, {"contacts.left.gap_conductance": "1 W/(m^2 K)"}, "contacts.left.gap_conductance", ""),
    (GLUED, {"contacts.left.pressure_degree": 1}, "contacts.left.pressure_degree", "tie"),
    (GLUED, {"contacts.left.transverse_friction": 0.1}, "contacts.left.transverse_friction", "tie"),
]


@pytest.mark.parametrize(("tables", "changes", "path", "text"), FAULTS)
def test_faults(tables, changes, path, text):
    """requirement: one line with the path of the key, and what is wrong."""
    with pytest.raises(tw.CaseError) as caught:
        tw.load(changed(tables, changes))
    (line,) = caught.value.faults
    assert line.startswith(f"{path}: ")
    assert text in line


@pytest.mark.parametrize("tables", [RING, SECTION, GLUED])
def test_without_them(tables):
    """requirement: the cases are valid without the faults, and complete."""
    case = tw.load(tables)
    assert case.bodies.keys() == tables["bodies"].keys()
    assert set(case.sliding_bodies) <= set(case.geometry.bodies)
    assert all(contact.between for contact in case.contacts.values())


def test_planes_that_a_holder_would_move():
    """requirement: a free motion that moves a plane of symmetry; one along it is no fault."""
    case = changed(SECTION, {"bodies.left.symmetry": "left_inside", "motions.disk.across": True})
    tw.load(case)
    for motion in ("x", "rotation"):
        with pytest.raises(tw.CaseError, match=rf"^holders.left.free: '{motion}' contradicts"):
            tw.load(changed(case, {"holders.left.free": ["z", motion]}))


def test_supports_on_a_held_surface_move_with_it():
    """requirement: a back on rollers, held along the axis only, is no contradiction."""
    case = tw.load(changed(RING, {"bodies.left.rollers": "left_top"}))
    left = next(body for body in model_of(case).bodies if body.name == "left")
    assert left.rollers == ("left_top",)
    assert "left_top" not in left.fixed


def test_default_of_wear_coefficients():
    """requirement: a coefficient per friction stress by default is noted, as for two bodies."""
    with pytest.warns(CaseNote, match=r"^wear\.left\.per is left out.* wears 2\.5 times as fast"):
        tw.load(changed(RING, {"wear.left": {"coefficient": "1e-7 1/MPa"}}))


def test_pressures_at_nodes_are_for_sections():
    """requirement: the key is named for several bodies in space as for two."""
    with pytest.raises(tw.CaseError, match=r"contacts.upper.pressure_degree: not supported in 3d"):
        starter("two-pads-3d", 'contacts.upper.pressure_degree="lobatto"')
