"""The gallery of the demo cases: computes all of them and writes README.md with pictures.

    make gallery                                    # or
    scripts/env python3 demos/gallery.py [-o DIR]   # results go to DIR/NAME, by default demos/out

What it says of a case is the first paragraph of the comment at the head of its file.
"""

from __future__ import annotations

import argparse
import io
import json
import shlex
import shutil
import subprocess
import sys
import textwrap
import tomllib
from collections.abc import Sequence
from pathlib import Path

from films import FILMS, Film, draw_film
from PIL import Image
from slides import SLIDES, Slide, draw_slide
from studies import STUDIES, Study, draw_study

from thermowear.output.report.figures import figure_text

HERE = Path(__file__).resolve().parent
CHOICES = (
    ("bodies",),
    ("mode", "heat", "track", "cycles", "wear", "friction", "profile", "interface"),
)
SIDES = (1100, 1000, 900, 800, 700, 600, 500)  # pixels of the longer side of a picture
LARGEST = 120_000  # bytes of a picture
FLAT = 1e-12  # m: rounding, not a worn shape
KEYS = {
    "critical_speed_m_per_s": "critical speed",
    "critical_speed_with_wear_m_per_s": "with wear",
    "critical_angular_velocity_rad_per_s": "critical speed",
    "critical_angular_velocity_with_wear_rad_per_s": "with wear",
    "max_pressure_Pa": "largest pressure",
    "shape_range_m": "worn shape, highest to lowest",
    "wear_volume_1_m3": "worn off body 1",
    "wear_volume_2_m3": "worn off body 2",
    "max_temperature_K": "highest temperature",
    "dissipated_energy_J": "energy dissipated",
}
HEAD = """# Demo cases

Each picture shows what the command above it computes; `scripts/env COMMAND…` runs a command where
all packages are. The cases explain their keys: change them. This page is made by `make gallery`.
"""

COMPARISONS = """# One thing varied

Runs of the cases above with some keys changed; `slides.py` says which.
"""

MOTION = """# In motion

Runs of the cases above that keep states on the way, each as far from the last as the steps go.
"""

SWEEPS = """# Distortion by heat

Sweeps of the cases above over the speed: one command each computes all variants, and what they
share once. The steady pressure does not know the speed. The worn shape does: it bends in proportion
to the speed, as the friction heat does.
"""


def main() -> int:
    """Compute the cases and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", metavar="DIR", type=Path, default=HERE / "out")
    results = parser.parse_args().output
    cases = sorted(HERE.glob("*.toml"))
    for case in cases:
        print(f"{case.stem} …", flush=True)
        code = compute(case, results / case.stem)
        if code != 0:
            print(f"error: {case.stem} ended with exit code {code}", file=sys.stderr)
            return code
    for slide in SLIDES:
        print(f"{slide.name} …", flush=True)
        draw_slide(slide, results, results / f"{slide.name}.png")
    for study in STUDIES:
        print(f"{study.name} …", flush=True)
        draw_study(study, results, results / f"{study.name}.png")
    for film in FILMS:
        print(f"{film.name} …", flush=True)
        draw_film(film, results, results / f"{film.name}.gif")
    write_gallery(HERE, cases, results, SLIDES, STUDIES, FILMS)
    return 0


def compute(case: Path, folder: Path) -> int:
    """Run a case in a process of its own; its exit code."""
    command = [sys.executable, "-m", "thermowear", "run", str(case), "-o", str(folder)]
    return subprocess.run([*command, "--overwrite"], check=False).returncode


def write_gallery(
    place: Path,
    cases: list[Path],
    results: Path,
    slides: Sequence[Slide] = (),
    studies: Sequence[Study] = (),
    films: Sequence[Film] = (),
) -> None:
    """Write ``README.md`` and ``pictures/`` from the results of the cases.

    Parameters
    ----------
    place : Path
        Where they are written; pictures of earlier galleries are removed.
    cases : list of Path
    results : Path
        Holds a results folder for each case, named like it, a picture for each slide and study,
        and a GIF for each film.
    slides : sequence of Slide
    studies : sequence of Study
    films : sequence of Film
    """
    pictures = place / "pictures"
    pictures.mkdir(exist_ok=True)
    for old in (*pictures.glob("*.png"), *pictures.glob("*.gif")):
        old.unlink()
    entries = [_entry(case, results / case.stem, pictures) for case in cases]
    for head, drawn in ((COMPARISONS, slides), (SWEEPS, studies)):
        entries += [head] if drawn else []
        for one in drawn:
            (pictures / f"{one.name}.png").write_bytes(small_png(results / f"{one.name}.png"))
            lines = [f"## {one.title}", "", *textwrap.wrap(one.text, 100), ""]
            lines += [*command_of(one), ""] if isinstance(one, Study) else []
            entries.append("\n".join([*lines, f"![{one.title}](pictures/{one.name}.png)", ""]))
    entries += [MOTION] if films else []
    entries += [_film(one, results, pictures) for one in films]
    (place / "README.md").write_text("\n".join([HEAD, *entries]), encoding="utf-8")


def leading_text(case_text: str) -> str:
    """First paragraph of the comment at the head of a case file, as one line.

    It ends where the comment does, or at a line of it that is empty.
    """
    words = []
    for line in case_text.splitlines():
        text = line.removeprefix("#").strip()
        if not line.startswith("#") or not text:
            break
        words.append(text)
    return " ".join(words)


def command_of(study: Study) -> list[str]:
    """The command that computes a study, as an indented block: an option a line."""
    options = [("--over", study.over), *(("--set", text) for text in study.sets)]
    lines = [f"python3 -m thermowear sweep demos/{study.case}.toml"]
    lines += [f"    {name} {shlex.quote(value)}" for name, value in options]
    return [f"    {line}" for line in " \\\n".join(lines).split("\n")]


def figures(summary: dict) -> str:
    """Key figures of a summary that say something, in one line."""
    worn = bool(summary["wear_coefficient_per"])
    found = {key: summary.get(key) for key in KEYS if worn or key != "shape_range_m"}
    if abs(found.get("shape_range_m") or 0.0) < FLAT:
        found["shape_range_m"] = None
    if summary.get("peak_temperature_K") is not None:  # on the way, not at the end
        found["max_temperature_K"] = summary["peak_temperature_K"]
    said = [f"{KEYS[key]} {_rounded(figure_text(key, v))}" for key, v in found.items() if v]
    line = " · ".join(said)
    return line[:1].upper() + line[1:]


def small_png(source: Path) -> bytes:
    """A picture with fewer pixels, so many that it has `LARGEST` bytes at most.

    Fewer colours would save more, but draw bands into fields.
    """
    with Image.open(source) as picture:
        opaque = picture.convert("RGB")
    for side in SIDES:
        opaque.thumbnail((side, side), Image.Resampling.LANCZOS)
        content = io.BytesIO()
        opaque.save(content, "PNG", optimize=True)
        if content.tell() <= LARGEST:
            break
    return content.getvalue()


def _entry(case: Path, folder: Path, pictures: Path) -> str:
    """The part of the page for a case; its pictures are put in their place."""
    text = case.read_text(encoding="utf-8")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    lines = [f"## {tomllib.loads(text)['title']}", "", *textwrap.wrap(leading_text(text), 100), ""]
    lines += [f"    python3 -m thermowear run demos/{case.name}", "", figures(summary), ""]
    for names in CHOICES:
        drawn = [name for name in names if (folder / f"{name}.png").is_file()]
        for name in drawn[:1]:
            (pictures / f"{case.stem}-{name}.png").write_bytes(small_png(folder / f"{name}.png"))
            lines += [f"![{case.stem}: {name}](pictures/{case.stem}-{name}.png)", ""]
    return "\n".join(lines)


def _film(film: Film, results: Path, pictures: Path) -> str:
    """The part of the page for a film, which is put in its place."""
    shown = f"pictures/{film.name}.gif"
    shutil.copyfile(results / f"{film.name}.gif", pictures / f"{film.name}.gif")
    sets = " ".join(f"--set {shlex.quote(text)}" for text in film.sets)
    run = f"    python3 -m thermowear run demos/{film.case}.toml -o results/film {sets}"
    lines = [f"## {film.title}", "", *textwrap.wrap(film.text, 100), "", run]
    lines += ["    python3 -m thermowear animate results/film", "", f"![{film.title}]({shown})", ""]
    return "\n".join(lines)


def _rounded(text: str) -> str:
    """Four digits of a number with its unit."""
    value, _, unit = text.partition(" ")
    return f"{float(f'{float(value):.4g}'):.12g} {unit}"


if __name__ == "__main__":
    sys.exit(main())
