"""Animations: as many pictures as frames, the same axes in all of them, and clear refusals."""

import shutil
import signal
import stat

import numpy as np
import pytest
from PIL import Image

from thermowear import CaseError
from thermowear.app.cli import main
from thermowear.case.starters import starter_text
from thermowear.output.pictures import animation
from thermowear.output.pictures.animation import SectionPanel, read_frames, top
from thermowear.output.pictures.bodies import outline

from ..conftest import COLD_RUNNING_IN


@pytest.fixture(scope="module")
def folder(tmp_path_factory, bodies_not_drawn):
    """Short running-in with frames, and the animation drawn by the run."""
    path = tmp_path_factory.mktemp("animation") / "run"
    small = ["--set=mesh.degree=2", "--set=mesh.elements=4", "--set=analysis.end_time=5 s"]
    more = ["--set=analysis.output_times=[]", "--set=analysis.frames=6"]
    assert main(["run", str(COLD_RUNNING_IN), "-o", str(path), *small, *more]) == 0
    return path


def pictures(path):
    """Colours of all pictures of a GIF and how long each is shown [ms]."""
    with Image.open(path) as frames:
        found = []
        for k in range(frames.n_frames):
            frames.seek(k)
            found.append((np.array(frames.convert("RGB")), frames.info["duration"]))
    return found


def test_the_run_draws_it(folder):
    """requirement: one picture per frame and a longer final one; a small file."""
    frames = read_frames(folder)
    found = pictures(folder / "animation.gif")
    assert len(found) == len(frames.states) > 3
    assert [time for _, time in found] == [120] * (len(found) - 1) + [1500]
    assert found[0][0].shape == (560, 900, 3)
    assert (folder / "animation.gif").stat().st_size < 1e6
    with Image.open(folder / "animation.gif") as film_file:
        assert film_file.info["loop"] == 0


def test_states_go_from_start_to_end(folder):
    """requirement: times rise from 0 to the end; the last state is that of the results."""
    times = [state.time for state in read_frames(folder).states]
    assert times[0] == 0.0
    assert times[-1] == 5.0
    assert np.all(np.diff(times) > 0)


def test_axes_stand_still(folder):
    """requirement: static elements are identical in all pictures."""
    found = [picture.astype(int) for picture, _ in pictures(folder / "animation.gif")]
    changed = np.max([np.abs(p - found[0]).max(axis=2) for p in found], axis=0) > 40
    height, width = changed.shape
    assert not changed[-25:].any()  # label and ticks of the time axis
    assert not changed[: int(0.04 * height)].any()  # title
    assert not changed[:, : int(0.06 * width)].any()  # labels of the vertical axes at the left
    assert changed.mean() > 0.01
    assert changed[int(0.78 * height) : int(0.9 * height)].any()  # the mark moves


def test_colours_mean_the_same_in_all_frames(folder):
    """requirement: one colour range for all states, except few largest samples."""
    frames = read_frames(folder)
    panel = SectionPanel(frames)
    low, high = panel.limits
    for section in panel.sections.values():
        values = section.fields[frames.field]
        assert values.min() >= low
        assert np.mean(values <= high) >= 0.99


def test_body_1_sinks_as_it_wears(folder):
    """requirement: bodies are drawn displaced, consistent with the approach."""
    frames = read_frames(folder)
    heights = []
    for section in SectionPanel(frames).sections.values():
        heights.append(section.points[section.triangles[section.body == 1], 1].max())
    approach = np.interp(
        [state.time for state in frames.states], frames.history["time"], frames.history["approach"]
    )
    fallen = heights[0] - np.array(heights)
    np.testing.assert_allclose(fallen, 1e3 * (approach - approach[0]), atol=2e-5)
    assert fallen[-1] > 5e-3


def test_outline_of_two_cells_that_share_no_points():
    """requirement: inner edges do not belong to the outline."""
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    points = np.concatenate([square, square + [1, 0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    edges = points[outline(points, triangles)]
    assert np.linalg.norm(np.diff(edges, axis=1), axis=2).sum() == pytest.approx(6.0)
    assert len(edges) == 6


def test_singular_corners_do_not_flatten_the_rest():
    """requirement: an axis ends at the peak of a smooth pressure, below that of a singular one."""
    smooth = np.linspace(0, 1, 100) * np.linspace(1, 0, 100)
    assert top(smooth) == smooth.max()
    assert top(np.r_[np.ones(99), 50.0]) == 1.5
    assert top(np.zeros(3)) == 1.0


@pytest.mark.parametrize(
    ("time", "text"), [(0.0, "0 s"), (0.0012345, "0.00123 s"), (12345.6, "12300 s")]
)
def test_times_in_words(time, text):
    assert animation.duration(time) == text


@pytest.mark.slow
def test_fps_and_name(folder, tmp_path):
    """requirement: --fps sets the duration of each frame."""
    path = tmp_path / "slow.gif"
    assert main(["animate", str(folder), "-o", str(path), "--fps", "2"]) == 0
    assert {time for _, time in pictures(path)} == {500, 1500}


FAKE = """#!/bin/sh
for last; do :; done
cat > "$last"
"""


def test_mp4_goes_through_ffmpeg(folder, tmp_path, monkeypatch):
    """requirement: ffmpeg receives all pictures in the declared size."""
    tool = tmp_path / "ffmpeg"
    tool.write_text(FAKE, encoding="utf-8")
    tool.chmod(tool.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    path = tmp_path / "frames.mp4"
    assert main(["animate", str(folder), "-o", str(path)]) == 0
    assert path.stat().st_size == len(read_frames(folder).states) * 900 * 560 * 3


@pytest.mark.slow
def test_ffmpeg_that_fails_is_heard(folder, tmp_path, monkeypatch, capsys):
    """requirement: exit code 2, the last line of ffmpeg, and no partial file."""
    # as in the command line; tests import dolfinx, with which PETSc ends a process at a broken pipe
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    tool = tmp_path / "ffmpeg"
    tool.write_text("#!/bin/sh\necho 'no such encoder' >&2\nexit 1\n", encoding="utf-8")
    tool.chmod(tool.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    path = tmp_path / "frames.mp4"
    assert main(["animate", str(folder), "-o", str(path)]) == 2
    assert "no such encoder" in capsys.readouterr().err
    assert not list(tmp_path.glob("*frames.mp4"))


def test_mp4_without_ffmpeg(folder, tmp_path, monkeypatch, capsys):
    """requirement: exit code 1 and one line naming the missing program."""
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert main(["animate", str(folder), "-o", str(tmp_path / "frames.mp4")]) == 1
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert "ffmpeg" in said[0]


def test_refusals(folder, tmp_path):
    """requirement: invalid endings and folders are reported with a remedy."""
    with pytest.raises(CaseError, match=r"\.gif or \.mp4"):
        animation.check_animation(folder, tmp_path / "frames.avi")
    with pytest.raises(CaseError, match="no folder"):
        animation.check_animation(folder, tmp_path / "nowhere" / "frames.gif")
    with pytest.raises(CaseError, match=r"interface\.csv"):
        animation.check_animation(tmp_path, tmp_path / "frames.gif")
    (tmp_path / "interface.csv").touch()
    with pytest.raises(CaseError, match=r"analysis\.frames"):
        animation.check_animation(tmp_path, tmp_path / "frames.gif")


@pytest.mark.parametrize("fps", ["0", "-1", "nan", "many", "1000"])
def test_a_wrong_rate_is_refused(folder, fps):
    assert main(["animate", str(folder), "--fps", fps]) == 1


@pytest.mark.slow
def test_bodies_in_space(tmp_path):
    """requirement: 3D bodies and maps; wear depth changes, colour scales do not."""
    case, folder = tmp_path / "case.toml", tmp_path / "run"
    case.write_text(starter_text("rectangular-punch"), encoding="utf-8")
    ending = 'analysis={type="transient", end_time="100 s", frames=3}'
    small = ["--set=mesh.degree=1", "--set=mesh.elements=2", f"--set={ending}"]
    assert main(["run", str(case), "-o", str(folder), *small]) == 0
    found = [picture.astype(int) for picture, _ in pictures(folder / "animation.gif")]
    assert len(found) == len(read_frames(folder).states) > 2
    changed = np.abs(found[-1] - found[0]).max(axis=2) > 40
    assert changed[300:420, 500:].mean() > 0.1  # the map of the depth
    assert not changed[-25:].any()
    solid = found[0][60:400, :400]
    assert ((solid.max(axis=2) - solid.min(axis=2)) > 40).mean() > 0.1
