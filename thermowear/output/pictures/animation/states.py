"""Frames of a results folder, with its final state."""

from __future__ import annotations

import tomllib
from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ... import tables
from ...files import FRAMES, bodies_of, contacts_of, name_at, read_summary
from ...frames import frame_files

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
