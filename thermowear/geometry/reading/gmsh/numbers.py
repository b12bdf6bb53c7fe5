"""Numbers of a section of a gmsh mesh file, written as text or binary."""

from __future__ import annotations

import numpy as np

from ..contents import parsed


class Numbers:
    """Numbers of a section, read sequentially."""

    name: str
    count: int | None = None
    """Count that a binary section of format 2 gives as text at its beginning."""

    def integers(self, count: int, kind: str = "int") -> np.ndarray:
        """Next integers, ``"int"`` or ``"size"``, shape (count,)."""
        raise NotImplementedError

    def reals(self, count: int) -> np.ndarray:
        """Next real numbers, shape (count,)."""
        raise NotImplementedError

    def one(self, kind: str = "int") -> int:
        return int(self.integers(1, kind)[0])

    def finished(self) -> None:
        """Raise an error if data are left over, such as commands."""
        if self._left_over():
            raise ValueError(f"the section ${self.name} holds more data than announced")

    def _left_over(self) -> bool:
        raise NotImplementedError

    def ends_early(self) -> ValueError:
        return ValueError(f"the section ${self.name} holds fewer numbers than announced")


class Text(Numbers):
    """Numbers as text, separated by blanks."""

    def __init__(self, name: str, body: bytes):
        self.name, self.at = name, 0
        self.values = parsed(body.decode("latin-1"), f"the section ${name}")

    def integers(self, count: int, kind: str = "int") -> np.ndarray:
        values = self.reals(count)
        if not np.all(np.abs(values) < 2**53) or np.any(values != np.rint(values)):
            raise ValueError(
                f"the section ${self.name} has real numbers where integers are expected"
            )
        return values.astype(np.int64)

    def reals(self, count: int) -> np.ndarray:
        if not 0 <= count <= len(self.values) - self.at:
            raise self.ends_early()
        self.at += count
        return self.values[self.at - count : self.at]

    def _left_over(self) -> bool:
        return self.at < len(self.values)


class Binary(Numbers):
    """Binary numbers of a byte order (``"<"`` or ``">"``), with a ``size_t`` of `size` bytes."""

    def __init__(self, name: str, body: bytes, order: str, size: int, count: int | None):
        self.name, self.body, self.at, self.count = name, body, 0, count
        self.kinds = {"int": f"{order}i4", "size": f"{order}u{size}", "real": f"{order}f8"}

    def integers(self, count: int, kind: str = "int") -> np.ndarray:
        return self._take(count, kind).astype(np.int64)

    def reals(self, count: int) -> np.ndarray:
        return self._take(count, "real").astype(np.float64)

    def records(self, count: int, kinds: list[tuple[str, str, int]]) -> np.ndarray:
        """Next records: name, type and count of each field."""
        row = np.dtype([(name, self.kinds[kind], (n,)) for name, kind, n in kinds])
        return self._frombuffer(count, row)

    def _take(self, count: int, kind: str) -> np.ndarray:
        return self._frombuffer(count, np.dtype(self.kinds[kind]))

    def _frombuffer(self, count: int, kind: np.dtype) -> np.ndarray:
        size = count * kind.itemsize
        if not 0 <= size <= len(self.body) - self.at:
            raise self.ends_early()
        self.at += size
        return np.frombuffer(self.body, kind, count, self.at - size)

    def _left_over(self) -> bool:
        return bool(self.body[self.at :].strip())
