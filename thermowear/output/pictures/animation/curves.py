"""Panels of an animation with fixed axes: curves along the contact, and time histories."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.lines import Line2D

from ..panels import BODIES, abscissa, clipped_top
from .states import Film, FrameState

_AXIS_END = 1.06  # end of an axis relative to the largest value
_FAINT = {"color": "0.6", "linewidth": 1.2}

Curve = Callable[[FrameState], tuple[np.ndarray, np.ndarray]]


class PressureCurve:
    """Contact pressure along the face, with its start and end in grey."""

    def __init__(self, film: Film):
        self._film = film

    def prepare(self, axis) -> None:
        """Draw the static elements."""
        states, self._curve = self._film.states, _along("pressure")
        ends = {"--": (states[0], "start"), "-": (states[-1], self._name_of_end())}
        for style, (state, name) in ends.items():
            if state.interface["pressure"].max() > 0:
                axis.plot(*self._curve(state), style, label=name, **_FAINT)
        (self._line,) = axis.plot(*self._curve(states[0]), color="tab:red", label="now")
        axis.set_ylim(0.0, _AXIS_END * max(top(self._curve(state)[1]) for state in states))
        axis.set_xlim(_span(self._curve(state)[0] for state in states))
        last = states[-1].interface
        axis.set_ylabel(last.quantities["pressure"].wrapped)
        axis.set_xlabel(abscissa(last)[0])
        _legend(axis)

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        self._line.set_data(*self._curve(state))

    def _name_of_end(self) -> str:
        return "steady" if self._film.ends_steady else "end"


class WearCurves:
    """Wear depth of each wearing body, downwards, with its end in grey."""

    def __init__(self, film: Film):
        self._film = film
        self._lines: dict[str, Line2D] = {}
        self._curves = {
            name: curve
            for name, curve in (("wear_1", _along("wear_1")), ("wear_2", _wear_of_body_2))
            if curve(film.states[-1])[1].max() > 0
        }

    @property
    def shows_something(self) -> bool:
        """True if any body wears."""
        return bool(self._curves)

    def prepare(self, axis) -> None:
        """Draw the static elements."""
        states, values, places = self._film.states, [], []
        for (name, curve), (color, line) in zip(self._curves.items(), self._styles(), strict=True):
            axis.plot(*curve(states[-1]), label="_" if self._lines else "end", **_FAINT)
            (self._lines[name],) = axis.plot(
                *curve(states[0]), color=color, linestyle=line, label=f"body {name[-1]}"
            )
            places += [curve(state)[0] for state in states]
            values += [curve(state)[1] for state in states]
        deepest = max(v.max() for v in values)
        axis.set_ylim(_AXIS_END * deepest, (1 - _AXIS_END) * deepest)
        axis.set_xlim(_span(places))
        last = states[-1].interface
        axis.set_ylabel(f"wear depth\n[{last.quantities['wear_1'].unit}]")
        axis.set_xlabel(abscissa(last)[0])
        _legend(axis)

    def show(self, state: FrameState) -> None:
        """Update the panel to a state."""
        for name, curve in self._curves.items():
            self._lines[name].set_data(*curve(state))

    def _styles(self) -> list[tuple[str, str]]:
        """Colour and line style by body, so that coinciding curves are both visible."""
        kinds = tuple(zip(BODIES, ("-", "--"), strict=True))
        return [kinds[int(name[-1]) - 1] for name in self._curves]


class TimeCurve:
    """History of the largest temperature or pressure, with a mark at the current time."""

    def __init__(self, film: Film):
        self._name = "max_temperature" if _is_hot(film) else "max_pressure"
        self._even = film.even
        # a logarithmic axis cannot start at zero
        self._history = film.history if film.even else film.history.rows(np.s_[1:])
        self._time, self._drawn = self._history["time"], self._history.drawn(self._name)

    def prepare(self, axis) -> None:
        """Draw the static elements."""
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
        """Update the panel to a state."""
        time = max(state.time, self._time[0])
        self._mark.set_xdata([time, time])
        self._dot.set_data([time], [np.interp(time, self._time, self._drawn)])


def top(values: np.ndarray) -> float:
    """End of the axis for a state, with singular corners of unworn faces clipped."""
    pressed = values[values > 0]
    if not len(pressed):
        return 1.0
    return clipped_top([pressed]) or float(pressed.max())


def _legend(axis) -> None:
    """Place the legend above the panel, outside the curves."""
    if len(axis.get_legend_handles_labels()[0]) > 1:
        where = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.0}
        axis.legend(fontsize="small", ncols=4, handlelength=1.5, **where)


def _is_hot(film: Film) -> bool:
    return bool(np.isfinite(film.history.get("max_temperature", np.array([np.nan]))).all())


def _along(name: str) -> Curve:
    """Column of ``interface.csv`` along the contact, in the units of plots."""
    return lambda state: (abscissa(state.interface)[1], state.interface.drawn(name))


def _wear_of_body_2(state: FrameState) -> tuple[np.ndarray, np.ndarray]:
    """Wear depths of body 2 along the contact, or along the track if body 1 reciprocates."""
    if state.track is None:
        return _along("wear_2")(state)
    return state.track.drawn("x"), state.track.drawn("wear_2")


def _span(places) -> tuple[float, float]:
    """Range of all positions."""
    every = np.concatenate(list(places))
    return float(every.min()), float(every.max())
