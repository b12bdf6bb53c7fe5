"""The principle against closed forms and perturbations, without finite elements."""

import pytest

from thermowear.verification import minimality
from thermowear.verification.cases.steady.special_cases import SPECIAL_CASES
from thermowear.verification.check import identified, printed


@pytest.mark.parametrize("case", SPECIAL_CASES)
def test_special_case(case):
    """requirement: every number of the special cases to all digits given, by the generic solver."""
    checks = list(identified("case-1", case)())
    assert len(checks) >= 15
    assert all(check.source and check.id == "case-1" for check in checks)
    assert len({check.quantity for check in checks}) == len(checks)
    assert not [check for check in checks if not check.passed]


@pytest.mark.slow
def test_minimality():
    """requirement: of 1 000 random admissible pressures per case none has less than the minimum."""
    checks = list(minimality())
    assert len(checks) > 100
    assert not [check for check in checks if not check.passed]


def test_printed_numbers_are_held_to_the_last_digit():
    """requirement: half a unit of the last digit, whatever the exponent."""
    for text, inside, outside in (
        ("2.038987", 2.0389874, 2.0389876),
        ("350", 350.49, 350.51),
        ("1.130360", 1.1303604, 1.1303606),
        ("2.4547e8", 2.45474e8, 2.45476e8),
    ):
        assert printed("y", inside, text).passed
        assert not printed("y", outside, text).passed
