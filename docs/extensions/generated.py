"""Extension of Sphinx that writes the generated pages before the site is built."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from .case_keys import key_pages
from .python_names import python_pages
from .verification_book import draw_book, verification_pages

MATHJAX = Path("/usr/share/javascript/mathjax")
_PLACES = {
    "reference/keys": key_pages,
    "reference/python": python_pages,
    "verification": verification_pages,
}


def setup(app) -> dict[str, Any]:
    """Register the pages with Sphinx."""
    app.connect("builder-inited", write_pages)
    app.connect("builder-inited", draw_pictures)
    app.connect("build-finished", copy_mathjax)
    return {"parallel_read_safe": True}


def write_pages(app) -> None:
    """Write the pages that have changed, and remove those that are made no longer."""
    for place, pages in _PLACES.items():
        folder = Path(app.srcdir) / place
        folder.mkdir(parents=True, exist_ok=True)
        made = pages()
        for old in folder.glob("*.md"):
            if old.stem not in made:
                old.unlink()
        for name, text in made.items():
            path = folder / f"{name}.md"
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                path.write_text(text, encoding="utf-8")


def draw_pictures(app) -> None:
    """Draw the pictures of the verification book that are out of date."""
    draw_book(Path(app.srcdir) / "verification" / "pictures")


def copy_mathjax(app, failure) -> None:
    """Copy MathJax into the site, so that it needs no network."""
    if failure is None and app.builder.format == "html" and MATHJAX.is_dir():
        target = Path(app.outdir) / "_static" / "mathjax"
        shutil.copytree(MATHJAX, target, dirs_exist_ok=True)
