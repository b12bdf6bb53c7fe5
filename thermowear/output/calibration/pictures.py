"""Pictures of a calibration: fit, residuals, and parameters in pairs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter
from scipy import stats

from ...results.quantity import TABLES, Quantity, from_key, multiple
from ...results.summary_keys import of_key
from ..pictures.panels import MAP_STYLE, panels
from .folder import read_calibration, read_posterior

_ALONG = ("sliding_distance_m", "time_s", "cycle", "s_m", "x_m", "y_m", "z_m")
"""Columns that observations are drawn over, the first that varies."""
_REGIONS = (0.95, 0.68)
_WIDEST = 6.0
"""Largest standard deviation of a logarithm that is drawn."""


def draw_calibration(folder: Path) -> list[str]:
    """Draw ``fit.png``, ``residuals.png`` and ``parameters.png``.

    Returns
    -------
    list of str
        Reasons for missing pictures, one line each.

    Raises
    ------
    ValueError
        If the folder contains no calibration.
    """
    record, rows = read_calibration(folder)
    if record.get("planned"):
        return []
    groups: dict[str, list[dict[str, str]]] = {}
    for row in rows:
        groups.setdefault(row["observation"], []).append(row)
    observed = [_Group(label, members) for label, members in groups.items()]
    _draw_fit(observed, record["confidence"], folder / "fit.png")
    _draw_residuals(observed, folder / "residuals.png")
    known = [k for k, one in enumerate(record["parameters"].values()) if _is_known(one)]
    if not known:
        return ["no picture of the parameters: the data determine none of them"]
    sample = read_posterior(folder, len(record["parameters"]))
    _draw_parameters(record, known, sample, folder / "parameters.png")
    return []


class _Group:
    """Values of one observation in units of plots."""

    def __init__(self, label: str, rows: list[dict[str, str]]):
        self.label, self._rows = label, rows
        self.quantity = _quantity(rows[0]["quantity"], self._column("observed"))
        along = [name for name in _ALONG if name in rows[0] and np.ptp(self._column(name)) > 0]
        self.along = _quantity(along[0], self._column(along[0])) if along else None

    def _column(self, name: str) -> np.ndarray:
        return np.array([float(row[name]) for row in self._rows])

    def drawn(self, name: str) -> np.ndarray:
        """Column in the unit of plots."""
        return np.asarray(self.quantity.drawn(self._column(name)))

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations in the unit of plots."""
        low = self._column("observed") - self._column("deviation")
        return self.drawn("observed") - np.asarray(self.quantity.drawn(low))

    @property
    def abscissa(self) -> np.ndarray:
        """Horizontal positions: times, distances or places, or else the numbers of the values."""
        if self.along is None:
            return np.arange(1.0, len(self._rows) + 1)
        return np.asarray(self.along.drawn(self._column(self.along.header)))

    @property
    def residuals(self) -> np.ndarray:
        """Weighted residuals."""
        return self._column("weighted_residual")


def _quantity(header: str, values: np.ndarray) -> Quantity:
    """Quantity by its header, in a unit that suits its values."""
    known = {q.header: q for table in TABLES.values() for q in table.columns.values()}
    found = known.get(header) or of_key(header)
    if found.si == "K":
        return found.shown_in("°C")
    if found.unit == "1":
        return found
    unit = multiple(found.si, float(np.nanmax(np.abs(values))))[0]
    return from_key(header, found.label, unit)


def _draw_fit(groups: list[_Group], level: float, path: Path) -> None:
    with panels(path, len(groups), 2, (4.6, 3.2)) as (_, axes):
        for axis, group in zip(axes.flat, groups, strict=False):
            x, order = group.abscissa, np.argsort(group.abscissa, kind="stable")
            low, high = group.drawn("lower"), group.drawn("upper")
            if group.along is None:
                reach = np.abs(np.stack([low, high]) - group.drawn("predicted"))
                axis.errorbar(x + 0.15, group.drawn("predicted"), reach, fmt="s", color="C1")
                axis.set_xticks(x)
                axis.set_xlim(0.5, len(x) + 0.7)
                axis.set_xlabel("number of the measurement")
            else:
                axis.fill_between(x[order], low[order], high[order], color="C1", alpha=0.25, lw=0)
                axis.plot(x[order], group.drawn("predicted")[order], color="C1")
                axis.set_xlabel(group.along.axis)
            style: dict[str, Any] = {"fmt": "o", "color": "C0", "markersize": 4}
            axis.errorbar(x, group.drawn("observed"), group.deviations, **style, zorder=3)
            axis.set_ylabel(group.quantity.wrapped)
            axis.set_title(group.label, fontsize="medium")
        handles = [
            axes.flat[0].plot([], [], "o", color="C0", markersize=4)[0],
            axes.flat[0].plot([], [], color="C1")[0],
        ]
        words = ["measured, ± standard deviation", f"predicted, with {100 * level:g} % band"]
        axes.flat[0].figure.legend(handles, words, loc="outside lower center", ncols=2)


def _draw_residuals(groups: list[_Group], path: Path) -> None:
    with panels(path, 2, 2, (4.6, 3.6)) as (figure, axes):
        against, weighted = axes[0]
        start = 1
        for number, group in enumerate(groups):
            size = np.nanmax(np.abs(group.drawn("observed"))) or 1.0
            style: dict[str, Any] = {"color": f"C{number % 10}", "marker": "o", "linestyle": ""}
            against.plot(
                group.drawn("observed") / size,
                group.drawn("predicted") / size,
                markersize=4,
                label=group.label,
                **style,
            )
            x = np.arange(start, start + len(group.residuals))
            weighted.plot(x, group.residuals, markersize=4, **style)
            start += len(x)
        ends = against.get_xlim()
        against.plot(ends, ends, color="0.5", linewidth=0.8, zorder=0)
        against.set_xlabel("measured, relative to the largest")
        against.set_ylabel("predicted, relative to the largest")
        weighted.axhspan(-1, 1, color="0.9", zorder=0)
        for level in (-2, 2):
            weighted.axhline(level, color="0.5", linewidth=0.8, linestyle="--", zorder=0)
        weighted.xaxis.set_major_locator(MaxNLocator(integer=True))
        weighted.set_xlabel("number of the measurement")
        weighted.set_ylabel("(measured - predicted) /\nstandard deviation")
        if len(groups) > 1:
            figure.legend(loc="outside lower center", ncols=min(len(groups), 4))


def _is_known(parameter: dict[str, Any]) -> bool:
    return parameter["standard_error"] is not None


def _draw_parameters(
    record: dict[str, Any], known: list[int], sample: np.ndarray | None, path: Path
) -> None:
    """Draw densities on the diagonal, and regions of pairs below it."""
    names = list(record["parameters"])
    shown = [_Parameter(names[k], record["parameters"][names[k]]) for k in known]
    covariance = np.array(record["covariance"], dtype=float)[np.ix_(known, known)]
    count = len(known)
    options: dict[str, Any] = {"style": MAP_STYLE, "sharex": "col"}
    size = (3.4, 2.8) if count == 1 else (2.4, 2.2)
    with panels(path, count * count, count, size, **options) as (_, axes):
        for i, row in enumerate(shown):
            for j, column in enumerate(shown):
                axis = axes[i, j]
                if j > i:
                    axis.set_visible(False)
                    continue
                values = None if sample is None else sample[:, [known[j], known[i]]]
                if i == j:
                    _draw_density(axis, row, covariance[i, i], values)
                else:
                    _draw_pair(axis, column, row, covariance[np.ix_([j, i], [j, i])], values)
                    if j == 0:
                        axis.set_ylabel(row.label)
                    else:
                        axis.tick_params(labelleft=False)
                if i == count - 1:
                    axis.set_xlabel(column.label)


class _Parameter:
    """Parameter of a picture: its axis is that of its value."""

    def __init__(self, name: str, content: dict[str, Any]):
        self.label = f"{name} [{content['unit']}]" if content["unit"] else name
        self.log, self.scale = content["scale"] == "log", content["internal_scale"]
        self.internal = content["internal"]

    def value(self, internal: np.ndarray) -> np.ndarray:
        """Values at internal coordinates."""
        return np.exp(internal) if self.log else internal * self.scale

    def limits(self, deviation: float) -> np.ndarray:
        """Ends of an axis."""
        reach = 3.2 * min(deviation, _WIDEST)
        return self.value(np.array([self.internal - reach, self.internal + reach]))


def _draw_density(axis, parameter: _Parameter, variance: float, sample: np.ndarray | None) -> None:
    deviation = float(np.sqrt(variance))
    t = np.linspace(-3.2, 3.2, 200)
    x = parameter.value(parameter.internal + deviation * t)
    axis.plot(x, stats.norm.pdf(t), color="C1")
    axis.axvline(parameter.value(np.array(parameter.internal)), color="C1", linewidth=0.8)
    if sample is not None:
        internal = np.log(sample[:, 1]) if parameter.log else sample[:, 1] / parameter.scale
        heights, edges = np.histogram((internal - parameter.internal) / deviation, 40, density=True)
        ends = parameter.value(parameter.internal + deviation * edges)
        axis.stairs(heights, ends, color="C0", alpha=0.7)
    _scale(axis, "x", parameter, deviation)
    axis.set_yticks([])
    axis.set_ylim(bottom=0.0)


def _draw_pair(axis, across, up, covariance: np.ndarray, sample: np.ndarray | None) -> None:
    """Draw regions of two parameters, which are ellipses in internal coordinates."""
    variances, directions = np.linalg.eigh(covariance)
    angle = np.linspace(0.0, 2 * np.pi, 200)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    if sample is not None:
        axis.plot(*sample[:: max(1, len(sample) // 2000)].T, ".", color="C0", ms=1.5, alpha=0.4)
    for level, alpha in zip(_REGIONS, (0.25, 0.45), strict=True):
        radii = np.sqrt(np.maximum(variances, 0.0) * stats.chi2.ppf(level, 2))
        x, y = directions @ (radii[:, None] * circle)
        axis.fill(
            across.value(across.internal + x), up.value(up.internal + y), color="C1", alpha=alpha
        )
    point = across.value(np.array(across.internal)), up.value(np.array(up.internal))
    axis.plot(*point, "+", color="k")
    for name, one, variance in (("x", across, covariance[0, 0]), ("y", up, covariance[1, 1])):
        _scale(axis, name, one, float(np.sqrt(variance)))


def _scale(axis, name: str, parameter: _Parameter, deviation: float) -> None:
    """Limits and ticks of one axis; logarithmic where the values cover more than a decade."""
    low, high = parameter.limits(deviation)
    which = axis.xaxis if name == "x" else axis.yaxis
    if parameter.log and high > 10 * low:
        getattr(axis, f"set_{name}scale")("log")
        which.set_major_locator(LogLocator(numticks=4))
        which.set_minor_formatter(NullFormatter())
    else:
        which.set_major_locator(MaxNLocator(3))
    getattr(axis, f"set_{name}lim")(low, high)
