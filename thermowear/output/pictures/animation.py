"""Animations of a results folder with frames: GIF by Pillow, MP4 by ffmpeg.

Axes and colour ranges are those of all frames.
"""

from __future__ import annotations

import shutil
import subprocess
import tomllib
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from ...errors import CaseError
from ...results import FIELDS
from .. import tables
from ..files import FRAMES, atomic_write, bodies_of, contacts_of, name_at, read_summary
from ..frames import frame_files
from .bodies import read_section
from .kinds import FPS, has_frames, is_surface
from .maps import triangulated
from .panels import (
    BODIES,
    STYLE,
    add_color_bar,
    clipped_top,
    color_limits,
    color_map,
    contact_window,
    content,
    draw_colors,
    inside,
    is_flat,
    label_coordinates,
    proportion,
    show_as_text,
    whole,
)

_HISTORIES = ("history.csv", "cycles.csv", "loads.csv")
_STEADY = 1e-2  # distance from the steady state up to which the final state is called steady


@dataclass(frozen=True)
class FrameState:
    """State of the results at one time [s].

    Attributes
    ----------
    time : float
    interfaces : dict of str to TableColumns
        Columns of ``interface.csv`` by contact; that of a pair has no name.
    track : TableColumns or None
        Columns of ``track.csv`` in reciprocating analyses.
    file : Path
        File of the fields.
    """

    time: float
    interfaces: dict[str, tables.TableColumns]
    track: tables.TableColumns | None
    file: Path

    @property
    def interface(self) -> tables.TableColumns:
        """Columns of the first contact."""
        return next(iter(self.interfaces.values()))


@dataclass(frozen=True)
class FrameSequence:
    """All states of an animation; the last one is the end of the run.

    Attributes
    ----------
    states : list of FrameState
    title : str
        Title of the case.
    history : TableColumns
        Columns of ``history.csv``, or of ``cycles.csv`` or ``loads.csv``.
    even : bool
        True for a linear time axis, with prescribed loads or temperatures in time; running-in
        without them slows down and is shown on a logarithmic axis.
    field : str
        Field shown on the bodies: the temperature if there is one, else the stress.
    ends_steady : bool
        True if the final state is close to the steady state.
    bodies : dict of str to (str, str)
        Names of both bodies of each contact.
    """

    states: list[FrameState]
    title: str
    history: tables.TableColumns
    even: bool
    field: str
    ends_steady: bool
    bodies: dict[str, tuple[str, str]]

    @property
    def several(self) -> bool:
        """True for several bodies, whose contacts have names."""
        return "" not in self.bodies


class ScenePanel(ABC):
    """Panel of the picture; its axes do not change from state to state."""

    @abstractmethod
    def prepare(self, axis) -> None:
        """Draw the static elements."""

    @abstractmethod
    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""


def read_frames(folder: Path) -> FrameSequence:
    """Read all data of an animation except the fields.

    Raises
    ------
    ValueError
        If a file does not have the expected columns.
    """
    name = next(name for name in _HISTORIES if (folder / name).is_file())
    history = tables.read(folder / name)
    end = float(history["time"][-1])
    contacts = contacts_of(folder)
    states = [
        _state(
            f.time,
            {contact: f.file("interface", contact) for contact in contacts},
            f.file("track"),
            f.file("fields"),
        )
        for f in frame_files(folder / FRAMES)
    ]
    ends = {contact: folder / name_at("interface", None, contact) for contact in contacts}
    last = _state(end, ends, folder / "track.csv", folder / "fields.vtu")
    case = tomllib.loads((folder / "case.resolved.toml").read_text("utf-8"))
    distance = read_summary(folder).get("distance_from_steady")
    return FrameSequence(
        states=[*(state for state in states if state.time < end), last],
        title=case.get("title", ""),
        history=history,
        even=name != "history.csv" or (folder / "heat.csv").is_file(),
        field="temperature" if np.isfinite(last.interface["temperature_1"]).all() else "von_mises",
        ends_steady=distance is not None and distance <= _STEADY,
        bodies={contact: bodies_of(folder, contact) for contact in contacts},
    )


def _state(time: float, interfaces: dict[str, Path], track: Path, fields: Path) -> FrameState:
    worn = tables.read(track) if track.is_file() else None
    columns = {contact: tables.read(path) for contact, path in interfaces.items()}
    return FrameState(time, columns, worn, fields)


GIF, MP4 = ".gif", ".mp4"
_LAST_DURATION = 1.5  # duration of the last frame [s]
_MOST_COLORS = 255  # one more is reserved for unchanged pixels
_COLOURS = ("black", "0.45", "0.6", "tab:red", *BODIES)
_BLENDS = 6  # blends of a line with white, for antialiased edges


def ffmpeg() -> str:
    """Path of the ffmpeg program.

    Raises
    ------
    CaseError
        If ffmpeg is not installed.
    """
    found = shutil.which("ffmpeg")
    if found is None:
        raise CaseError("MP4 needs ffmpeg, which is not installed; write a .gif instead")
    return found


def write_gif(path: Path, pictures: Iterator[np.ndarray], fps: float, palette: np.ndarray) -> None:
    """Write a GIF with one palette for all pictures, which avoids flicker.

    Parameters
    ----------
    path : Path
        File to write, replaced when the animation is complete.
    pictures : iterator of ndarray of uint8, shape (height, width, 3)
    fps : float
        Pictures per second.
    palette : ndarray of uint8, shape (k, 3)
    """
    colors = Image.new("P", (1, 1))
    colors.putpalette(palette.tobytes())
    frames = [
        Image.fromarray(picture).quantize(palette=colors, dither=Image.Dither.NONE)
        for picture in pictures
    ]
    shown = [1 / fps] * (len(frames) - 1) + [max(_LAST_DURATION, 1 / fps)]
    with atomic_write(path) as draft:
        frames[0].save(
            draft,
            format="GIF",
            save_all=True,
            append_images=frames[1:],
            duration=[round(100 * s) * 10 for s in shown],  # stored in hundredths of a second
            loop=0,
        )


def common_palette(pictures: list[np.ndarray], scale: str) -> np.ndarray:
    """Palette of the line colours and the best approximation of a colour map and of pictures.

    Parameters
    ----------
    pictures : list of ndarray of uint8, shape (height, width, 3)
    scale : str
        Name of a colour map.

    Returns
    -------
    ndarray of uint8, shape (k, 3)
        At most 255.
    """
    parts = np.linspace(0.0, 1.0, _BLENDS)[:, None]
    lines = np.concatenate([1 - parts * (1 - np.array(to_rgb(color))) for color in _COLOURS])
    fixed = np.unique(_as_bytes(lines), axis=0)
    height, width = pictures[0].shape[:2]
    steps = _as_bytes(mpl.colormaps[scale](np.linspace(0.0, 1.0, width))[:, :3])
    some = np.concatenate([*pictures, np.broadcast_to(steps, (height, width, 3))])
    rest = Image.fromarray(some).quantize(_MOST_COLORS - len(fixed)).getpalette()
    return np.concatenate([fixed, np.array(rest, dtype=np.uint8).reshape(-1, 3)])[:_MOST_COLORS]


def _as_bytes(colors: np.ndarray) -> np.ndarray:
    return np.round(255 * colors).astype(np.uint8)


def write_mp4(path: Path, pictures: Iterator[np.ndarray], fps: float) -> None:
    """Write an MP4; parameters as in `write_gif`.

    Raises
    ------
    CaseError
        If ffmpeg is not installed.
    OSError
        If ffmpeg fails.
    """
    first = next(pictures)
    height, width = (n - n % 2 for n in first.shape[:2])  # the encoder needs even numbers
    stream = f"-f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {fps:g} -i -".split()
    last = f"tpad=stop_mode=clone:stop_duration={_LAST_DURATION:g}"
    rest = f"-vf {last} -pix_fmt yuv420p -f mp4".split()
    with atomic_write(path) as draft, TemporaryFile() as said:
        command = [ffmpeg(), "-y", "-loglevel", "error", *stream, *rest, str(draft)]
        encoder = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said)
        assert encoder.stdin is not None
        with suppress(BrokenPipeError):  # its error message is reported below
            for picture in chain([first], pictures):
                encoder.stdin.write(picture[:height, :width].tobytes())
            encoder.stdin.close()
        if encoder.wait() != 0:
            said.seek(0)
            lines = said.read().decode(errors="replace").strip().splitlines()
            raise OSError(f"ffmpeg: {lines[-1] if lines else f'exit code {encoder.returncode}'}")


_SCALE = 0.05  # width of the colour bar relative to the panel
_AXIS_END = 1.06  # end of an axis relative to the largest value
_MOST = 8  # curves in a legend
_LINES = ("-", "--", "-.", ":")
_FAINT = {"color": "0.6", "linewidth": 1.2}
_STYLES = {
    "wear_1": {"color": BODIES[0], "linestyle": "-"},
    "wear_2": {"color": BODIES[1], "linestyle": "--"},
}
"""Styles by body, so that coinciding curves are both visible."""


class SectionPanel(ScenePanel):
    """Panel with deformed 2D bodies: whole, or a window around a small contact."""

    def __init__(self, frames: FrameSequence):
        self._frames = frames
        self.sections = {s.time: read_section(s.file).displaced() for s in frames.states}
        sections = self.sections.values()
        points = np.concatenate([section.points for section in sections])
        interfaces = [table for state in frames.states for table in state.interfaces.values()]
        self.window = contact_window(interfaces, points) or whole(points)
        self.shape = proportion(self.window)
        seen = [s.fields[frames.field][inside(s.points, self.window)] for s in sections]
        self.limits = color_limits(*seen)
        self._largest = max(values.max() for values in seen)
        self._drawn: list = []

    def prepare(self, axis) -> None:
        self._axis, name = axis, self._frames.field
        label_coordinates(axis, self._frames.states[-1].interface)
        axis.set_anchor("W")
        axis.grid(visible=False)
        place = axis.inset_axes([1.03, 0.0, _SCALE * min(1.0, self.shape), 1.0])
        add_color_bar(axis, name, FIELDS[name].axis, self.limits, self._largest, cax=place)

    def show(self, state: FrameState) -> None:
        while self._drawn:
            self._drawn.pop().remove()
        section = self.sections[state.time]
        self._drawn = section.draw(self._axis, self._frames.field, self.limits, self.window)


class SolidPanel(ScenePanel):
    """Panel with undeformed 3D bodies and a fixed camera."""

    def __init__(self, frames: FrameSequence):
        from .in_space import solids

        self._frames, self._solids = frames, solids
        self._y = solids.middle(frames.states[-1].interface)
        surfaces = (self._surfaces(state) for state in frames.states)
        self.limits = color_limits(
            *(np.concatenate([surface[frames.field] for surface in parts]) for parts in surfaces)
        )
        ends = self._rendered(frames.states[0]), self._rendered(frames.states[-1])
        self._seen = content(*ends)
        self._blank = np.full_like(ends[0][self._seen], 255)
        self.shape = self._blank.shape[0] / self._blank.shape[1]

    def prepare(self, axis) -> None:
        name = self._frames.field
        axis.set_axis_off()
        add_color_bar(axis, name, FIELDS[name].axis, self.limits, self.limits[1])
        self._image = axis.imshow(self._blank, interpolation="antialiased")

    def show(self, state: FrameState) -> None:
        self._image.set_data(self._rendered(state)[self._seen])

    def _rendered(self, state: FrameState) -> np.ndarray:
        return self._solids.render(self._surfaces(state), self._frames.field, self.limits)

    def _surfaces(self, state: FrameState) -> list:
        return self._solids.clipped(self._solids.read_grid(state.file), self._y)


class FaceMap(ScenePanel):
    """Panel with a map of a quantity over a contact face."""

    def __init__(self, frames: FrameSequence, contact: str, name: str):
        self._end, self._contact, self._name = frames.states[-1].interfaces[contact], contact, name
        highest = max(float(s.interfaces[contact].drawn(name).max()) for s in frames.states)
        self._limits = (0.0, highest)
        self._drawn: list = []

    def prepare(self, axis) -> None:
        self._axis, data = axis, self._end
        label_coordinates(axis, data)
        window = whole(np.stack([data.drawn("x"), data.drawn("y")], axis=1))
        axis.set(xlim=window[:2], ylim=window[2:])
        axis.set_title(self._contact, fontsize="medium")
        axis.grid(visible=False)
        label, limits = data.quantities[self._name].wrapped, self._limits
        add_color_bar(axis, self._name, label, limits, limits[1], shrink=1.0)

    def show(self, state: FrameState) -> None:
        while self._drawn:
            self._drawn.pop().remove()
        table = state.interfaces[self._contact]
        x, y, values = map(table.drawn, ("x", "y", self._name))
        triangles = triangulated(x, y)
        self._drawn = [draw_colors(self._axis, triangles, values, self._name, self._limits)]


def face_maps(frames: FrameSequence) -> list[FaceMap]:
    """Maps of the pressure and of the largest wear depth, of the contact with the deepest wear.

    Without wear, that of the largest pressure.
    """
    ends = frames.states[-1].interfaces
    depths = {(c, name): ends[c][name].max() for c in ends for name in ("wear_1", "wear_2")}
    contact, deepest = max(depths, key=lambda curve: depths[curve])
    if depths[contact, deepest] > 0:
        return [FaceMap(frames, contact, name) for name in ("pressure", deepest)]
    return [FaceMap(frames, max(ends, key=lambda c: ends[c]["pressure"].max()), "pressure")]


Curve = tuple[str, str]
"""Contact, and a column of its interface."""


class CurvePanel(ScenePanel):
    """Columns of the interfaces along the contacts, with fixed axes."""

    def __init__(self, frames: FrameSequence, curves: Sequence[Curve]):
        self._frames, self._states, self._curves = frames, frames.states, curves
        self._lines: dict[Curve, Line2D] = {}
        contacts = list(frames.bodies)
        several = mpl.colormaps["tab20" if len(contacts) > 10 else "tab10"]
        self._colors = {contact: several(k % several.N) for k, contact in enumerate(contacts)}

    def prepare(self, axis) -> None:
        positions = [self._at(state, curve)[0] for state in self._states for curve in self._curves]
        axis.set_xlim(min(x.min() for x in positions), max(x.max() for x in positions))
        last = self._states[-1]
        axis.set_xlabel(last.interface.quantities[_abscissa(last)].axis)
        if 1 < len(axis.get_legend_handles_labels()[0]) <= _MOST:  # above the panel
            where = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.0}
            axis.legend(fontsize="small", ncols=4, handlelength=1.5, **where)

    def show(self, state: FrameState) -> None:
        for curve, line in self._lines.items():
            line.set_data(*self._at(state, curve))

    def _dashed(self, curve: Curve) -> dict[str, Any]:
        """Colour of a contact, with a line style by which coinciding curves are all visible."""
        line = _LINES[self._curves.index(curve) % len(_LINES)]
        return {"color": self._colors[curve[0]], "linestyle": line}

    def _at(self, state: FrameState, curve: Curve) -> tuple[np.ndarray, np.ndarray]:
        """Positions and values along a contact, or of a body along its track, if it has one."""
        contact, name = curve
        if state.track is not None and name in state.track:
            return state.track.drawn("x"), state.track.drawn(name)
        table = state.interfaces[contact]
        return table.drawn(_abscissa(self._states[-1])), table.drawn(name)


class PressureCurve(CurvePanel):
    """Contact pressure along each face; that of a pair with its start and end in grey."""

    def __init__(self, frames: FrameSequence):
        super().__init__(frames, [(contact, "pressure") for contact in frames.bodies])

    def prepare(self, axis) -> None:
        first, last = self._states[0], self._states[-1]
        end = "steady" if self._frames.ends_steady else "end"
        for state, line, label in ((first, "--", "start"), (last, "-", end)):
            for curve in () if self._frames.several else self._curves:
                if state.interface["pressure"].max() > 0:
                    axis.plot(*self._at(state, curve), line, label=label, **_FAINT)
        for curve in self._curves:
            style: dict[str, Any] = {"color": "tab:red", "label": "now"}
            if self._frames.several:
                style = self._dashed(curve) | {"label": curve[0]}
            (self._lines[curve],) = axis.plot(*self._at(first, curve), **style)
        tables = [table for state in self._states for table in state.interfaces.values()]
        axis.set_ylim(0.0, _AXIS_END * max(top(table.drawn("pressure")) for table in tables))
        axis.set_ylabel(last.interface.quantities["pressure"].wrapped)
        super().prepare(axis)


class WearCurves(CurvePanel):
    """Wear depths of bodies, downwards, with their ends in grey."""

    def prepare(self, axis) -> None:
        first, last = self._states[0], self._states[-1]
        for curve in self._curves:
            axis.plot(*self._at(last, curve), label="_" if self._lines else "end", **_FAINT)
            (self._lines[curve],) = axis.plot(*self._at(first, curve), **self._style(curve))
        each = [self._at(state, curve)[1] for state in self._states for curve in self._curves]
        deepest = max(np.nanmax(depths) for depths in each)
        axis.set_ylim(_AXIS_END * deepest, (1 - _AXIS_END) * deepest)
        axis.set_ylabel(last.interface.quantities["wear_1"].of_both.wrapped)
        super().prepare(axis)

    def _style(self, curve: Curve) -> dict[str, Any]:
        """Style of a curve: by body of a pair, by contact and body of several ones."""
        contact, name = curve
        side = int(name[-1])
        if not self._frames.several:
            return _STYLES[name] | {"label": f"body {side}"}
        body = self._frames.bodies[contact][side - 1]
        several = sum(self._frames.bodies[c][int(n[-1]) - 1] == body for c, n in self._curves)
        label = f"{body} ({contact})" if several > 1 else body
        return self._dashed(curve) | {"label": label}


def contact_curves(frames: FrameSequence) -> list[CurvePanel]:
    """Panels of the pressure and, if a body wears, of the wear depths."""
    last = frames.states[-1]
    track = {} if last.track is None else last.track
    worn = [
        (contact, name)
        for contact, table in last.interfaces.items()
        for name in _STYLES
        if np.nanmax((track if name in track else table)[name]) > 0
    ]
    return [PressureCurve(frames), *([WearCurves(frames, worn)] if worn else [])]


def _abscissa(state: FrameState) -> str:
    """Column along the contacts: x if all of them are nearly flat, see `panels.abscissa`."""
    return "x" if all(is_flat(table) for table in state.interfaces.values()) else "s"


class TimeCurve(ScenePanel):
    """History of the largest temperature or pressure, with a mark at the current time."""

    def __init__(self, frames: FrameSequence):
        self._name = "max_temperature" if _is_hot(frames) else "max_pressure"
        self._even = frames.even
        # a logarithmic axis cannot start at zero
        self._history = frames.history if frames.even else frames.history.rows(np.s_[1:])
        self._time, self._drawn = self._history["time"], self._history.drawn(self._name)

    def prepare(self, axis) -> None:
        shown = self._history.quantities
        axis.plot(self._time, self._drawn, color="0.45")
        if not self._even:
            axis.set_xscale("log")
        axis.set_xlim(self._time[0], self._time[-1])
        if self._name == "max_pressure":
            axis.set_ylim(0.0, _AXIS_END * self._drawn.max())
        axis.set_xlabel(shown["time"].axis + ("" if self._even else ", logarithmic"))
        axis.set_ylabel(shown[self._name].wrapped)
        self._mark = axis.axvline(self._time[0], color="tab:red", linewidth=1.2)
        (self._dot,) = axis.plot([], [], "o", color="tab:red", markersize=6, clip_on=False)

    def show(self, state: FrameState) -> None:
        time = max(state.time, self._time[0])
        self._mark.set_xdata([time, time])
        self._dot.set_data([time], [np.interp(time, self._time, self._drawn)])


def top(values: np.ndarray) -> float:
    """End of the axis for a state, with singular corners of unworn faces clipped."""
    pressed = values[values > 0]
    if not len(pressed):
        return 1.0
    return clipped_top([pressed]) or float(pressed.max())


def _is_hot(frames: FrameSequence) -> bool:
    return bool(np.isfinite(frames.history.get("max_temperature", np.array([np.nan]))).all())


_DPI = 100
_WIDTH, _HEIGHT = 9.0, 5.6  # inches
_FLAT = 0.4
"""Height over width of the bodies below which they are above the curves, else beside them."""
_BAR_WIDTH = 1.5  # width of colour bar and labels of the bodies [inches]
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
        tall = np.clip(shape * (_WIDTH - _BAR_WIDTH), 1.2, 2.2)
        return [["bodies"] * count, curves, ["history"] * count], {"height_ratios": (tall, 1.3, 1)}
    rows = [["bodies", curve] for curve in curves]
    wide = np.clip(3.0 / shape + _BAR_WIDTH, 0.3 * _WIDTH, 0.55 * _WIDTH)
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
