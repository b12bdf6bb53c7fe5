"""Junk anywhere in a case is a fault of the case, never of the program."""

from __future__ import annotations

import datetime

from hypothesis import given, settings
from hypothesis import strategies as st

import thermowear as tw
from thermowear.case.starters import starters

from ..conftest import examples
from .starter import paths, tables

PLACES = [
    (name, path)
    for name in starters()
    for path in paths(tables(name))
    if not path.startswith("geometry.surfaces")  # names that other keys refer to
]
# no towers of powers: a text of ten characters can stand for more digits than there is memory
words = st.text(max_size=12).filter(lambda text: "^" not in text and "**" not in text)
quantities = st.builds(
    "{} {}".format,
    st.floats() | st.integers(),
    st.sampled_from(
        ["Pa", "mm", "K", "degC", "W/(m^2 degC)", "1/MPa^0.5", "", "%", "dB", "m/0", "("]
    ),
)
scalars = (
    words
    | quantities
    | st.floats()
    | st.integers()
    | st.booleans()
    | st.sampled_from([datetime.date(2020, 2, 2), datetime.time(12)])
    | st.sampled_from(["punch", "steady", "transient"])
)
junk = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(
        st.sampled_from(["type", "like", "elements", "a.b", "x\ny"]) | words, inner, max_size=3
    ),
    max_leaves=6,
)


def related(fault: str, path: str) -> bool:
    """Test whether a fault names the key, or is reported at it or at another key of its table."""
    table, _, key = path.rpartition(".")
    beside = bool(table) and fault.startswith((f"{table}.", f"{table}: "))
    return fault.startswith((f"{path}.", f"{path}: ")) or beside or key in fault


@given(place=st.sampled_from(PLACES), value=junk)
@settings(max_examples=examples(400), deadline=None, database=None)
def test_junk_at_a_key_is_a_fault_at_that_key(place, value):
    """
    requirement: never a traceback; the fault is found where it was put.
    """
    name, path = place
    try:
        tw.load(tables(name, {path: value}))
    except tw.CaseError as error:
        assert error.faults
        assert all(related(fault, path) for fault in error.faults), error.faults


@given(place=st.sampled_from(PLACES), key=words.filter(lambda key: "." not in key), value=junk)
@settings(max_examples=examples(150), deadline=None, database=None)
def test_a_key_of_junk_is_unknown(place, key, value):
    """
    requirement: unknown keys are refused in every table, by their path.
    """
    name, path = place
    table = path.rpartition(".")[0]
    place = f"{table}.{key}" if table else key
    if place in paths(tables(name)):
        return
    try:
        tw.load(tables(name, {place: value}))
    except tw.CaseError as error:
        assert any(fault.startswith(place) for fault in error.faults), error.faults
    else:
        raise AssertionError(f"accepted {place} = {value!r}")


@given(text=st.text(max_size=60))
@settings(max_examples=examples(150), deadline=None, database=None)
def test_any_override_is_taken_or_refused(text):
    """
    requirement: never a traceback for what stands behind --set.
    """
    try:
        case = tw.load(tables(), (text,))
    except tw.CaseError as error:
        assert error.faults
    else:
        assert "=" in text
        assert tw.load(tw.case.as_plain(case)) == case
