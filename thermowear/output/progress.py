"""Console output of a run while it proceeds, in units that suit the size of numbers."""

from __future__ import annotations

import os
import sys
import time

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..results.summary_keys import PHASES, of_key

_UNITS = {
    "Pa": ((1e10, "GPa", 1e-9), (1e4, "MPa", 1e-6), (10.0, "kPa", 1e-3), (0.0, "Pa", 1.0)),
    "m": ((1e-3, "mm", 1e3), (1e-8, "µm", 1e6), (0.0, "nm", 1e9)),
}
"""Units by SI unit: smallest size [SI], unit, and scale from the SI unit."""


def readable_unit(key: str, size: float) -> tuple[str, float]:
    """Readable unit for a number of a size [SI], and its scale from the SI unit."""
    quantity = of_key(key)
    for least, unit, scale in _UNITS.get(quantity.si, ()):
        if abs(size) >= least and size:
            return unit, scale
    return quantity.unit, quantity.drawn(1.0)


def readable(key: str, value: float, unit: str = "") -> tuple[float, str]:
    """Number in a given unit, or else in a readable one, with that unit."""
    quantity = of_key(key).shown_in(unit) if unit else of_key(key)
    if unit or quantity.si not in _UNITS:
        return quantity.drawn(value), quantity.unit
    suited, scale = readable_unit(key, value)
    return scale * value + 0.0, suited


_PLAIN_INTERVAL = 5.0  # seconds between lines where the output is not a terminal


class PlainTable(Table):
    """Table without lines, whose cells are text as it is: names may look like markup."""

    def __init__(self, *headers: str, **options):
        super().__init__(*headers, box=None, padding=(0, 2, 0, 0), **options)

    def add_row(self, *cells: str) -> None:  # type: ignore[override]
        """Add a row of text."""
        super().add_row(*map(Text, cells))

    def add_column(self, header: str = "", **options) -> None:  # type: ignore[override]
        """Add a column with a text as its header."""
        super().add_column(Text(header), **options)


class Terminal(Console):
    """Standard output of text as it is; a closed pipe (``| head``) does not end a run."""

    def __init__(self, **options):
        super().__init__(markup=False, emoji=False, highlight=False, **options)

    def on_broken_pipe(self) -> None:
        self.quiet = True
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class ConsoleProgress:
    """Progress as one live line on a terminal, as plain lines otherwise.

    Parameters
    ----------
    console : rich.console.Console
    """

    def __init__(self, console: Console):
        self._console = console
        self._status = console.status("") if console.is_terminal else None
        self._last = 0.0
        self._unsaid = ""

    def __enter__(self) -> ConsoleProgress:
        if self._status is not None:
            self._status.start()
        return self

    def __exit__(self, *_) -> None:
        if self._status is not None:
            self._status.stop()
        if self._unsaid:
            self._console.print(Text(self._unsaid), soft_wrap=True)

    def phase(self, name: str) -> None:
        """Show the phase that begins."""
        if self._status is not None:
            self._status.update(Text(PHASES.get(name, name)))

    def step(self, number: int, row, distance: float) -> None:
        """Show an accepted step of a transient run."""
        unit, scale = readable_unit("max_pressure_Pa", row.max_pressure)
        self._say(
            f"t = {row.time:.4g} s   step {number}   peak "
            f"{scale * row.max_pressure:.4g} {unit}   distance from steady {distance:.2e}"
        )

    def load_step(self, number: int, row) -> None:
        """Show an accepted increment of a fretting analysis."""
        sticking = row.stick_area / row.contact_area if row.contact_area else 0.0
        self._say(
            f"t = {row.time:.4g} s   increment {number}   tangential force "
            f"{row.tangential_force:.4g} N   stick area {sticking:.0%} of the contact"
        )

    def note(self, text: str) -> None:
        """Print a note for the user."""
        self._console.print(Text(f"note: {text}"), soft_wrap=True)

    def _say(self, text: str) -> None:
        """Show the latest state on the live line, or print a line every few seconds."""
        self._unsaid = text
        if self._status is not None:
            self._status.update(Text(text))
        elif time.monotonic() - self._last > _PLAIN_INTERVAL:
            self._last = time.monotonic()
            self._console.print(Text(text), soft_wrap=True)
            self._unsaid = ""
