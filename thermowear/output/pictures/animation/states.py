"""Frames of a results folder, with its final state."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np

from ....results import FIELDS
from ....results.quantity import Quantity
from ... import tables
from ...coordinates import read_summary
from ...frames import frame_files
from ...names import FRAMES

_CORNERS = {"triangle": [[0, 1, 2]], "quad": [[0, 1, 2], [0, 2, 3]]}
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
class Film:
    """All states of an animation; the last one is the end of the run.

    Attributes
    ----------
    states : list of FrameState
    title : str
        Title of the case.
    course : TableColumns
        Columns of ``history.csv``, or of ``cycles.csv`` or ``loads.csv``.
    even : bool
        True for a linear time axis, with prescribed loads or temperatures in time; running-in
        without them slows down and is shown on a logarithmic axis.
    hot : bool
        True if the case has temperatures.
    ends_steady : bool
        True if the final state is close to the steady state.
    """

    states: list[FrameState]
    title: str
    course: tables.TableColumns
    even: bool
    hot: bool
    ends_steady: bool


def read_film(folder: Path) -> Film:
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
    name = next(name for name in _COURSES if (folder / name).is_file())
    course = tables.read(folder / name)
    end = float(course["time"][-1])
    states = [state for state in states if state.time < end]
    last = tables.read(folder / "interface.csv")
    states.append(FrameState(end, last, _track(folder / "track.csv"), folder / "fields.vtu"))
    distance = read_summary(folder).get("distance_from_steady")
    return Film(
        states=states,
        title=_title(folder),
        course=course,
        even=name != "history.csv" or (folder / "heat.csv").is_file(),
        hot=bool(np.isfinite(last["temperature_1"]).all()),
        ends_steady=distance is not None and distance <= _STEADY,
    )


def read_fields(
    state: FrameState, hot: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Read the fields of 2D bodies as triangles; cells share no points.

    Returns
    -------
    tuple of ndarray
        Displaced points, shape (n, 2) [mm]; triangles, shape (m, 3); body of each triangle, shape
        (m,); values at the points, see `shown_field`.
    """
    mesh = meshio.read(state.file)
    block, body = mesh.cells[0], mesh.cell_data["body"][0]
    corners = np.array(_CORNERS[block.type])
    triangles = block.data[:, corners].reshape(-1, 3)
    points = 1e3 * (mesh.points + mesh.point_data["displacement_m"])[:, :2]
    shown = shown_field(hot)
    values = shown.drawn(mesh.point_data[shown.header])
    return points, triangles, np.repeat(body, len(corners)), values


def shown_field(hot: bool) -> Quantity:
    """Displayed field: the temperature if there is one, else the stress."""
    return FIELDS["temperature" if hot else "von_mises"]


_COURSES = ("history.csv", "cycles.csv", "loads.csv")


def _track(path: Path) -> tables.TableColumns | None:
    return tables.read(path) if path.is_file() else None


def _title(folder: Path) -> str:
    import tomllib

    return tomllib.loads((folder / "case.resolved.toml").read_text("utf-8")).get("title", "")
