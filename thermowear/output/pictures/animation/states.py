"""Frames of a results folder, with its final state."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ... import tables
from ...coordinates import read_summary
from ...frames import frame_files
from ...names import FRAMES

_HISTORIES = ("history.csv", "cycles.csv", "loads.csv")
_STEADY = 1e-2  # distance from the steady state up to which the final state is called steady


@dataclass(frozen=True)
class FrameState:
    """State of the results at one time.

    Attributes
    ----------
    time : float
        Time [s].
    interface : TableColumns
        Columns of ``interface.csv``.
    track : TableColumns or None
        Columns of ``track.csv``, in reciprocating analyses.
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


def read_frames(folder: Path) -> FrameSequence:
    """Read all data of an animation except the fields.

    Raises
    ------
    ValueError
        If a file does not have the expected columns.
    """
    states = [
        FrameState(
            f.time, tables.read(f.file("interface")), _track(f.file("track")), f.file("fields")
        )
        for f in frame_files(folder / FRAMES)
    ]
    name = next(name for name in _HISTORIES if (folder / name).is_file())
    history = tables.read(folder / name)
    end = float(history["time"][-1])
    states = [state for state in states if state.time < end]
    last = tables.read(folder / "interface.csv")
    states.append(FrameState(end, last, _track(folder / "track.csv"), folder / "fields.vtu"))
    distance = read_summary(folder).get("distance_from_steady")
    return FrameSequence(
        states=states,
        title=_title(folder),
        history=history,
        even=name != "history.csv" or (folder / "heat.csv").is_file(),
        field="temperature" if np.isfinite(last["temperature_1"]).all() else "von_mises",
        ends_steady=distance is not None and distance <= _STEADY,
    )


def _track(path: Path) -> tables.TableColumns | None:
    return tables.read(path) if path.is_file() else None


def _title(folder: Path) -> str:
    return tomllib.loads((folder / "case.resolved.toml").read_text("utf-8")).get("title", "")
