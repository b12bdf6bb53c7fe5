"""Blocks of the documents: fragments of cases, programs, commands with what they print."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

TOP = Path(__file__).parents[2]
PAGES = {
    path.relative_to(TOP).as_posix(): path
    for path in (
        TOP / "README.md",
        TOP / "CONTRIBUTING.md",
        *sorted((TOP / "docs").rglob("*.md")),
        TOP / "demos/README.md",
    )
    if "_build" not in path.parts and "keys" not in path.parts and path.parent.name != "python"
}
_FENCED = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_INDENTED = re.compile(r"(?:^ {4,}\S.*\n)+", re.MULTILINE)
_COMMANDS = "thermowear |python3 |mpirun |mkdir |scripts/|make |pip |docker |sudo "
_START = re.compile(rf"^(?:\$ |{_COMMANDS})")
_PROGRAM = re.compile(r"^(?:scripts/env )?(?:python3 -m )?thermowear ")


@dataclass(frozen=True)
class Block:
    """Block of a page.

    Attributes
    ----------
    page : str
    line : int
    language : str
        Of a fenced block; `console` for an indented one.
    text : str
    """

    page: str
    line: int
    language: str
    text: str

    @property
    def id(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def file(self) -> str | None:
        """Name of the file that the block is, in its first line."""
        found = re.match(r"# (\S+\.(?:py|toml))\n", self.text)
        return found and found[1]

    def calls(self) -> list[Call]:
        """Commands of a console, in their order; other lines are what the last one prints."""
        if self.language != "console":
            return []
        found: list[Call] = []
        for line in self.text.replace("\\\n", " ").splitlines():
            if _START.match(line):
                found.append(Call(line.removeprefix("$ "), []))
            elif found:
                found[-1].output.append(line)
        return found


@dataclass(frozen=True)
class Call:
    """Command with the lines that it prints, as far as the page shows them."""

    command: str
    output: list[str]

    def arguments(self) -> list[str] | None:
        """Arguments of a call of the program; None for other commands."""
        if not _PROGRAM.match(self.command):
            return None
        words = shlex.split(_PROGRAM.sub("", self.command), comments=True)
        return words[: words.index(">")] if ">" in words else words


def blocks(page: str) -> list[Block]:
    """Blocks of a page in their order."""
    text = PAGES[page].read_text(encoding="utf-8")
    found = [(b.start(), b[1], b[2]) for b in _FENCED.finditer(text)]
    outside = _FENCED.sub(lambda b: re.sub(r"[^\n]", " ", b[0]), text)
    for block in _INDENTED.finditer(outside):
        lines = re.sub(r"^ {4,6}(?=\S)", "", block[0], flags=re.MULTILINE)
        found.append((block.start(), "console", lines))
    return [
        Block(page, text.count("\n", 0, at) + 1, language, block)
        for at, language, block in sorted(found)
    ]


def fenced(language: str) -> list[Block]:
    """Blocks of a language, of all pages."""
    return [block for page in PAGES for block in blocks(page) if block.language == language]


def calls(page: str) -> list[Call]:
    """Commands of a page in their order."""
    return [call for block in blocks(page) for call in block.calls()]
