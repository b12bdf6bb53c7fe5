"""Checkpoints, drafts and locks on disk."""

import errno
import json
import os

import numpy as np
import pytest

import thermowear as tw
from thermowear.output.checkpoint import CHECKPOINT, read_checkpoint, write_checkpoint
from thermowear.output.files import atomic_write, final_name
from thermowear.output.folder import Lock, finite
from thermowear.output.resuming import read_run
from thermowear.output.tables import RowWriter, read
from thermowear.results import HistoryRow
from thermowear.results.quantity import table_of
from thermowear.serialise import Checkpoint

ABOUT, ARRAYS = {"time": 0.1, "case": {"title": "µ"}}, {"a0": np.arange(3.0), "b@1": np.eye(2)}


def test_a_checkpoint_is_read_as_it_was_written(tmp_path):
    """requirement: exact restoration to the last bit, without pickle."""
    assert read_checkpoint(tmp_path / CHECKPOINT) is None
    write_checkpoint(tmp_path / CHECKPOINT, ABOUT, ARRAYS)
    about, arrays = read_checkpoint(tmp_path / CHECKPOINT)
    assert about == ABOUT
    assert arrays.keys() == ARRAYS.keys()
    for name, values in ARRAYS.items():
        np.testing.assert_array_equal(arrays[name], values)
    assert [path.name for path in tmp_path.iterdir()] == [CHECKPOINT]
    with pytest.raises(ValueError, match="pickle"):
        write_checkpoint(tmp_path / CHECKPOINT, ABOUT, {"a0": np.array([object()])})
    assert read_checkpoint(tmp_path / CHECKPOINT)[0]["time"] == 0.1


@pytest.mark.parametrize("fails", ["fsync", "replace"])
def test_a_disk_that_fails_leaves_the_last_checkpoint(fails, monkeypatch, tmp_path):
    """requirement: the previous checkpoint survives any error; the draft is removed."""
    write_checkpoint(tmp_path / CHECKPOINT, ABOUT, ARRAYS)

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, fails, full)
        with pytest.raises(OSError, match="No space"):
            write_checkpoint(tmp_path / CHECKPOINT, ABOUT | {"time": 0.2}, ARRAYS)
    assert read_checkpoint(tmp_path / CHECKPOINT)[0]["time"] == 0.1
    assert [path.name for path in tmp_path.iterdir()] == [CHECKPOINT]


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 half a file", b"no zip at all"])
def test_other_files_are_refused(content, tmp_path):
    (tmp_path / CHECKPOINT).write_bytes(content)
    with pytest.raises(tw.CaseError, match=r"checkpoint\.npz"):
        read_checkpoint(tmp_path / CHECKPOINT)


def test_a_later_format_is_refused(tmp_path):
    write_checkpoint(tmp_path / CHECKPOINT, ABOUT | {"format": 3}, ARRAYS)
    with pytest.raises(tw.CaseError, match="format 3"):
        read_checkpoint(tmp_path / CHECKPOINT)


CRAFTED = {
    "another shape": {"a0": np.arange(4.0)},
    "not a number": {"a0": np.array([0.0, np.nan, 2.0])},
    "another type": {"a0": np.arange(3)},
    "one more": {"a1": np.arange(3.0)},
}


@pytest.mark.parametrize("changed", CRAFTED.values(), ids=CRAFTED)
def test_what_was_not_written_is_refused(changed, tmp_path):
    """requirement: a modified checkpoint is reported in one line."""
    write_checkpoint(tmp_path / CHECKPOINT, ABOUT, ARRAYS)
    with np.load(tmp_path / CHECKPOINT) as file:
        content = dict(file)
    np.savez(tmp_path / CHECKPOINT, **content | changed)
    with pytest.raises(tw.CaseError, match="damaged") as caught:
        read_checkpoint(tmp_path / CHECKPOINT)
    assert len(caught.value.faults) == 1


def test_a_checkpoint_that_swells_is_refused(tmp_path):
    """requirement: compressed entries, which could exhaust the memory, are refused."""
    write_checkpoint(tmp_path / CHECKPOINT, ABOUT, ARRAYS)
    with np.load(tmp_path / CHECKPOINT) as file:
        content = dict(file)
    np.savez_compressed(tmp_path / CHECKPOINT, **content)
    with pytest.raises(tw.CaseError, match="cannot be read: its entries are compressed"):
        read_checkpoint(tmp_path / CHECKPOINT)


@pytest.mark.parametrize("about", ["[]", "1", "null", "{", '"text"', "{}"])
def test_a_head_of_something_else_is_refused(about, tmp_path):
    np.savez(tmp_path / CHECKPOINT, about=np.array(about))
    with pytest.raises(tw.CaseError, match=r"checkpoint\.npz: cannot be read"):
        read_checkpoint(tmp_path / CHECKPOINT)


@pytest.mark.parametrize(
    "outline",
    [
        '{"array": "b"}',
        '{"rows": "HistoryRow", "of": {"time": {"array": "a"}}}',
        '{"rows": "HistoryRow", "of": {"time": 3}}',
        '{"state": "InterfaceState", "of": {}}',
        '{"state": "Popen", "of": {}}',
        '{"dict": [1]}',
        "{}",
        "not JSON",
    ],
)
def test_outlines_of_something_else_are_refused(outline):
    """requirement: an outline is unpacked to a registered state, or reported in one line."""
    with pytest.raises(tw.CaseError, match="--resume"):
        Checkpoint([outline], {"a": np.arange(3.0)}).state(0)


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"status": "done"}', "[" * 100_000])
def test_a_run_of_something_else_is_refused(text, tmp_path):
    (tmp_path / "run.json").write_text(text)
    with pytest.raises(tw.CaseError, match="no run to resume"):
        read_run(tmp_path)


def test_numbers_that_are_not_finite(tmp_path):
    """requirement: the summary is valid JSON and lists numbers that are not finite."""
    summary = {"a": np.inf, "b": [1.0, -np.inf], "c": {"d": np.nan}, "e": 2.0, "f": None}
    found = json.loads(json.dumps(finite(summary), allow_nan=False))
    said = found.pop("not_finite")
    assert found == {"a": None, "b": [1.0, None], "c": {"d": None}, "e": 2.0, "f": None}
    assert said.keys() == {"a", "b.1", "c.d"}
    assert said["b.1"].startswith("-inf")
    assert "not_finite" not in finite({"a": 1.0})


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old", "utf-8")

    def interrupted():
        with atomic_write(path) as draft:
            draft.write_text("half", "utf-8")
            assert (path.read_text("utf-8"), final_name(draft)) == ("old", "table.csv")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [p.name for p in tmp_path.iterdir()] == ["table.csv"]
    with atomic_write(path) as draft:
        draft.write_text("new", "utf-8")
    assert (path.read_text("utf-8"), final_name(path)) == ("new", "table.csv")


def test_a_table_begins_with_known_rows_and_ends_with_a_whole_one(tmp_path):
    """requirement: an incomplete row is ignored."""
    path = tmp_path / "history.csv"
    rows = [HistoryRow(*np.full(15, value).tolist()) for value in (1.0, 2.0, 3.0)]
    path.write_text("what a run that was killed has left", "utf-8")
    RowWriter(tmp_path, table_of(HistoryRow), rows[:2]).add(rows[2])
    with path.open("a") as file:
        file.write("4,4,4,4,4,4,4,4,4,4")  # perhaps 41 or 4.5 in the end
    assert read(path)["error"].tolist() == [1.0, 2.0, 3.0]


def test_a_folder_is_locked_as_long_as_a_run_lives(tmp_path):
    first = Lock(tmp_path)
    with pytest.raises(tw.CaseError, match="in use by another run"):
        Lock(tmp_path)
    first.release()
    Lock(tmp_path)
    assert list(tmp_path.iterdir()) == []
