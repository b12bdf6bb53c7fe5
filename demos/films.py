"""Animations of demo cases, drawn by `animate` from runs with `analysis.frames`.

`gallery.py` computes and draws them.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Film:
    """Animated run.

    Attributes
    ----------
    case : str
        Stem of the demo case.
    title, text : str
        Title and description in the gallery.
    frames : int
        Largest number of states.
    """

    case: str
    title: str
    text: str
    frames: int = 50

    @property
    def name(self) -> str:
        """Stem of the file."""
        return f"{self.case}-film"

    @property
    def sets(self) -> tuple[str, ...]:
        """Overrides of the case."""
        return (f"analysis.frames={self.frames}",)


FILMS = (
    Film(
        "annular_punch_deep",
        "Deep wear of a ring",
        "The pressure becomes steady early; then the height of the ring falls, and its face "
        "becomes cooler, as the distance to the cooled top decreases.",
    ),
    Film(
        "block_on_ring",
        "Wear of a groove with the radius of the ring",
        "From a line contact to a groove of 2.7 mm width, with decreasing pressure.",
    ),
    Film(
        "disk_brake_stop",
        "Stop of a disk brake",
        "The temperature of the disk is highest before the stop; then the heat spreads.",
    ),
)


def draw_film(film: Film, results: Path, path: Path) -> None:
    """Compute a run into a folder below `results`, and write its animation to a file.

    Raises
    ------
    subprocess.CalledProcessError
        If the run fails.
    """
    folder, program = results / film.name, [sys.executable, "-m", "thermowear"]
    run = [*program, "run", str(HERE / f"{film.case}.toml"), "-o", str(folder)]
    for text in film.sets:
        run += ["--set", text]
    for command in (
        [*run, "--overwrite", "--no-pictures"],
        [*program, "animate", str(folder), "-o", str(path)],
    ):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
