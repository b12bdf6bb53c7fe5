"""Gallery of the demo cases: computes all cases and writes README.md with pictures.

    make gallery                                    # or
    scripts/env python3 demos/gallery.py [-o DIR]   # results go to DIR/NAME, by default demos/out

The description of a case is the first paragraph of the comment at the head of its file.
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

from thermowear.case.starters import command_for
from thermowear.output.report.figures import figure_text

HERE = Path(__file__).resolve().parent
CHOICES = (
    ("hot_spots_3d", "fit", "tornado", "bodies"),
    ("hot_spots", "mode", "heat", "track", "cycles", "wear", "friction", "profile", "interface"),
    ("coating", "parameters", "distributions"),
)
SIDES = (
    1100,
    1000,
    900,
    800,
    700,
    600,
    500,
)  # longer side of a picture [pixels], in the order of trial
LARGEST = 120_000  # largest size of a picture [bytes]
FLAT = 1e-12  # smaller shapes are rounding errors [m]
KEYS = {
    "critical_speed_m_per_s": "critical speed",
    "critical_speed_with_wear_m_per_s": "with wear",
    "critical_angular_velocity_rad_per_s": "critical speed",
    "critical_angular_velocity_with_wear_rad_per_s": "with wear",
    "first_hot_spots_angular_velocity_rad_per_s": "first hot spots from",
    "max_pressure_Pa": "largest pressure",
    "shape_range_m": "peak-to-valley of the worn shape",
    "wear_volume_1_m3": "worn volume of body 1",
    "wear_volume_2_m3": "worn volume of body 2",
    "max_temperature_K": "highest temperature",
    "dissipated_energy_J": "dissipated energy",
}
HEAD = """# Demo cases

Each picture shows results of the command above it; `scripts/env COMMAND…` runs a command with all
packages. The case files explain their keys and can be modified. `make gallery` makes this page.
"""

COMPARISONS = """# Comparisons

Runs of the cases above with some keys changed, as defined in `slides.py`.
"""

MOTION = """# Animations

Runs of the cases above with `analysis.frames`, which keeps states at equal numbers of steps.
"""

SWEEPS = """# Distortion by heat

Sweeps of the cases above over the speed: one command computes all variants, with shared set-up.
The steady pressure does not depend on the speed. The worn shape changes in proportion to the speed,
as the friction heat does.
"""


def main() -> int:
    """Compute all cases and write the page."""
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
    """Compute a case in a separate process; returns its exit code."""
    made_for = command_for(case.read_text(encoding="utf-8"))
    command = [sys.executable, "-m", "thermowear", made_for, str(case), "-o", str(folder)]
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
        Folder to write to; pictures of earlier galleries are removed.
    cases : list of Path
    results : Path
        Folder with a results folder per case (of the same name), a picture per slide and study,
        and a GIF per film.
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

    It ends with the comment or at its first empty line.
    """
    words = []
    for line in case_text.splitlines():
        text = line.removeprefix("#").strip()
        if not line.startswith("#") or not text:
            break
        words.append(text)
    return " ".join(words)


def command_of(study: Study) -> list[str]:
    """Command that computes a study, as an indented block with one option per line."""
    options = [("--over", study.over), *(("--set", text) for text in study.sets)]
    lines = [f"python3 -m thermowear sweep demos/{study.case}.toml"]
    lines += [f"    {name} {shlex.quote(value)}" for name, value in options]
    return [f"    {line}" for line in " \\\n".join(lines).split("\n")]


def figures(summary: dict) -> str:
    """Key figures of a summary that exist and are not zero, in one line."""
    each = summary.get("contacts", {"": summary}).values()
    worn = any(contact["wear_coefficient_per"] for contact in each)
    found = {key: summary.get(key) for key in KEYS if worn or key != "shape_range_m"}
    if abs(found.get("shape_range_m") or 0.0) < FLAT:
        found["shape_range_m"] = None
    if summary.get("peak_temperature_K") is not None:  # during the run
        found["max_temperature_K"] = summary["peak_temperature_K"]
    said = [f"{KEYS[key]} {_rounded(figure_text(key, v))}" for key, v in found.items() if v]
    line = " · ".join(said)
    return line[:1].upper() + line[1:]


def small_png(source: Path) -> bytes:
    """Picture reduced to at most `LARGEST` bytes by fewer pixels.

    Fewer colours would save more, but cause colour bands in fields.
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
    """Section of the page for a case; copies its pictures."""
    text = case.read_text(encoding="utf-8")
    path = folder / "summary.json"
    summary = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    lines = [f"## {tomllib.loads(text)['title']}", "", *textwrap.wrap(leading_text(text), 100), ""]
    lines += [f"    python3 -m thermowear {command_for(text)} demos/{case.name}", ""]
    lines += [figures(summary), ""] if summary else []
    for names in CHOICES:
        for name in _drawn(folder, names, list(summary.get("contacts", {}))):
            (pictures / f"{case.stem}-{name}.png").write_bytes(small_png(folder / f"{name}.png"))
            lines += [f"![{case.stem}: {name}](pictures/{case.stem}-{name}.png)", ""]
    return "\n".join(lines)


def _drawn(folder: Path, names: Sequence[str], contacts: Sequence[str]) -> list[str]:
    """First of some pictures that exists, of several bodies those of their first two contacts."""
    for name in names:
        stems = [name, *(f"{name}_{contact}" for contact in contacts)]
        found = [stem for stem in stems if (folder / f"{stem}.png").is_file()]
        if found:
            return found[:2]
    return []


def _film(film: Film, results: Path, pictures: Path) -> str:
    """Section of the page for a film; copies the film."""
    shown = f"pictures/{film.name}.gif"
    shutil.copyfile(results / f"{film.name}.gif", pictures / f"{film.name}.gif")
    sets = " ".join(f"--set {shlex.quote(text)}" for text in film.sets)
    run = f"    python3 -m thermowear run demos/{film.case}.toml -o results/film {sets}"
    lines = [f"## {film.title}", "", *textwrap.wrap(film.text, 100), "", run]
    lines += ["    python3 -m thermowear animate results/film", "", f"![{film.title}]({shown})", ""]
    return "\n".join(lines)


def _rounded(text: str) -> str:
    """Round a number with unit to four digits."""
    value, _, unit = text.partition(" ")
    return f"{float(f'{float(value):.4g}'):.12g} {unit}"


if __name__ == "__main__":
    sys.exit(main())
