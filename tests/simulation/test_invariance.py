"""Random cases otherwise: what changes nothing changes no result.

One of each change is run always. ``THERMOWEAR_INVARIANCE=N`` in the environment asks for N of each
in the slow tests (2 000 in all by default), ``THERMOWEAR_SEED=M`` for others::

    THERMOWEAR_INVARIANCE=20 THERMOWEAR_SEED=1000 pytest -s tests/simulation/test_invariance.py
"""

from __future__ import annotations

import os

import numpy as np
import pytest

from thermowear.errors import ComputationError

from ..app.calibration.test_calibrate import in_any_order
from ..test_parallel import pytestmark as needs_mpirun
from ..test_parallel import same_on_two_ranks
from .invariance import CHANGES, LABELS, MOVED, differences, run, within_estimates
from .invariance_on_ranks import computed

MANY = int(os.environ.get("THERMOWEAR_INVARIANCE", "134"))
FIRST = int(os.environ.get("THERMOWEAR_SEED", "0"))
_FOUND = (
    (203, "rotation"),  # pressures of rounding
    (306, "rotation"),  # a size along the axes of coordinates
    (417, "mirror"),  # points between facets that counted as points of the first one only
    (2029, "mirror"),
    (153, "mirror"),  # sizes of steps in which rounding grew: penalty in a section,
    (2949, "mirror"),  # in space,
    (615, "mirror"),  # and Nitsche's method
    (508, "mirror"),  # points that begin to press by what others wore
    (27, "mirror"),  # a pad that touches right below its pivot
    (30, "in_python"),
    (76, "order_of_bodies"),  # faces that come to stick and wear by a slip of rounding
)
"""What random cases found."""
_ON_RANKS = 10
"""Cases that one start of the ranks computes."""


def fault(change: str, seed: int, folder) -> str:
    """What a change of a random case changes; empty if nothing."""
    folder.mkdir()
    scene, other = CHANGES[change](seed)
    where = f"{change}, seed {seed} ({scene.model}, {scene.tables['analysis']['type']})"
    outcomes = []
    for one, runs in ((scene, run), (other.scene, other.run or run)):
        try:
            outcomes.append(runs(one, folder / str(len(outcomes))))
        except ComputationError as error:
            outcomes.append(error)
    known, found = outcomes
    failed = [isinstance(outcome, ComputationError) for outcome in outcomes]
    if any(failed):
        return "" if all(failed) else f"{where}: only one of both fails: {outcomes[failed[1]]}"
    compared = within_estimates if other.bound is None else differences
    return "\n".join(
        f"{where}: {check.quantity}: {check.computed:.9g}, not {check.reference:.9g}; "
        f"by {check.error:.2g} of its scale, allowed are {check.allowed:.2g}"
        for check in compared(known, found, other)
        if not check.passed
    )


@pytest.mark.parametrize(("seed", "change"), [*enumerate(CHANGES, FIRST), *_FOUND])
def test_nothing_changes(seed, change, tmp_path):
    """
    requirement: order and labels to 1e-12, rotation and units to 1e-9 of the scale of each
    quantity; where meshes or methods differ, within three times the estimates of both errors.
    """
    told = fault(change, seed, tmp_path / "case")
    assert not told, told


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_nothing_changes_in_many(change, tmp_path):
    """requirement: the same of many random cases."""
    seeds = range(FIRST, FIRST + MANY)
    faults = [told for seed in seeds if (told := fault(change, seed, tmp_path / str(seed)))]
    assert not faults, "\n".join(faults)


@needs_mpirun
@pytest.mark.parametrize(
    "first",
    [
        FIRST,
        *(
            pytest.param(seed, marks=pytest.mark.slow)
            for seed in range(FIRST + 1, FIRST + MANY, _ON_RANKS)
        ),
    ],
)
def test_two_ranks(first, tmp_path):
    """
    requirement: the columns of random cases on two ranks, with the other face of each contact named
    first, are those of one, to 1e-9.
    """
    count = 1 if first == FIRST else _ON_RANKS
    known = computed(first, count, tmp_path / "known", exchanged=False)
    same_on_two_ranks(
        "tests.simulation.invariance_on_ranks",
        tmp_path,
        known,
        first,
        count,
        rtol=MOVED,
        timeout=300 * count,  # ranks that wait leave the core, and get it back late at load
    )


@pytest.mark.parametrize(
    "seed", [FIRST, *(pytest.param(FIRST + k, marks=pytest.mark.slow) for k in range(1, MANY))]
)
def test_order_of_observations(seed, tmp_path):
    """requirement: tests and their rows in any order give the same calibration to 1e-12."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 6))
    given = rng.uniform(2, 10, count).round(3), rng.uniform(-0.03, 0.03, count)
    known = in_any_order(tmp_path, range(count), False, *given)
    for backwards in (False, True):
        found = in_any_order(tmp_path, rng.permutation(count), backwards, *given)
        assert found.values == pytest.approx(known.values, rel=LABELS, abs=0.0)
        errors = known.standard_errors
        assert found.standard_errors == pytest.approx(errors, rel=LABELS, abs=0.0)
