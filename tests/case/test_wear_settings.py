"""Settings beside the wear laws of the bodies, in one table."""

import pytest

from thermowear.case import as_plain, load
from thermowear.errors import CaseError
from thermowear.verification.check import starter

NAME = "annular-punch-running-in"


def test_bodies_are_all_that_is_iterated():
    case = starter(NAME, "wear.update=0.02")
    assert list(case.wear) == ["punch"]
    assert "update" not in case.wear
    assert "punch" in case.wear
    assert len(case.wear) == 1
    assert case.wear["punch"].pressure_exponent == 1.0


@pytest.mark.parametrize(
    "override", ['wear.update="never"', 'wear.update="auto"', "wear.update=0.02"]
)
def test_round_trip(override):
    case = starter(NAME, override)
    assert load(as_plain(case)) == case


def test_how_much_is_kept():
    assert starter(NAME).wear.largest_kept == 0.01
    assert starter(NAME, "wear.update=0.2").wear.largest_kept == 0.2
    assert starter(NAME, 'wear.update="never"').wear.largest_kept == float("inf")


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("wear.update=often", 'wear.update: found \'often\'; must be "auto", "never", or a number'),
        ("wear.update=0.0", "wear.update: found 0.0; must be"),
        ("wear.update=true", "wear.update: found True; must be"),
        ("wear.updat=0.1", "wear.updat: found 0.1; must be a table"),
        ("wear.nobody.coefficient=1e-8 1/MPa", "wear.nobody: unknown name in this geometry"),
        (
            "wear.punch.coeficient=1",
            "wear.punch.coeficient: unknown key; did you mean",
        ),
    ],
)
def test_faults(override, message):
    with pytest.raises(CaseError, match=r"^wear\.") as caught:
        starter(NAME, override)
    assert message in str(caught.value)


def test_sizes_of_updates_are_for_meshes_that_move():
    with pytest.raises(CaseError, match="geometry updates are not supported in a steady analysis"):
        starter("annular-punch", "wear.update=0.1")
    transient = 'analysis={type="transient", end_time="1 s"}'
    assert starter("rectangular-punch", transient, "wear.update=0.1").wear.largest_kept == 0.1
