"""Histories and state-dependent laws of cases of several bodies."""

import pytest

from thermowear.errors import CaseError
from thermowear.verification.check import starter

RAMP = "{time=['0 s','1 s'], factor=[0,1]}"
FORCE = "{time=['0 s','1 s'], force=['100 N','1 kN']}"
PISTON, TIMED = "holders.piston", "analysis={type='transient', end_time='10 s'}"
UNTIL = "analysis={type='transient', until='steady'}"
PER_PRESSURE = "wear.left_pad.per='pressure'", "wear.right_pad.per='pressure'"
ONLY_FORCE = "requires a fretting analysis; a transient one supports force only"


def pulled(key, values):
    """History of a load of the piston."""
    return f"{PISTON}.history={{time=['0 s','1 s'], {key}={values}}}"


@pytest.mark.parametrize(
    ("overrides", "fault"),
    [
        ([f"{PISTON}.history={FORCE}"], f"{PISTON}.history: requires a transient analysis"),
        ([f"motions.disk.history={RAMP}"], "motions.disk.history: requires a transient analysis"),
        (
            [f"contacts.left.friction_history={RAMP}"],
            "contacts.left.friction_history: requires a transient analysis, not steady",
        ),
        (
            [UNTIL, f"motions.disk.history={RAMP}"],
            "under motions.disk.history, where a steady state may be periodic; give end_time only",
        ),
        ([TIMED, pulled("approach", ["1 um", "2 um"])], f"{PISTON}.history.approach: {ONLY_FORCE}"),
        (
            [TIMED, pulled("tangential_force", ["1 N", "2 N"])],
            f"{PISTON}.history.tangential_force: {ONLY_FORCE}",
        ),
        (
            [TIMED, f"{PISTON}.history={{time=['0 s','1 s']}}"],
            f"{PISTON}.history.force: missing; required in a transient analysis",
        ),
        (
            [TIMED, f"{PISTON}.history={FORCE}", f"{PISTON}.tangential_force='3 N'"],
            f"{PISTON}.tangential_force: has no effect in an axisymmetric model",
        ),
        (
            [TIMED, f"contacts.left.friction_history={RAMP}", "contact.friction=0", *PER_PRESSURE],
            "contacts.left.friction_history: has no effect",
        ),
        (["wear.cycles=10"], "wear.cycles: requires a fretting or reciprocating analysis"),
        (
            ["wear.left_pad={rate='1e-7/MPa*p*v*(1+depth/(1 um))'}"],
            "wear.left_pad.rate: depends on depth",
        ),
    ],
)
def test_faults(overrides, fault):
    """requirement: what has no effect, or no steady state, is refused by the path of its key."""
    with pytest.raises(CaseError) as caught:
        starter("disk-brake-two-pads", *overrides)
    assert fault in str(caught.value)


def test_temperatures_need_heat():
    """requirement: laws and factors of temperature in each contact, and of each body."""
    friction = "contacts.left.friction='0.4*(1-1e-3*(T-293.15 K)/(1 K))'"
    factor = "contacts.right.friction_factor.temperature={at=['20 degC','90 degC'], factor=[1,0.5]}"
    with pytest.raises(CaseError) as caught:
        starter("disk-brake-two-pads", friction, factor, without=("heat",))
    assert caught.value.faults == [
        "contacts.right.friction_factor.temperature: needs a [heat] table, which computes the "
        "temperatures",
        "contacts.left.friction: depends on T; requires a [heat] table",
    ]
    assert starter("disk-brake-two-pads", friction, factor).histories == {}


def test_histories_by_key():
    """requirement: loads, speeds, friction and temperatures in time are found with their keys."""
    case = starter("clutch-pack", "contact.friction_history=" + RAMP)
    shared = [f"contacts.{name}.friction_history" for name in case.contacts]
    assert len(shared) == 10
    assert set(shared) < set(case.histories)
    assert any(key.startswith("motions.") for key in case.histories)
