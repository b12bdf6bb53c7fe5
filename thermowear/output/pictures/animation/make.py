"""Pictures of an animation and their drawing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ....errors import CaseError
from ...files import contacts_of, name_at
from ..kinds import FPS, has_frames, is_surface
from ..panels import STYLE, color_map
from ..saving import show_as_text
from .panels import SectionPanel, SolidPanel, TimeCurve, contact_curves, face_maps
from .states import FrameSequence, FrameState, ScenePanel, read_frames
from .writers import GIF, MP4, common_palette, ffmpeg, write_gif, write_mp4

_DPI = 100
_WIDTH, _HEIGHT = 9.0, 5.6  # inches
_FLAT = 0.4
"""Height over width of the bodies below which they are above the curves, else beside them."""
_SCALE = 1.5  # width of colour bar and labels of the bodies [inches]
_STYLE = STYLE | {"font.size": 9}


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
    needed = name_at("interface", None, contacts_of(folder)[0])
    if not (folder / needed).is_file():
        raise CaseError(f"{folder}: contains no {needed}; not a results folder of a finished run")
    if not has_frames(folder):
        raise CaseError(f"{folder}: has no frames; run the case with --set analysis.frames=60")
    if path.suffix == MP4:
        ffmpeg()


class Scene:
    """Figure with a fixed layout and fixed axes for all frames.

    Parameters
    ----------
    frames : FrameSequence
    bodies : ScenePanel
        Panel with `shape`, its height over width.
    contact : sequence of ScenePanel
        One or two panels of the contact.
    history : ScenePanel
        Panel over time.
    """

    def __init__(
        self, frames: FrameSequence, bodies, contact: Sequence[ScenePanel], history: ScenePanel
    ):
        self._panels = {"bodies": bodies, "history": history}
        self._panels |= {f"contact {k}": panel for k, panel in enumerate(contact)}
        with mpl.rc_context(_STYLE):
            self._figure = Figure(figsize=(_WIDTH, _HEIGHT), dpi=_DPI, layout="constrained")
            self._canvas = FigureCanvasAgg(self._figure)
            plan, ratios = _plan(len(contact), bodies.shape)
            axes = self._figure.subplot_mosaic(plan, **ratios)
            self._figure.suptitle(frames.title, fontsize="large")
            for name, panel in self._panels.items():
                panel.prepare(axes[name])
            self._time = axes["bodies"].set_title("", loc="left", fontsize="large", color="tab:red")
        self._fill(frames.states[-1])
        show_as_text(self._figure)
        self._figure.draw_without_rendering()
        self._figure.set_layout_engine("none")

    def picture(self, state: FrameState) -> np.ndarray:
        """Pixels of the picture of a state, shape (height, width, 3)."""
        self._fill(state)
        self._canvas.draw()
        return np.asarray(self._canvas.buffer_rgba())[..., :3].copy()

    def _fill(self, state: FrameState) -> None:
        with mpl.rc_context(_STYLE):
            for panel in self._panels.values():
                panel.show(state)
            self._time.set_text(f"t = {duration(state.time)}")


def duration(time: float) -> str:
    """Format a time in seconds with three digits."""
    return f"{float(f'{time:.3g}'):g} s"


def _plan(count: int, shape: float) -> tuple[list[Any], dict[str, Any]]:
    """Positions of the panels and their sizes, by height over width of the bodies."""
    curves = [f"contact {k}" for k in range(count)]
    if shape < _FLAT:
        tall = np.clip(shape * (_WIDTH - _SCALE), 1.2, 2.2)
        return [["bodies"] * count, curves, ["history"] * count], {"height_ratios": (tall, 1.3, 1)}
    rows = [["bodies", curve] for curve in curves]
    wide = np.clip(3.0 / shape + _SCALE, 0.3 * _WIDTH, 0.55 * _WIDTH)
    sizes = {"width_ratios": (wide, _WIDTH - wide)}
    return [*rows, ["history"] * 2], sizes | {"height_ratios": (*[3.2 / count] * count, 1)}


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
    write_gif(path, pictures, fps, common_palette(some, color_map(frames.field)))
