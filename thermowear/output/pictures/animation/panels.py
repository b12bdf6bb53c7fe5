"""Panels of an animation: bodies, contact face, curves along the contact, and time histories.

Axes and colour ranges are those of all frames.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from ....results import FIELDS
from ..bodies import read_section
from ..maps import triangulated
from ..panels import (
    BODIES,
    add_color_bar,
    clipped_top,
    color_limits,
    contact_window,
    draw_colors,
    inside,
    is_flat,
    label_coordinates,
    proportion,
    whole,
)
from ..saving import content
from .states import FrameSequence, FrameState, ScenePanel

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
        from ..in_space import solids

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
