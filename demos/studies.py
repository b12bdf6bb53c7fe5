"""Distortion by heat: sweeps of the demo cases over the speed.

`gallery.py` computes and draws them. The steady pressure does not know the speed; the worn shape
bends in proportion to it, as friction heat does. The critical speeds of thermoelastic instability
are 1.5 times the highest ones or more.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Study:
    """A sweep and the picture of its worn shapes.

    Attributes
    ----------
    name, title, text : str
        Of the picture's file, and what the gallery says.
    case : str
        Stem of the demo case.
    key : str
        What is swept.
    values : tuple of str
    sets : tuple of str
        Overrides that are the same in all variants.
    """

    name: str
    title: str
    text: str
    case: str
    key: str
    values: tuple[str, ...]
    sets: tuple[str, ...] = ()

    @property
    def over(self) -> str:
        """Argument of ``--over``."""
        return f"{self.key}={','.join(self.values)}"


TURNING = "motion.angular_velocity"

HOT_DRUM = (
    'bodies.shoe={young_modulus="70 GPa", poisson_ratio=0.33, conductivity="160 W/(m K)", '
    'expansion="2.3e-5 1/K"}',
    'bodies.lining={young_modulus="0.5 GPa", poisson_ratio=0.25, conductivity="1 W/(m K)", '
    'expansion="1e-5 1/K"}',
    'bodies.drum={young_modulus="120 GPa", poisson_ratio=0.27, conductivity="48 W/(m K)", '
    'expansion="1.1e-5 1/K"}',
    'heat={advection="spread", conductance="1e4 W/(m^2 K)", partition=0.05, ambient="20 degC", '
    'cooling={drum_rim="60 W/(m^2 K)", drum_inside="60 W/(m^2 K)", shoe_inside="20 W/(m^2 K)"}}',
)
"""Heat data of the drum brake, chosen by us; the drum is so fast that it is as hot all round."""

STUDIES = (
    Study(
        "punch_on_strip-speeds",
        "A punch on a strip, by its speed (special case 1)",
        "Friction heat makes both bodies bulge, and the punch wears hollow to match, by 0.16 µm in "
        "the middle for each mm/s. Which of its ends is higher, and by how much, friction alone "
        "decides.",
        "punch_on_strip",
        "motion.velocity",
        ("0.001 mm/s", *(f"{v} mm/s" for v in (1.5, 3, 4.5, 6, 7.5, 9))),
    ),
    Study(
        "block_on_disk-speeds",
        "A block on a disk, by its speed (special case 3)",
        "Cold, friction bends the worn shape to one side. Heat makes the block bulge, and it wears "
        "hollow, by 0.83 µm for each rad/s, the same on both sides.",
        "block_on_disk",
        TURNING,
        ("1e-6 rad/s", *(f"{v} rad/s" for v in (0.2, 0.4, 0.6, 0.8, 1.0, 1.2))),
    ),
    Study(
        "drum_brake-speeds",
        "A shoe in a drum, by the drum's speed (special case 7)",
        "Cold, the middle of the lining wears most. Heated, the drum grows inwards from its held "
        "rim, and the shoe straightens: the ends wear most. The heat data are ours, and the drum "
        "so fast that it is as hot all round.",
        "drum_brake",
        TURNING,
        ("-1e-6 rad/s", *(f"{v} rad/s" for v in (-0.3, -0.6, -0.9, -1.2, -1.5, -1.8))),
        HOT_DRUM,
    ),
    Study(
        "annular_punch-speeds",
        "A ring on a plate, by its speed (special case 8)",
        "Cold, the inner edge is 40 µm high, where the pressure is largest. Friction heat is the "
        "same all over the face; it cups ring and plate alike, and turns the worn shape round.",
        "annular_punch",
        TURNING,
        ("1e-6 rad/s", *(f"{v} rad/s" for v in (0.015, 0.03, 0.045, 0.06, 0.075, 0.09))),
    ),
    Study(
        "disk_brake-speeds",
        "Brake pads on a disk, by its speed (special case 9)",
        "The soft pads bulge where they are hot, and wear hollow: at 6 rad/s almost five times as "
        "much as cold. The iron disk hardly bends.",
        "disk_brake",
        TURNING,
        ("1e-6 rad/s", *(f"{v} rad/s" for v in (1, 2, 3, 4, 5, 6))),
    ),
)


def draw_study(study: Study, results: Path, path: Path) -> None:
    """Compute a sweep into a folder below `results`; its picture of the shapes goes to a file.

    Raises
    ------
    subprocess.CalledProcessError
        If a variant fails.
    """
    folder = results / study.name
    command = [sys.executable, "-m", "thermowear", "sweep", str(HERE / f"{study.case}.toml")]
    command += ["--over", study.over, "-o", str(folder), "--overwrite"]
    for text in study.sets:
        command += ["--set", text]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    path.write_bytes((folder / "shapes.png").read_bytes())
