"""Distortion by heat: sweeps of the demo cases over the speed.

`gallery.py` computes and draws them. The steady pressure does not depend on the speed; the worn
shape changes in proportion to it, as friction heat does. The critical speeds of thermoelastic
instability are at least 1.5 times the highest speeds.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Study:
    """Sweep with the picture of its worn shapes.

    Attributes
    ----------
    name, title, text : str
        Stem of the picture file, title and description in the gallery.
    case : str
        Stem of the demo case.
    key : str
        Swept key.
    values : tuple of str
    sets : tuple of str
        Overrides of all variants.
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
"""Heat data of the drum brake (our choice), with the high-speed limit of advection in the drum."""

STUDIES = (
    Study(
        "punch_on_strip-speeds",
        "Influence of speed on a punch on a strip (special case 1)",
        "Friction heat makes both bodies bulge, and the punch wears to a concave shape, by 0.16 µm "
        "in the middle per mm/s. The height difference of its ends depends on friction only.",
        "punch_on_strip",
        "motion.velocity",
        ("0.001 mm/s", *(f"{v} mm/s" for v in (1.5, 3, 4.5, 6, 7.5, 9))),
    ),
    Study(
        "block_on_disk-speeds",
        "Influence of speed on a block on a disk (special case 3)",
        "Without heat, friction skews the worn shape. Friction heat makes the block bulge, and it "
        "wears to a concave shape, by 0.83 µm per rad/s, symmetrically.",
        "block_on_disk",
        TURNING,
        ("1e-6 rad/s", *(f"{v} rad/s" for v in (0.2, 0.4, 0.6, 0.8, 1.0, 1.2))),
    ),
    Study(
        "drum_brake-speeds",
        "Influence of speed on a shoe in a drum (special case 7)",
        "Without heat, the middle of the lining wears most. Heated, the drum expands inwards from "
        "its fixed rim, and the shoe straightens: the ends wear most. The heat data are our "
        "choice, with the high-speed limit of advection in the drum.",
        "drum_brake",
        TURNING,
        ("-1e-6 rad/s", *(f"{v} rad/s" for v in (-0.3, -0.6, -0.9, -1.2, -1.5, -1.8))),
        HOT_DRUM,
    ),
    Study(
        "annular_punch-speeds",
        "Influence of speed on a ring on a plate (special case 8)",
        "Without heat, the inner edge, where the pressure is largest, is 40 µm high. Friction heat "
        "is uniform over the face; it bends ring and plate, and inverts the worn shape.",
        "annular_punch",
        TURNING,
        ("1e-6 rad/s", *(f"{v} rad/s" for v in (0.015, 0.03, 0.045, 0.06, 0.075, 0.09))),
    ),
    Study(
        "disk_brake-speeds",
        "Influence of speed on brake pads on a disk (special case 9)",
        "The soft pads bulge by heat and wear to a concave shape: at 6 rad/s almost five times as "
        "much as without heat. The iron disk hardly deforms.",
        "disk_brake",
        TURNING,
        ("1e-6 rad/s", *(f"{v} rad/s" for v in (1, 2, 3, 4, 5, 6))),
    ),
)


def draw_study(study: Study, results: Path, path: Path) -> None:
    """Compute a sweep into a folder below `results`, and copy its picture of the shapes to a file.

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
