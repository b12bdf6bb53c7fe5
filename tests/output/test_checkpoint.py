"""Checkpoints, drafts and locks on disk."""

import errno
import os

import numpy as np
import pytest

import thermowear as tw
from thermowear.output.checkpoint import CHECKPOINT, read_checkpoint, write_checkpoint
from thermowear.output.lock import Lock
from thermowear.output.quantities import HISTORY
from thermowear.output.replacing import final_name, replacing
from thermowear.output.tables import RowWriter, read
from thermowear.simulation import HistoryRow

ABOUT, ARRAYS = {"time": 0.1, "case": {"title": "µ"}}, {"a0": np.arange(3.0), "b@1": np.eye(2)}


def test_a_checkpoint_is_read_as_it_was_written(tmp_path):
    """requirement: to the last bit, and without pickle."""
    assert read_checkpoint(tmp_path) is None
    write_checkpoint(tmp_path, ABOUT, ARRAYS)
    about, arrays = read_checkpoint(tmp_path)
    assert about == {"format": 1} | ABOUT
    assert arrays.keys() == ARRAYS.keys()
    for name, values in ARRAYS.items():
        np.testing.assert_array_equal(arrays[name], values)
    assert [path.name for path in tmp_path.iterdir()] == [CHECKPOINT]
    with pytest.raises(ValueError, match="pickle"):
        write_checkpoint(tmp_path, ABOUT, {"a0": np.array([object()])})
    assert read_checkpoint(tmp_path)[0]["time"] == 0.1


@pytest.mark.parametrize("fails", ["fsync", "replace"])
def test_a_disk_that_fails_leaves_the_last_checkpoint(fails, monkeypatch, tmp_path):
    """requirement: whatever goes wrong on the way, and its room is free again."""
    write_checkpoint(tmp_path, ABOUT, ARRAYS)

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, fails, full)
        with pytest.raises(OSError, match="No space"):
            write_checkpoint(tmp_path, ABOUT | {"time": 0.2}, ARRAYS)
    assert read_checkpoint(tmp_path)[0]["time"] == 0.1
    assert [path.name for path in tmp_path.iterdir()] == [CHECKPOINT]


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 half a file", b"no zip at all"])
def test_other_files_are_refused(content, tmp_path):
    (tmp_path / CHECKPOINT).write_bytes(content)
    with pytest.raises(tw.CaseError, match=r"checkpoint\.npz"):
        read_checkpoint(tmp_path)


def test_a_later_format_is_refused(tmp_path):
    write_checkpoint(tmp_path, ABOUT | {"format": 2}, ARRAYS)
    with pytest.raises(tw.CaseError, match="format 2"):
        read_checkpoint(tmp_path)


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old", "utf-8")

    def interrupted():
        with replacing(path) as draft:
            draft.write_text("half", "utf-8")
            assert (path.read_text("utf-8"), final_name(draft)) == ("old", "table.csv")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [p.name for p in tmp_path.iterdir()] == ["table.csv"]
    with replacing(path) as draft:
        draft.write_text("new", "utf-8")
    assert (path.read_text("utf-8"), final_name(path)) == ("new", "table.csv")


def test_a_table_begins_with_known_rows_and_ends_with_a_whole_one(tmp_path):
    """requirement: a row that was cut off is no row."""
    path = tmp_path / "history.csv"
    rows = [HistoryRow(*np.full(10, value).tolist()) for value in (1.0, 2.0, 3.0)]
    path.write_text("what a run that was killed has left", "utf-8")
    RowWriter(path, HISTORY, rows[:2]).add(rows[2])
    with path.open("a") as file:
        file.write("4,4,4,4,4,4,4,4,4,4")  # perhaps 41 or 4.5 in the end
    assert read(path, HISTORY)["error"].tolist() == [1.0, 2.0, 3.0]


def test_a_folder_is_locked_as_long_as_a_run_lives(tmp_path):
    first = Lock(tmp_path)
    with pytest.raises(tw.CaseError, match="another run"):
        Lock(tmp_path)
    first.release()
    Lock(tmp_path)
    assert list(tmp_path.iterdir()) == []
