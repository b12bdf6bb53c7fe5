"""Short names: the only contact and holder of a case without names for them have none in results.

Results are computed by the names of contacts and holders. Where there is one of each without a
name, its entries are those of the whole.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def by_name(kind: str, entries: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Summary entries of parts of a model in a table by their names; without a name, as they are.

    Parameters
    ----------
    kind : str
        Name of the table, such as ``"contacts"``.
    entries : mapping of str to mapping
        Entries of each part by its name.
    """
    if not any(entries):
        return dict(entries.get("", {}))
    return {kind: {name: dict(entry) for name, entry in entries.items()}}
