"""Entries of parts by their names, and of the only part without a name."""

from thermowear.results.short_names import by_name


def test_entries_of_a_part_without_a_name_are_those_of_the_whole():
    """requirement: short cases have short keys, others tables by names."""
    entry = {"max_pressure_Pa": 1.0}
    assert by_name("contacts", {"": entry}) == entry
    assert by_name("contacts", {"left": entry}) == {"contacts": {"left": entry}}
    assert by_name("contacts", {}) == {}


def test_the_entries_are_not_shared():
    """requirement: a summary can be extended without a change of what it was made from."""
    entry = {"max_pressure_Pa": 1.0}
    by_name("contacts", {"": entry})["time_s"] = 0.0
    by_name("contacts", {"left": entry})["contacts"]["left"]["time_s"] = 0.0
    assert entry == {"max_pressure_Pa": 1.0}
