"""Everything that people see of a results folder, as lines of text: for comparison with earlier."""

from __future__ import annotations

import io
import json
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.text import Text
from rich.console import Console

from thermowear.output.console import print_summary
from thermowear.output.pictures import make, make_pictures, panels
from thermowear.output.report import write_report
from thermowear.output.sweep import draw_sweep, is_sweep


class PageText(HTMLParser):
    """Texts and titles of a page, without its style and the text of the case."""

    def __init__(self, text: str):
        super().__init__()
        self.lines: list[str] = []
        self._tag = ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self._tag = tag
        title = dict(attributes).get("title")
        self.lines += [f"({title})"] if title else []

    def handle_data(self, data):
        if data.strip() and self._tag not in {"style", "pre"}:
            self.lines.append(data.strip())


def shown(folder: Path, monkeypatch) -> list[str]:
    """Labels and sums of the curves of all pictures, the report, and the lines of the console."""
    lines: list[str] = []

    def draw(figure: Figure, path, *_) -> None:
        lines.extend([f"== {Path(path).name}", *_labels(figure), *_sums(figure)])

    monkeypatch.setattr(panels, "save", draw)
    monkeypatch.setattr(make, "attempt", lambda *_: "exit code 1")
    notes = draw_sweep(folder) if is_sweep(folder) else make_pictures(folder)
    lines += ["== notes", *(note.replace(str(folder), "FOLDER") for note in notes)]
    if is_sweep(folder):
        return lines
    page = write_report(folder).read_text(encoding="utf-8")
    lines += ["== report", *PageText(page.replace(str(folder), "FOLDER")).lines]
    summary = json.loads((folder / "summary.json").read_bytes())
    text = io.StringIO()
    print_summary(Console(file=text, width=120, color_system=None), summary, summary["seconds"])
    return lines + ["== console", *map(str.rstrip, text.getvalue().splitlines())]


def _labels(figure: Figure) -> list[str]:
    found = (text.get_text() for text in figure.findobj(lambda artist: isinstance(artist, Text)))
    return [text.replace("\n", " / ") for text in found if text]


def _sums(figure: Figure) -> list[str]:
    """Sums of the coordinates of each curve, and of the values of each map."""
    curves = [line.get_data() for axis in figure.axes for line in axis.get_lines()]
    maps = [c.get_array() for axis in figure.axes for c in axis.collections]
    sums = [" ".join(f"{np.nansum(np.asarray(v, float)):.6g}" for v in xy) for xy in curves]
    return sums + [f"{np.nansum(values):.6g}" for values in maps if values is not None]
