"""Reference values of the demo summaries, for all releases of dolfinx and all machines.

After a change that is meant to change them: ``scripts/env python3 -m tests.test_golden``.
"""

import json
from pathlib import Path

import pytest

import thermowear as tw

from .conftest import COLD_RUNNING_IN, HOT

GOLDEN = Path(__file__).with_name("golden.json")
NOISE = {"distance_from_steady"}


def numbers(summary):
    return {
        key: value
        for key, value in summary.items()
        if isinstance(value, int | float)
        and key not in NOISE
        and not key.endswith("relative_error")
        and "error_estimate" not in key
    }


@pytest.mark.parametrize("demo", ["hot_steady", "running_in"])
def test_summary_is_the_known_one(demo, request):
    """requirement: every number of the summary within 1e-7 on dolfinx 0.9 to 0.11."""
    known = json.loads(GOLDEN.read_text())[demo]
    found = numbers(request.getfixturevalue(demo).summary)
    assert set(found) == set(known)
    for key, value in known.items():
        assert found[key] == pytest.approx(value, rel=1e-7), key


if __name__ == "__main__":
    cases = {"hot_steady": HOT, "running_in": COLD_RUNNING_IN}
    found = {name: numbers(tw.run(tw.load(path)).summary) for name, path in cases.items()}
    GOLDEN.write_text(json.dumps(found, indent=2) + "\n")
