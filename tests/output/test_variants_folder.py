"""Folder of many variants: damaged journals, full disks, and files of other origin."""

from __future__ import annotations

import json
from pathlib import Path
from unittest import mock

import pytest

from thermowear.app.batch.reporting import BatchReport
from thermowear.app.cli import main
from thermowear.errors import CaseError, UnwritableError
from thermowear.output.study import StudyFolder
from thermowear.output.variants.folder import JOURNAL, LOST

from ..conftest import DEMOS

ENDS = {1: "done", 2: "failed: no equilibrium", 3: f"{LOST} ended with exit code -9"}


def folder_of(path, **options):
    """Folder of a study of four variants."""
    cells = [["sample", float(k)] for k in range(4)]
    return StudyFolder(path, ["part", "x"], cells, {}, {}, "sum", **options)


@pytest.fixture
def begun(tmp_path):
    """Path of a study in which three variants have ended."""
    folder = folder_of(tmp_path)
    for number, status in ENDS.items():
        folder.add(number, status, {"a": 1.5, "b": float("nan")}, {}, 0.1)
    folder.close("interrupted", "", 1.0)
    return tmp_path


def test_what_is_resumed(begun):
    """requirement: ends and failures are kept; lost variants and incomplete lines are not.

    Neither are those that earlier versions recorded as failed by a full disk.
    """
    with (begun / JOURNAL).open("ab") as file:
        full = "failed: results cannot be written: [Errno 28] No space left on device"
        file.write(json.dumps({"variant": 4, "status": full, "numbers": {}}).encode() + b"\n")
    with (begun / JOURNAL).open("ab") as file:
        file.write('{"variant": 4, "status": "done", "numbers": {"µ'.encode()[:-1])
    folder = folder_of(begun, resume=True)
    assert folder.ended == {k: ENDS[k] for k in (1, 2)}
    assert folder.ends[1].numbers["a"] == 1.5
    lines = (begun / JOURNAL).read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["variant"] for line in lines] == [1, 2, 3, 4]


def test_a_line_is_written_whole_or_not_at_all(begun, monkeypatch):
    """requirement: what a full disk took of a line is removed, so that others may follow."""
    folder = folder_of(begun, resume=True)
    before, opened = (begun / JOURNAL).read_bytes(), Path.open

    def full_after(file, data):
        if not data.startswith(b'{"variant"'):
            raise OSError(28, "No space left on device")
        return file.write(data[:6])

    def full(path, *mode, **more):
        file = opened(path, *mode, **more)
        disk = mock.MagicMock(wraps=file)
        disk.__enter__.return_value = disk
        disk.__exit__.side_effect = lambda *_: file.close()
        disk.write.side_effect = lambda data: full_after(file, data)
        return disk

    with monkeypatch.context() as patched:
        patched.setattr(Path, "open", full)
        with pytest.raises(UnwritableError, match="No space left"):
            folder.append({"variant": 4})
    assert (begun / JOURNAL).read_bytes() == before
    assert 4 not in folder.ended


def test_overwrite_removes_bands_that_were_written_alone(begun):
    """requirement: tables of bands of the user, with any name, stay where they are."""
    folder = folder_of(begun, resume=True)
    folder.announce_bands(["bands_interface.csv"])
    folder.close("done", "", 1.0)
    for name in ("bands_interface.csv", "bands_history.csv", "bands_mine.csv"):
        (begun / name).write_text("mine", encoding="utf-8")
    folder_of(begun, overwrite=True).close("done")
    assert {p.name for p in begun.glob("bands_*")} == {"bands_history.csv", "bands_mine.csv"}


@pytest.mark.parametrize(
    "damaged",
    [
        *(b"}{", b"[1]", b'"done"', b'{"variant": 2}', b"\xff", b"{" * 9999),
        b'{"variant": 9999, "status": "done", "numbers": {}}',
        b'{"variant": "3", "status": "done", "numbers": {}}',
        b'{"variant": true, "status": "done", "numbers": {}}',
        b'{"variant": 3, "status": "done", "numbers": {"a": "1"}}',
        b'{"variant": 3, "status": ["done"], "numbers": {}}',
        b'{"variant": 3, "status": "done", "numbers": {}, "curves": {"history": {"time": "!"}}}',
    ],
)
def test_a_damaged_journal(begun, damaged):
    """requirement: the file and the line in one line; nothing is changed."""
    first, _, *rest = (begun / JOURNAL).read_bytes().splitlines()
    content = b"\n".join([first, damaged, *rest, b""])
    (begun / JOURNAL).write_bytes(content)
    with pytest.raises(CaseError) as error:
        folder_of(begun, resume=True)
    (line,) = error.value.faults
    assert f"{JOURNAL}, line 2: is damaged" in line
    assert (begun / JOURNAL).read_bytes() == content


def test_results_that_cannot_be_written(begun):
    """requirement: a failed computation with its reason, from the journal, the record, pictures."""
    folder = folder_of(begun, resume=True)
    report = BatchReport(folder, str)

    def no_space():
        raise OSError(28, "No space left on device")

    with pytest.raises(UnwritableError, match="No space left"), report.closing(no_space):
        pass
    (begun / JOURNAL).unlink()
    (begun / JOURNAL).mkdir()
    with pytest.raises(UnwritableError, match=r"results cannot be written: .*Is a directory"):
        folder.add(4, "done", {}, {}, 0.1)
    (begun / "study.csv").unlink()
    (begun / "study.csv").mkdir()
    with pytest.raises(UnwritableError, match="results cannot be written"):
        folder.close("done", "", 1.0)


def test_a_closed_console_is_no_full_disk(begun):
    """requirement: a closed pipe of the console ends the command quietly, as ever."""

    def closed():
        raise BrokenPipeError

    report = BatchReport(folder_of(begun, resume=True), str)
    with pytest.raises(BrokenPipeError), report.closing(closed):
        pass


def test_a_folder_that_cannot_be_written_ends_in_one_line(tmp_path, capsys):
    """requirement: exit code 1 and one line, before anything is computed."""
    (tmp_path / ".sweep.csv.part").mkdir()
    words = ["sweep", str(DEMOS / "pivoted_block.toml"), "--over", "contact.friction=0.1,0.2"]
    (tmp_path / "run.json").write_text('{"over": {}}', encoding="utf-8")
    assert main([*words, "-o", str(tmp_path), "--overwrite"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: -o {tmp_path}: cannot be written")


def test_a_page_of_other_origin_remains(begun):
    """requirement: only reports of this program are removed."""
    (begun / "report.html").write_text("<html>mine</html>", encoding="utf-8")
    folder_of(begun, overwrite=True)
    assert (begun / "report.html").read_text(encoding="utf-8") == "<html>mine</html>"
    assert not (begun / JOURNAL).exists()
