"""Pictures of the verification book: error of each number, and what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

_SMALLEST = 1e-16
"""Error that is drawn where there is none; rounding."""


def draw_errors(rows: list[dict[str, Any]], path: Path) -> None:
    """Draw the errors of a case in the order of its table.

    Parameters
    ----------
    rows : list of dict
        Checks, with `error` and `allowed`.
    path : Path
        File to write (SVG).
    """
    errors, allowed = (np.array([row[key] for row in rows]) for key in ("error", "allowed"))
    number = np.arange(1, len(rows) + 1)
    figure = Figure(figsize=(7.0, 2.0), layout="constrained")
    axes = figure.add_subplot()
    axes.fill_between(
        np.append(number - 0.5, number[-1] + 0.5),
        np.maximum(np.append(allowed, allowed[-1]), _SMALLEST),
        _SMALLEST / 3,
        step="post",
        color="0.9",
        label="allowed",
        linewidth=0,
    )
    axes.plot(number, np.maximum(np.abs(errors), _SMALLEST), ".", color="C0", label="error")
    axes.set(
        yscale="log",
        ylim=(_SMALLEST / 3, 1.0),
        xlim=(0.5, len(rows) + 0.5),
        xlabel="row of the table",
        ylabel="relative",
    )
    axes.set_yticks([1e-16, 1e-12, 1e-8, 1e-4, 1.0])
    axes.xaxis.get_major_locator().set_params(integer=True)
    figure.legend(loc="outside right upper", frameon=False)
    figure.savefig(path, metadata={"Date": None})
