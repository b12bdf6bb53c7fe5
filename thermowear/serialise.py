"""Serialisation of states of an analysis to plain arrays, for an exact restart.

Numbers are kept to the last bit and arrays in their memory order, as sums depend on it: results
computed from an unpacked state are bitwise those computed from the original state.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, TypeVar

import numpy as np

from .errors import CaseError, quoted

Kind = TypeVar("Kind")

_STATES: dict[str, type] = {}
_ROWS: dict[str, type] = {}


def serialisable(kind: type[Kind]) -> type[Kind]:
    """Decorator that registers a dataclass as a component of serialised states."""
    _STATES[kind.__name__] = kind
    return kind


def serialisable_row(kind: type[Kind]) -> type[Kind]:
    """Decorator that registers a dataclass of numbers, lists of which are stored by columns."""
    _ROWS[kind.__name__] = kind
    return kind


@dataclass(frozen=True)
class Checkpoint:
    """Serialised state of an analysis on all ranks.

    Attributes
    ----------
    outlines : list of str
        Structure of each rank's state in terms of its arrays, as JSON.
    arrays : dict of str to ndarray
        Arrays by the names used in the outlines.
    """

    outlines: list[str]
    arrays: dict[str, np.ndarray]

    def state(self, rank: int) -> Any:
        """Unpack the state of a rank.

        Raises
        ------
        CaseError
            If the checkpoint was written by an incompatible version of the program.
        """
        try:
            return _unpacked(json.loads(self.outlines[rank]), self.arrays)
        except (LookupError, TypeError, ValueError, AttributeError, StopIteration) as error:
            raise CaseError(
                f"--resume: the checkpoint was written by another version of thermowear "
                f"({quoted(error)}); --overwrite starts from the beginning"
            ) from None


def pack(comm, state: Any) -> Checkpoint | None:
    """Pack a state made of registered dataclasses, tuples, lists, dicts, arrays and numbers.

    Arrays that are identical on all ranks are stored once.

    Returns
    -------
    Checkpoint or None
        On rank 0; None on the others.
    """
    packing = _Packing()
    parts = comm.gather((json.dumps(packing.outline(state)), packing.arrays))
    if parts is None:
        return None
    first, arrays = parts[0][1], dict(parts[0][1])
    outlines = []
    for rank, (outline, own) in enumerate(parts):
        different = [name for name in own if rank and not _same(own[name], first.get(name))]
        arrays |= {f"{name}@{rank}": own[name] for name in different}
        for name in different:
            outline = outline.replace(f'{{"array": "{name}"}}', f'{{"array": "{name}@{rank}"}}')
        outlines.append(outline)
    return Checkpoint(outlines, arrays)


def _same(one: np.ndarray, other: np.ndarray | None) -> bool:
    """Test two arrays for bitwise equality, including NaN and memory order."""
    return (
        other is not None
        and (one.dtype, one.shape, one.strides) == (other.dtype, other.shape, other.strides)
        and one.tobytes() == other.tobytes()
    )


class _Packing:
    """Extraction of the arrays of a state; its outline refers to them by name."""

    def __init__(self) -> None:
        self.arrays: dict[str, np.ndarray] = {}

    def outline(self, value: Any) -> Any:
        name = type(value).__name__
        if isinstance(value, np.ndarray | np.generic):
            return self._array(np.asarray(value))
        if value is None or isinstance(value, bool | int | float | str):
            return value
        if is_dataclass(value) and name in _STATES:
            return {
                "state": name,
                "of": {f.name: self.outline(getattr(value, f.name)) for f in fields(value)},
            }
        if isinstance(value, list) and value and type(value[0]).__name__ in _ROWS:
            return {"rows": type(value[0]).__name__, "of": self._columns(value)}
        if isinstance(value, dict):
            return {"dict": [[self.outline(k), self.outline(v)] for k, v in value.items()]}
        if isinstance(value, list | tuple):
            return {type(value).__name__: [self.outline(item) for item in value]}
        raise TypeError(f"a checkpoint cannot hold a {name}")

    def _columns(self, rows: list) -> dict[str, Any]:
        names = [f.name for f in fields(rows[0])]
        return {name: self._array(np.array([getattr(r, name) for r in rows])) for name in names}

    def _array(self, values: np.ndarray) -> dict[str, str]:
        name = f"a{len(self.arrays)}"
        self.arrays[name] = values
        return {"array": name}


def _unpacked(outline: Any, arrays: dict[str, np.ndarray]) -> Any:
    """Rebuild a state from its outline and arrays; inverse of `_Packing.outline`."""
    if not isinstance(outline, dict):
        return outline
    kind, content = next(iter(outline.items()))
    if kind == "array":
        values = arrays[content]
        return values if values.ndim else values[()]
    if kind == "rows":
        columns = {name: arrays[of["array"]].tolist() for name, of in outline["of"].items()}
        row, names = _ROWS[content], list(columns)
        each = zip(*columns.values(), strict=True)
        return [row(**dict(zip(names, values, strict=True))) for values in each]
    if kind == "state":
        of = {name: _unpacked(part, arrays) for name, part in outline["of"].items()}
        return _STATES[content](**of)
    if kind == "dict":
        return {_unpacked(key, arrays): _unpacked(value, arrays) for key, value in content}
    items = [_unpacked(item, arrays) for item in content]
    return items if kind == "list" else tuple(items)
