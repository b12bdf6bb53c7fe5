"""Frames of a results folder: always complete, and at most as many as requested."""

import meshio
import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.output.files import FRAMES
from thermowear.output.frames import frame_files, keep_indexed, remove_frames
from thermowear.output.tables import read

from ..conftest import COLD_RUNNING_IN

SMALL = [
    "--no-pictures",
    "--set=mesh.degree=2",
    "--set=mesh.elements=4",
    "--set=analysis.end_time=5 s",
    "--set=analysis.output_times=[]",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Short running-in with at most eight frames."""
    path = tmp_path_factory.mktemp("frames") / "run"
    assert (
        main(["run", str(COLD_RUNNING_IN), "-o", str(path), *SMALL, "--set=analysis.frames=8"]) == 0
    )
    return path


def test_index_and_files_agree(folder):
    """requirement: the index lists each frame with its time; no other files remain."""
    frames = frame_files(folder / FRAMES)
    times = read(folder / "history.csv")["time"]
    assert 4 <= len(frames) <= 8
    assert len(set(np.diff([frame.number for frame in frames]))) == 1
    assert len(times) > 8
    assert [frame.time for frame in frames] == [times[frame.number] for frame in frames]
    expected = {f.name for frame in frames for f in map(frame.file, ("fields", "interface"))}
    assert {path.name for path in (folder / FRAMES).iterdir()} == expected | {"frames.pvd"}


def test_fields_are_those_of_the_step(folder):
    """requirement: the largest pressure equals that of the history; stress in single precision."""
    largest = read(folder / "history.csv")["max_pressure"]
    for frame in frame_files(folder / FRAMES):
        pressure = read(frame.file("interface"))["pressure"]
        assert pressure.max() == pytest.approx(largest[frame.number], rel=1e-9)
        mesh = meshio.read(frame.file("fields"))
        assert mesh.point_data["von_mises_Pa"].dtype == np.float32
        assert mesh.point_data["von_mises_Pa"].max() > 1e6


def test_without_the_key_there_are_none(tmp_path):
    """requirement: runs without frames write the same files as before."""
    assert main(["run", str(COLD_RUNNING_IN), "-o", str(tmp_path / "run"), *SMALL]) == 0
    assert not (tmp_path / "run" / FRAMES).exists()


def test_overwriting_removes_them(folder, tmp_path):
    import shutil

    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    assert main(["run", str(COLD_RUNNING_IN), "-o", str(copy), *SMALL, "--overwrite"]) == 0
    assert not (copy / FRAMES).exists()


def test_only_ours_is_removed(folder, tmp_path):
    import shutil

    copy = tmp_path / FRAMES
    shutil.copytree(folder / FRAMES, copy)
    (copy / "notes.txt").write_text("mine", encoding="utf-8")
    remove_frames(copy)
    assert [path.name for path in copy.iterdir()] == ["notes.txt"]


@pytest.mark.parametrize(
    "text", ["", "<a><DataSet/></a>", '<a><DataSet timestep="x" file="y"/></a>']
)
def test_a_broken_index_is_said(text, tmp_path):
    (tmp_path / "frames.pvd").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"frames\.pvd"):
        frame_files(tmp_path)


def test_what_a_killed_run_left_is_removed(folder, tmp_path):
    """requirement: frame files not in the index are removed when a run is resumed."""
    import shutil

    place = tmp_path / FRAMES
    shutil.copytree(folder / FRAMES, place)
    whole = {path.name for path in place.iterdir()}
    for left in ("fields_00003.vtu", "interface_00003.csv", "track_00009.csv"):
        (place / left).write_text("left behind")
    (place / ".fields_00005.vtu.part").write_text("half")
    (place / "notes.txt").write_text("mine")
    keep_indexed(place)
    assert {path.name for path in place.iterdir()} == whole | {"notes.txt"}
