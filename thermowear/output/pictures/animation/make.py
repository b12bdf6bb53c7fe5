"""Draw the animation of a results folder; run in a separate process."""

from __future__ import annotations

import sys
from pathlib import Path

from ....errors import CaseError
from ...files import FRAMES
from ...frames import frame_files
from ..maps import is_surface
from ..scales import COLORS
from .panels import SectionPanel, SolidPanel, TimeCurve, contact_curves, face_maps
from .scene import Scene
from .states import read_frames
from .writers import GIF, MP4, common_palette, ffmpeg, write_gif, write_mp4

FPS = 8.0


def has_frames(folder: Path) -> bool:
    """Test whether a results folder has frames."""
    return bool(frame_files(folder / FRAMES))


def check_animation(folder: Path, path: Path) -> None:
    """Check that an animation can be drawn and written.

    Raises
    ------
    CaseError
        If the file type, the folders, the frames or ffmpeg are not suitable.
    """
    if path.suffix not in (GIF, MP4):
        raise CaseError(f"-o {path}: ends in {path.suffix or 'nothing'}; must end in .gif or .mp4")
    if not path.parent.is_dir():
        raise CaseError(f"-o {path}: there is no folder {path.parent}")
    if not (folder / "interface.csv").is_file():
        raise CaseError(
            f"{folder}: contains no interface.csv; not a results folder of a finished run"
        )
    if not has_frames(folder):
        raise CaseError(f"{folder}: has no frames; run the case with --set analysis.frames=60")
    if path.suffix == MP4:
        ffmpeg()


def draw_animation(folder: Path, path: Path, fps: float = FPS) -> None:
    """Draw the evolution of bodies, pressure and wear depth.

    Parameters
    ----------
    folder : Path
        Results folder with frames.
    path : Path
        File to write, ``.gif`` or ``.mp4``.
    fps : float
        Frames per second.
    """
    frames = read_frames(folder)
    if is_surface(folder):
        scene = Scene(frames, SolidPanel(frames), face_maps(frames), TimeCurve(frames))
    else:
        scene = Scene(frames, SectionPanel(frames), contact_curves(frames), TimeCurve(frames))
    states = frames.states
    pictures = (scene.picture(state) for state in states)
    if path.suffix == MP4:
        write_mp4(path, pictures, fps)
        return
    some = [scene.picture(state) for state in (states[0], states[len(states) // 2], states[-1])]
    write_gif(path, pictures, fps, common_palette(some, COLORS[frames.field]))


if __name__ == "__main__":
    draw_animation(Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]))
