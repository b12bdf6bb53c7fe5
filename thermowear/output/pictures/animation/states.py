"""Frames of a results folder, with its final state."""

from __future__ import annotations

import tomllib
from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ... import tables
from ...files import FRAMES, read_summary
from ...frames import frame_files

_HISTORIES = ("history.csv", "cycles.csv", "loads.csv")
_STEADY = 1e-2  # distance from the steady state up to which the final state is called steady


@dataclass(frozen=True)
class FrameState:
    """State of the results at one time [s].

    Attributes
    ----------
    time : float
    interface, track : TableColumns
        Columns of ``interface.csv``, and of ``track.csv`` in reciprocating analyses.
    file : Path
        File of the fields.
    """

    time: float
    interface: tables.TableColumns
    track: tables.TableColumns | None
    file: Path


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
    """

    states: list[FrameState]
    title: str
    history: tables.TableColumns
    even: bool
    field: str
    ends_steady: bool


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
    states = [
        _state(f.time, f.file("interface"), f.file("track"), f.file("fields"))
        for f in frame_files(folder / FRAMES)
    ]
    last = _state(end, *(folder / n for n in ("interface.csv", "track.csv", "fields.vtu")))
    case = tomllib.loads((folder / "case.resolved.toml").read_text("utf-8"))
    distance = read_summary(folder).get("distance_from_steady")
    return FrameSequence(
        states=[*(state for state in states if state.time < end), last],
        title=case.get("title", ""),
        history=history,
        even=name != "history.csv" or (folder / "heat.csv").is_file(),
        field="temperature" if np.isfinite(last.interface["temperature_1"]).all() else "von_mises",
        ends_steady=distance is not None and distance <= _STEADY,
    )


def _state(time: float, interface: Path, track: Path, fields: Path) -> FrameState:
    worn = tables.read(track) if track.is_file() else None
    return FrameState(time, tables.read(interface), worn, fields)
