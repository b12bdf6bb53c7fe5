"""Models in Python on a user's mesh give the results of a case file."""

import pytest

import thermowear as tw

from .rings import IN_TIME, case, ring, same


@pytest.mark.parametrize("first", [("plate", "punch"), ("punch", "plate")])
@pytest.mark.parametrize("apart", [False, True])
def test_the_steady_state_of_a_case(first, apart):
    """requirement: the same to 1e-12 with own tags, bodies in any order, on one mesh or on two."""
    model, _, _ = ring(first, apart, other_first=first[0] == "plate")
    same(model.steady().result, tw.run(case()))


def test_the_running_in_of_a_case():
    """requirement: the same to 1e-12, all at once or step by step."""
    model, _, face = ring()
    known = tw.run(case(*IN_TIME))
    whole = model.transient("200 s")
    same(whole.result, known)
    states = list(model.march("200 s"))
    times = [row.time for row in known.history]
    assert [state.time for state in states] == pytest.approx(times, rel=1e-9)
    assert [state.row.max_pressure for state in states] == pytest.approx(
        [row.max_pressure for row in known.history], rel=1e-9
    )
    same(states[-1].snapshot, known)
    assert states[-1].pressure(face).values == pytest.approx(known.interface.pressure, rel=1e-9)
