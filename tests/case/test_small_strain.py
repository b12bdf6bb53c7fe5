"""Loads that small strains cannot bear, of drawn geometries."""

import pytest

import thermowear as tw
from thermowear.errors import CaseError

from .starter import tables


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("annular-punch", ("load.mean_pressure", "1e12 MPa"), "load: a mean pressure of 1e+12 MPa"),
        ("tube-in-support", ("load.force", "1e13 N"), "load: a mean pressure of 1.053e"),
        ("ball-in-socket", ("load.force", "1e13 N"), "load: a mean pressure of 1.74"),
        ("two-shoe-drum", ("holders.left_shoe.force", "1e13 N"), "holders.left_shoe.force: a mean"),
    ],
)
def test_a_load_beyond_small_strains_is_refused(name, change, message):
    """requirement: as for mesh files, where the mean pressure is a large part of a modulus."""
    given = tables(name, {change[0]: change[1]})
    with pytest.raises(CaseError, match=message.replace("+", r"\+")):
        tw.load(given).tagged_mesh()
