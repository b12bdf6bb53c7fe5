"""Reference of the keys of case files, a page for each table at the top of a case."""

from __future__ import annotations

import re

from thermowear.app.schema import Key, TableOfKeys, all_tables

_INTRODUCTION = """# Keys of case files

A case file is in TOML. `NAME` stands for a name that the case or its mesh defines: of a body, a
surface, a contact. Quantities are text with a unit of the dimension in brackets, such as `"50 MPa"`
for `[Pa]`; limits are in SI. A list of quantities may also be written as
`{ values = [0, 1, 2], unit = "s" }`. `python3 -m thermowear schema` writes all of this as a
[JSON schema for editors](../../guides/editors.md).

"""
_TITLES = {
    "geometry": "Shapes of the bodies, their mesh files and CAD files",
    "mesh": "Discretisation",
    "bodies": "Materials and supports",
    "holder": "Holder of body 1",
    "holders": "Holders of several bodies",
    "load": "Loads",
    "motion": "Sliding motion",
    "motions": "Motions of several bodies",
    "contact": "Friction and contact method",
    "contacts": "Contacts of several bodies",
    "wear": "Wear laws",
    "heat": "Heat",
    "probes": "Probes of the temperature",
    "analysis": "Analyses",
    "calibrate": "Calibration",
    "study": "Uncertain inputs",
}
_WIDEST_CHOICE = 8
"""Largest number of words or tables of a choice that a row lists."""


def key_pages() -> dict[str, str]:
    """Pages of the reference by name."""
    tables = all_tables()
    pages = {"index": _index(tables)}
    for group, title in _TITLES.items():
        inside = [table for table in tables.values() if _group(table) == group]
        text = "\n".join(_section(table, tables) for table in inside)
        pages[group] = f"# `[{group}]`: {title}\n\n{text}"
    return pages


def _group(table: TableOfKeys) -> str:
    """Table at the top of a case that a table belongs to; empty for the case itself."""
    return re.split(r"[.\[]", table.paths[0])[0]


def _index(tables: dict[str, TableOfKeys]) -> str:
    lines = [_INTRODUCTION, "```{toctree}", ":maxdepth: 1", "", *_TITLES, "```", ""]
    for table in tables.values():
        if not _group(table):
            lines.append(_section(table, tables))
    return "\n".join(lines)


def title_of(table: TableOfKeys) -> str:
    """Heading of a table: its type, or its place in the file."""
    kind = next((key.kinds[0] for key in table.keys if key.name == "type"), "")
    places = ", ".join(f"`[{path}]`" for path in table.paths if path)
    if kind.startswith('"'):
        places += f", `type = {kind}`"
    return places or table.meaning.rstrip(".")


def _section(table: TableOfKeys, tables: dict[str, TableOfKeys]) -> str:
    meaning = "" if not table.paths[0] else f"{_text(table.meaning)}\n"
    rows = "\n".join(_row(key, tables) for key in table.keys)
    return (
        f"({_anchor(table.name)})=\n## {title_of(table)}\n\n{meaning}\n"
        f":::{{table}}\n:class: keys\n:align: left\n\n"
        f"| key | value | default, limits | meaning |\n|---|---|---|---|\n{rows}\n:::\n"
    )


def _row(key: Key, tables: dict[str, TableOfKeys]) -> str:
    kinds = [_kind(kind, tables) for kind in key.kinds]
    if len(kinds) > _WIDEST_CHOICE:
        kinds = [*kinds[:_WIDEST_CHOICE], "…"]
    default = key.default if key.default in ("", "required") else f"`{key.default}`"
    given = "; ".join(text for text in (default, key.limits) if text)
    cells = f"`{key.name}`", " or ".join(kinds), given, _text(key.meaning)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _kind(kind: str, tables: dict[str, TableOfKeys]) -> str:
    """Kind of a value, with links to tables."""
    if kind.startswith('"'):
        return f"`{kind}`"

    def link(found: re.Match[str]) -> str:
        name = found[1]
        own = next((k.kinds[0].strip('"') for k in tables[name].keys if k.name == "type"), "table")
        return f"[{own}](#{_anchor(name)})"

    return re.sub(r"<(\w+)>", link, kind)


def _anchor(name: str) -> str:
    return "keys-" + re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "-", name).lower()


def _text(sentence: str) -> str:
    """Sentence of a docstring as Markdown: code has one backtick."""
    return sentence.replace("``", "`")
