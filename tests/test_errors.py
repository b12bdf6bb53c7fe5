"""Texts of messages."""

from thermowear.errors import percent


def test_percent():
    """requirement: fractions have two digits, without powers of ten."""
    found = [percent(part) for part in (1e-4, 0.0861, 0.996, 1.414, 116.0)]
    assert found == ["0.01 %", "8.6 %", "100 %", "140 %", "12000 %"]
