"""One thing varied: pictures of several runs of a case, as in Páczelt and Mróz's lectures.

`gallery.py` draws them. Each run is one of a demo case with some keys changed.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from thermowear.output.pictures.overlay import Panel, draw_overlay

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Slide:
    """A picture of several runs.

    Attributes
    ----------
    name, title, text : str
        Of the picture's file, and what the gallery says.
    case : str
        Stem of the demo case.
    runs : dict of str to tuple of str
        Overrides of the case by what is said of them in the legend; ``{previous}`` in them stands
        for the results folder of the run before.
    panels : tuple of Panel
    """

    name: str
    title: str
    text: str
    case: str
    runs: dict[str, tuple[str, ...]]
    panels: tuple[Panel, ...]


COLD = "motion.angular_velocity=1e-6 rad/s"
"""So slow that there is no friction heat."""

PRESSURE, SHAPE = Panel("pressure", from_zero=True), Panel("shape")
ALONG, RATE = Panel("shape_along_press"), Panel("wear_rate", from_zero=True)

_ON = "analysis={type='transient', until='steady', tolerance=1e-3}"
_FROM = "geometry.initial_shape={previous}/profile.csv"

SLIDES = (
    Slide(
        "block_on_disk-friction",
        "Friction bends the worn shape of a block on a disk, and not its pressure (special case 3)",
        "On a symmetric arc the steady pressure does not know the friction, and goes with the "
        "cosine of the angle. The worn shapes, along the normal and along the press, do. Cold.",
        "block_on_disk",
        {f"mu = {mu}": (f"contact.friction={mu}", COLD) for mu in (0.05, 0.15, 0.3, 0.45)},
        (PRESSURE, SHAPE, ALONG),
    ),
    Slide(
        "block_on_disk-heat",
        "Friction heat bends it too (special case 3)",
        "The faster the disk turns the more the heated bodies bulge, and the block wears to match: "
        "another shape under the same pressure. Clockwise is the mirror image.",
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
        "A ring segment, by the sense of rotation (special case 4)",
        "Pressure before any wear and in the steady state, and the worn shape along the press.",
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
        "Both follow the long-shoe law; the same moment presses the leading shoe much harder.",
        "drum_brake",
        {
            "leading (clockwise)": (),
            "trailing (anticlockwise)": ("motion.angular_velocity=5 rad/s",),
        },
        (PRESSURE, RATE, SHAPE),
    ),
    Slide(
        "pivoted_block-senses",
        "Which way the strip runs (special case 5)",
        "Running towards the pivot friction presses the block on, away from it friction lifts it "
        "off; the law of wear makes the pressure a straight line, a root or a parabola.",
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
        "How far friction tilts a block (special case 6)",
        "The more friction pulls at the face below the pin, the more the leading edge carries; in "
        "the end the trailing edge lifts off.",
        "punch_on_strip_tilting",
        {f"mu = {mu}": (f"contact.friction={mu}",) for mu in (0.1, 0.3, 0.5, 0.9)},
        (PRESSURE, SHAPE),
    ),
    Slide(
        "annular_punch-exponents",
        "The law of wear decides the pressure, heat only the shape (special case 8)",
        "Rates that grow as p^b: the steady pressure goes with r^(-1/b) whatever the bodies are "
        "made of. Friction heat turns the worn face round, and leaves the pressure alone.",
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
        "One ring, three steady shapes (special case 8)",
        "Worn in under 100 MPa by a law with b = 2; then under 50 MPa with b = 1; then so fast "
        "that friction heats it. Each time it runs in from the shape before.",
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
    """Compute the runs of a slide into folders below `results`, and draw them to a file.

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
    draw_overlay(folders, slide.panels, path)
