"""Comparisons of several runs of a case, as in Páczelt and Mróz's lectures.

`gallery.py` draws them. Each run is a demo case with some keys changed.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np

from thermowear.output import tables
from thermowear.output.pictures.panels import clip_singular, column, plot_along
from thermowear.results import TABLES

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Slide:
    """Picture comparing several runs.

    Attributes
    ----------
    name, title, text : str
        Stem of the picture file, title and description in the gallery.
    case : str
        Stem of the demo case.
    runs : dict of str to tuple of str
        Overrides of the case by legend entry; ``{previous}`` in them stands for the results folder
        of the previous run.
    panels : tuple of str
        Columns of ``interface.csv`` or ``profile.csv``, by the names of their fields.
    """

    name: str
    title: str
    text: str
    case: str
    runs: dict[str, tuple[str, ...]]
    panels: tuple[str, ...]


COLD = "motion.angular_velocity=1e-6 rad/s"
"""Override for a speed without noticeable friction heat."""

PRESSURE, SHAPE, ALONG, RATE = "pressure", "shape", "shape_along_press", "wear_rate"
FROM_ZERO = {PRESSURE, RATE}

_ON = "analysis={type='transient', until='steady', tolerance=1e-3}"
_FROM = "geometry.initial_shape={previous}/profile.csv"

SLIDES = (
    Slide(
        "block_on_disk-friction",
        "Influence of friction on a block on a disk (special case 3)",
        "On a symmetric arc the steady pressure is proportional to the cosine of the angle and "
        "does not depend on friction. The worn shapes along the normal and along the load "
        "direction do. Without heat.",
        "block_on_disk",
        {f"mu = {mu}": (f"contact.friction={mu}", COLD) for mu in (0.05, 0.15, 0.3, 0.45)},
        (PRESSURE, SHAPE, ALONG),
    ),
    Slide(
        "block_on_disk-heat",
        "Influence of friction heat on a block on a disk (special case 3)",
        "The thermal bulge of the bodies grows with the speed of the disk, and the block wears to "
        "a different shape under the same pressure. Clockwise rotation gives the mirror image.",
        "block_on_disk",
        {
            "cold": (COLD,),
            **{f"{w} rad/s": (f"motion.angular_velocity={w} rad/s",) for w in (0.3, 1.0)},
            "1.0 rad/s, clockwise": ("motion.angular_velocity=-1 rad/s",),
        },
        (PRESSURE, SHAPE, ALONG),
    ),
    Slide(
        "ring_segment_on_disk-senses",
        "Influence of the sense of rotation on a ring segment (special case 4)",
        "Pressure of the unworn faces and in the steady state, and worn shape along the load "
        "direction.",
        "ring_segment_on_disk",
        {
            "unworn, anticlockwise": ('analysis={type="initial"}',),
            "steady, anticlockwise": (),
            "steady, clockwise": ("motion.angular_velocity=-1 rad/s",),
        },
        (PRESSURE, ALONG),
    ),
    Slide(
        "drum_brake-senses",
        "Leading and trailing shoe of a drum brake (special case 7)",
        "Both pressures follow the long-shoe law; for the same moment the pressure of the leading "
        "shoe is much larger.",
        "drum_brake",
        {
            "leading (clockwise)": (),
            "trailing (anticlockwise)": ("motion.angular_velocity=5 rad/s",),
        },
        (PRESSURE, RATE, SHAPE),
    ),
    Slide(
        "pivoted_block-senses",
        "Influence of the direction of the strip on a pivoted block (special case 5)",
        "Friction increases the pressure if the strip runs towards the pivot and reduces it in the "
        "other direction; the exponent of the wear law determines whether the pressure is linear, "
        "a root or a parabola.",
        "pivoted_block",
        {
            "towards the pivot, b = 1": ("motion.velocity=50 mm/s",),
            "away from it, b = 1": (),
            "away from it, b = 2": (
                "wear.block.pressure_exponent=2.0",
                "wear.block.coefficient=1e-7 1/MPa^2",
            ),
        },
        (PRESSURE, RATE, SHAPE),
    ),
    Slide(
        "punch_on_strip-friction",
        "Influence of friction on a tilting block (special case 6)",
        "With increasing friction on the face below the pin the load moves to the leading edge; "
        "finally the trailing edge lifts off.",
        "punch_on_strip_tilting",
        {f"mu = {mu}": (f"contact.friction={mu}",) for mu in (0.1, 0.3, 0.5, 0.9)},
        (PRESSURE, SHAPE),
    ),
    Slide(
        "annular_punch-exponents",
        "Influence of wear law and heat on a ring (special case 8)",
        "For wear rates proportional to p^b the steady pressure is proportional to r^(-1/b) for "
        "any materials. Friction heat inverts the worn shape and does not change the pressure.",
        "annular_punch",
        {
            f"b = {b:g}{', cold' if cold else ', hot'}": (
                f"wear.punch.pressure_exponent={b}",
                f"wear.punch.coefficient=2e-7 1/MPa^{b}",
                *((COLD,) if cold else ()),
            )
            for cold in (True, False)
            for b in (0.5, 1.0, 2.0)
        },
        (PRESSURE, SHAPE),
    ),
    Slide(
        "annular_punch-story",
        "Successive steady shapes of one ring (special case 8)",
        "Running-in under 100 MPa with b = 2, then under 50 MPa with b = 1, then with friction "
        "heat at higher speed, each from the previous worn shape.",
        "annular_punch",
        {
            "b = 2, 100 MPa": (
                COLD,
                "wear.punch.pressure_exponent=2.0",
                "wear.punch.coefficient=2e-7 1/MPa^2",
                "load.mean_pressure=100 MPa",
            ),
            "then b = 1, 50 MPa": (COLD, _ON, _FROM),
            "then hot": (_ON, _FROM),
        },
        (PRESSURE, SHAPE),
    ),
)


def draw_slide(slide: Slide, results: Path, path: Path) -> None:
    """Compute the runs of a slide into folders below `results`, and draw them into a file.

    Raises
    ------
    subprocess.CalledProcessError
        If a run fails.
    """
    folders: dict[str, Path] = {}
    previous = results
    for number, (label, overrides) in enumerate(slide.runs.items(), start=1):
        folders[label] = results / f"{slide.name}-{number}"
        command = [sys.executable, "-m", "thermowear", "run", str(HERE / f"{slide.case}.toml")]
        command += ["-o", str(folders[label]), "--overwrite", "--no-pictures"]
        for text in overrides:
            command += ["--set", text.replace("{previous}", str(previous))]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        previous = folders[label]
    draw_runs(folders, slide.panels, path)


def draw_runs(runs: dict[str, Path], panels: tuple[str, ...], path: Path) -> None:
    """Draw quantities of several runs along the contact, by the legend entries of the runs."""
    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(runs)))
    styles = ("-", "--", "-.", ":")
    with column(path, len(panels), 2.6) as axes:
        for axis, name in zip(axes, panels, strict=True):
            stem = "interface" if name in TABLES["interface"].columns else "profile"
            found = [tables.read(folder / f"{stem}.csv") for folder in runs.values()]
            for k, (label, data) in enumerate(zip(runs, found, strict=True)):
                plot_along(axis, data, name, styles[k % 4], color=colors[k], label=label)
            clip_singular(axis, [data.drawn(name) for data in found])
            axis.set_ylabel(found[0].quantities[name].wrapped)
            if name in FROM_ZERO:
                axis.set_ylim(bottom=0)
        axes[0].legend()
