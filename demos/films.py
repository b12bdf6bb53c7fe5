"""Demo cases in motion: runs that keep states on the way, and what `animate` makes of them.

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
    """A run to look at.

    Attributes
    ----------
    case : str
        Stem of the demo case.
    title, text : str
        What the gallery says.
    frames : int
        The most states that it has.
    """

    case: str
    title: str
    text: str
    frames: int = 50

    @property
    def name(self) -> str:
        """Of the file."""
        return f"{self.case}-film"

    @property
    def sets(self) -> tuple[str, ...]:
        """Overrides of the case."""
        return (f"analysis.frames={self.frames}",)


FILMS = (
    Film(
        "annular_punch_deep",
        "A ring that is worn away",
        "The pressure is steady soon; then the ring gets lower and its face cooler, as the way to "
        "the cooled top gets shorter.",
    ),
    Film(
        "block_on_ring",
        "A groove of the ring's radius",
        "From a line to a groove 2.7 mm wide, under ever less pressure.",
    ),
    Film(
        "disk_brake_stop",
        "A stop",
        "The disk is hottest before it stands; then the heat spreads.",
    ),
)


def draw_film(film: Film, results: Path, path: Path) -> None:
    """Compute a run into a folder below `results`; its film goes to a file.

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
