"""Keys changed from the command line: ``--set KEY=VALUE``."""

from __future__ import annotations

import pytest

import thermowear as tw

from .starter import STEADY, tables

GOOD = [
    ("mesh.degree=6", lambda case: case.mesh.degree, 6),
    (" mesh . degree = 6", lambda case: case.mesh.degree, 6),
    ("contact.friction=0.5", lambda case: case.contact.friction, 0.5),
    ('load.mean_pressure="1 MPa"', lambda case: case.load.mean_pressure, 1e6),
    ("load.mean_pressure=1 MPa", lambda case: case.load.mean_pressure, 1e6),
    ("title=a = b", lambda case: case.title, "a = b"),
    ("mesh.bodies.plate.elements=7", lambda case: case.mesh.face("plate"), (7, 0.3)),
    ("mesh={degree = 3}", lambda case: (case.mesh.degree, case.mesh.elements), (3, 12)),
    ("heat.temperature.plate_side=300 K", lambda case: case.heat.temperature["plate_side"], 300.0),
]


@pytest.mark.parametrize(("text", "read", "value"), GOOD, ids=[good[0] for good in GOOD])
def test_a_key_is_set(text, read, value):
    """
    requirement: --set changes any key; the value is as in TOML, or plain text.
    """
    assert read(tw.load(tables(), (text,))) == value


def test_the_last_of_two_wins():
    """
    requirement: --set can be given many times, in their order.
    """
    assert tw.load(tables(), ("mesh.degree=3", "mesh.degree=4")).mesh.degree == 4


def test_the_tables_handed_in_stay_as_they_are():
    """
    requirement: loading does not change what it is given.
    """
    given = tables()
    tw.load(given, ("mesh.degree=3", "heat.cooling.plate_side=1 W/(m^2 K)"))
    assert given == tables(STEADY)


BAD = [
    ("mesh.degree", "--set mesh.degree: must be KEY=VALUE"),
    ("=6", "--set =6: must be KEY=VALUE"),
    ("mesh..degree=6", "--set mesh..degree=6: must be KEY=VALUE"),
    ("", "--set : must be KEY=VALUE"),
    ("title.x=1", "--set title.x=1: title is not a table"),
    ("mesh.degree.x=1", "--set mesh.degree.x=1: degree is not a table"),
    ("mesh.degree=", "mesh.degree: found ''; must be a whole number"),
    ("mesh.degree=six", "mesh.degree: found 'six'; must be a whole number"),
    ("mesh.degre=6", "mesh.degre: unknown key; did you mean degree?"),
    ("load.mean_pressure=50", "load.mean_pressure: found 50; needs a quantity with its unit"),
    ("mesh.elements=" + "9" * 5000, "mesh.elements: found '999"),
]


@pytest.mark.parametrize(("text", "fault"), BAD, ids=[bad[0][:20] for bad in BAD])
def test_a_wrong_override_is_one_fault(text, fault):
    """
    requirement: a malformed --set is refused, a wrong value is reported at its key.
    """
    with pytest.raises(tw.CaseError) as caught:
        tw.load(tables(), (text,))
    (line,) = caught.value.faults
    assert line.startswith(fault)
