"""``frames/``: states on the way, for animations and for ParaView (``frames.pvd``)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from .quantities import INTERFACE, TRACK
from .replacing import replacing
from .tables import write_points
from .vtu import write_fields

FRAMES = "frames"
_INDEX = "frames.pvd"


@dataclass(frozen=True)
class FrameFiles:
    """Where a state on the way is kept; see `thermowear.simulation.Frame`.

    Attributes
    ----------
    time : float
        [s]
    number : int
    place : Path
        The folder of the frames.
    """

    time: float
    number: int
    place: Path

    @property
    def fields(self) -> Path:
        return self.place / f"fields_{self.number:05d}.vtu"

    @property
    def interface(self) -> Path:
        return self.place / f"interface_{self.number:05d}.csv"

    @property
    def track(self) -> Path:
        """There in a reciprocating analysis only."""
        return self.place / f"track_{self.number:05d}.csv"

    def remove(self) -> None:
        for path in (self.fields, self.interface, self.track):
            path.unlink(missing_ok=True)


def write_frame(place: Path, frame) -> None:
    """Write a frame in single precision, which pictures do not tell from double.

    The index names a frame only while all of its files are there. Frames that are given up, and
    those of a later step that an earlier run has reached, are removed.

    Parameters
    ----------
    place : Path
        Made with the first frame.
    frame : thermowear.simulation.Frame
    """
    place.mkdir(exist_ok=True)
    new = FrameFiles(frame.time, frame.number, place)
    write_points(new.interface, INTERFACE, frame.interface)
    if frame.track is not None:
        write_points(new.track, TRACK, frame.track)
    write_fields(new.fields, _single(frame.fields))
    earlier = [old for old in frame_files(place) if old.number != new.number]
    kept = [o for o in earlier if o.number < new.number and o.number % frame.every == 0]
    _write_index(place, [*kept, new])
    for old in earlier:
        if old not in kept:
            old.remove()


def frame_files(place: Path) -> list[FrameFiles]:
    """The frames of a folder in the order of time; none if there is no such folder.

    Raises
    ------
    ValueError
        If the index is not one of this program.
    """
    index = place / _INDEX
    if not index.is_file():
        return []
    try:
        sets = ET.parse(index).getroot().iter("DataSet")
        found = [(float(s.attrib["timestep"]), s.attrib["file"]) for s in sets]
        numbers = [int(file.removeprefix("fields_").removesuffix(".vtu")) for _, file in found]
    except (ET.ParseError, KeyError, ValueError):
        raise ValueError(f"{index}: not an index of frames") from None
    return [FrameFiles(t, number, place) for (t, _), number in zip(found, numbers, strict=True)]


def remove_frames(place: Path) -> None:
    """Remove what `write_frame` has written, and the folder if nothing else is in it."""
    for pattern in ("fields_*.vtu", "interface_*.csv", "track_*.csv", _INDEX, f".{_INDEX}.part"):
        for path in place.glob(pattern):
            path.unlink()
    if not any(place.iterdir()):
        place.rmdir()


def _write_index(place: Path, frames: list[FrameFiles]) -> None:
    """Name the frames, in a file that ParaView opens."""
    root = ET.Element("VTKFile", type="Collection", version="0.1")
    collection = ET.SubElement(root, "Collection")
    for frame in frames:
        ET.SubElement(collection, "DataSet", timestep=f"{frame.time:.15g}", file=frame.fields.name)
    ET.indent(root)
    with replacing(place / _INDEX) as draft:
        ET.ElementTree(root).write(draft, encoding="utf-8", xml_declaration=True)


def _single(fields):
    """Fields in single precision."""
    names = ("points", "displacement", "von_mises", "temperature")
    values = {name: getattr(fields, name) for name in names}
    short = {name: v.astype(np.float32) for name, v in values.items() if v is not None}
    return replace(fields, **short)
