"""Study as read from its files: tables written and read back, and what matters most."""

from pathlib import Path

import numpy as np
import pytest

from thermowear.inference import SobolIndices, Swings
from thermowear.output.study.folder import read_cells, write_sobol, write_tornado
from thermowear.output.study.record import StudyRecord


def record(**tables):
    columns = {"load.force": "N", "contact.friction": ""}
    empty = {"sample": {}, "quantiles": [], "indices": [], "swings": []}
    return StudyRecord(Path(), {"columns": columns}, model="plane", **(empty | tables))


def test_shares_in_the_squared_swings(tmp_path):
    """requirement: of swings 4 and 3: 0.64 and 0.36; values at low and at high quantiles."""
    low, high = np.array([[8.0], [10.5]]), np.array([[12.0], [7.5]])
    swings = Swings(np.array([10.0]), low, high)
    write_tornado(tmp_path, ["a"], ["load.force_N", "contact.friction"], [1, 0.1], [3, 0.3], swings)
    rows = read_cells(tmp_path / "tornado.csv")
    assert [float(row["output_at_low"]) for row in rows] == [8.0, 10.5]
    assert [float(row["output_at_high"]) for row in rows] == [12.0, 7.5]
    (first, share), (second, other) = record(swings=rows).influence("a")
    assert (first, second) == ("load.force", "contact.friction")
    assert (share, other) == pytest.approx((0.64, 0.36))


def test_indices_keep_their_names_and_ends(tmp_path):
    """requirement: first-order and total indices with their own intervals."""
    first, total = np.array([[0.1], [0.7]]), np.array([[0.3], [0.9]])
    ends = np.array([-0.01, 0.01])[:, None, None]
    found = SobolIndices(first, total, first + ends, total + 2 * ends, np.array([8]), np.array([0]))
    write_sobol(tmp_path, ["a"], ["x", "y"], found)
    rows = read_cells(tmp_path / "sobol.csv")
    for k, row in enumerate(rows):
        for name, value, half in (("first_order", first, 0.01), ("total", total, 0.02)):
            written = [float(row[f"{name}{end}"]) for end in ("", "_lower", "_upper")]
            middle = value[k, 0]
            assert written == pytest.approx([middle, middle - half, middle + half])
    assert record(indices=rows).influence("a") == [("y", 0.9), ("x", 0.3)]
