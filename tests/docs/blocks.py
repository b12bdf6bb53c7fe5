"""Blocks of the documents: fragments of cases, commands, programs."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

TOP = Path(__file__).parents[2]
PAGES = {
    path.relative_to(TOP).as_posix(): path
    for path in (TOP / "README.md", *sorted((TOP / "docs").rglob("*.md")))
    if "_build" not in path.parts and "keys" not in path.parts and path.parent.name != "python"
}
_FENCED = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_PROGRAM = re.compile(r"^(?:scripts/env )?(?:python3 -m )?thermowear ")


@dataclass(frozen=True)
class Block:
    """Fenced block of a page.

    Attributes
    ----------
    page : str
    line : int
    language : str
    text : str
    """

    page: str
    line: int
    language: str
    text: str

    @property
    def id(self) -> str:
        return f"{self.page}:{self.line}"


def fenced(language: str) -> list[Block]:
    """Fenced blocks of a language, of all pages."""
    found = []
    for page, path in PAGES.items():
        text = path.read_text(encoding="utf-8")
        for block in _FENCED.finditer(text):
            line = text.count("\n", 0, block.start()) + 1
            if block[1] == language:
                found.append(Block(page, line, language, block[2]))
    return found


def commands(page: str) -> list[list[str]]:
    """Arguments of the calls of the program in the indented blocks of a page."""
    text = PAGES[page].read_text(encoding="utf-8").replace("\\\n", " ")
    lines = re.findall(r"^    (\S.*)$", text, re.MULTILINE)
    calls = [line.removeprefix("$ ") for line in lines]
    return [
        shlex.split(_PROGRAM.sub("", call), comments=True) for call in calls if _PROGRAM.match(call)
    ]


def steps(page: str) -> list[Block]:
    """Blocks of a tutorial in their order: programs, files and commands with their output."""
    text = PAGES[page].read_text(encoding="utf-8")
    found = [(b.start(), b[1], b[2]) for b in _FENCED.finditer(text)]
    outside = _FENCED.sub(lambda b: re.sub(r"[^\n]", " ", b[0]), text)
    for line in re.finditer(r"^ {4,6}(\S.*)$", outside, re.MULTILINE):
        found.append((line.start(), "console", f"$ {line[1]}\n"))
    return [
        Block(page, text.count("\n", 0, at) + 1, language, block)
        for at, language, block in sorted(found)
    ]
