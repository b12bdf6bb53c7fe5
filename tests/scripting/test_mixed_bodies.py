"""Bodies on users' dolfinx meshes whose cells differ in type or order."""

import shutil

import numpy as np
import pytest

from ..test_parallel import thermowear
from .on_ranks import mixed


def check(found):
    for name, values in found.items():
        np.testing.assert_allclose(values, name == "pressure", atol=1e-9, err_msg=name)


@pytest.mark.parametrize(
    ("orders", "tetrahedra"),
    [
        pytest.param((1, 2), (True, False), marks=pytest.mark.slow),
        ((2, 1), (False, True)),
        ((2, 1), (True,) * 2),
    ],
)
def test_fields_of_blocks_in_series(orders, tetrahedra):
    """requirement: pressure, and T and u at every node of each user's mesh, exact."""
    check(mixed(orders, tetrahedra))


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
def test_fields_on_two_ranks(tmp_path):
    """requirement: the same on distributed meshes."""
    done = thermowear(2, "mixed", tmp_path, module="tests.scripting.on_ranks")
    assert done.returncode == 0, done.stderr
    for rank in (0, 1):
        check(np.load(tmp_path / f"found_{rank}.npz"))
