"""Study as read from its files, for pictures, console and report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...results.quantity import Quantity, multiple
from ..files import model_of, read_object
from ..variants.folder import quantity_at
from ..variants.units import in_pictures
from .folder import COLUMNS, QUANTILES, SAMPLE, SOBOL, TORNADO, read_cells

_MAIN = (
    *("max_pressure_Pa", "shape_range_m", "max_temperature_K", "peak_temperature_K"),
    *("wear_volume_1_m3", "wear_volume_2_m3", "friction_torque_Nm", "friction_power_W"),
    *("rigid_wear_velocity_m_per_s", "time_s", "approach_m", "contact_area_m2"),
    *("critical_speed_m_per_s", "critical_angular_velocity_rad_per_s", "dissipated_energy_J"),
)
"""Keys of the main outputs, the most important first."""
_MOST = 6


@dataclass(frozen=True)
class StudyRecord:
    """Study as read from its files.

    Attributes
    ----------
    folder : Path
    settings : dict
        Record of the study in ``run.json``.
    sample : dict of str to ndarray
        Numbers of the variants of the sample that succeeded, by output.
    quantiles, indices, swings : list of dict
        Rows of the tables.
    model : str
        Kinematic model.
    """

    folder: Path
    settings: dict[str, Any]
    sample: dict[str, np.ndarray]
    quantiles: list[dict[str, str]]
    indices: list[dict[str, str]]
    swings: list[dict[str, str]]
    model: str

    @property
    def outputs(self) -> list[str]:
        """Numbers that vary."""
        return [row["output"] for row in self.quantiles]

    @property
    def main(self) -> list[str]:
        """Main outputs, at most six; any if none of those varies."""
        order = {key: k for k, key in enumerate(_MAIN)}
        known = [name for name in self.outputs if name.rpartition(".")[2] in order]
        known.sort(key=lambda name: order[name.rpartition(".")[2]])
        return (known or self.outputs)[:_MOST]

    def quantity(self, output: str) -> Quantity:
        """Quantity of an output, labelled for the kinematic model, in a unit of its size."""
        found = quantity_at(output).in_model(self.model)
        if found.unit != found.si or output not in self.sample:
            return found
        size = np.nanmax(np.abs(self.sample[output]), initial=0.0)
        return found.shown_in(multiple(found.si, float(size))[0])

    def quantile(self, output: str, name: str) -> float:
        """Quantile of an output by its name, such as "97.5%"."""
        return float(next(row for row in self.quantiles if row["output"] == output)[name])

    def influence(self, output: str) -> list[tuple[str, float]]:
        """Inputs with their total index, or else their share in the sum of squared swings.

        The most influential one is first.
        """
        total = {r["input"]: float(r["total"]) for r in self.indices if r["output"] == output}
        if not total:
            rows = [row for row in self.swings if row["output"] == output]
            widths = {self.label(r["input"]): abs(_width(r)) for r in rows}
            whole = sum(np.nan_to_num(width) ** 2 for width in widths.values()) or 1.0
            total = {name: width**2 / whole for name, width in widths.items()}
        return sorted(total.items(), key=lambda pair: -np.nan_to_num(pair[1]))

    def label(self, header: str) -> str:
        """Path of a key from the header of its column."""
        names = [n for n in self.settings["columns"] if header == n or header.startswith(f"{n}_")]
        return max(names, key=len, default=header)

    def brief(self, name: str) -> str:
        """Last part of the path of an input, or the last two if others have the same one."""
        *_, last = name.split(".")
        same = [other for other in self.settings["columns"] if other.split(".")[-1] == last]
        return last if len(same) < 2 else ".".join(name.split(".")[-2:])

    def unit(self, name: str) -> str:
        """Unit of an input as it is given, for labels."""
        return in_pictures(self.settings["columns"].get(name, ""))


def short(name: str) -> str:
    """Name of an input in pictures: the last two parts of its path, in two lines."""
    return "\n".join(part.replace("_", " ") for part in name.split(".")[-2:])


def read_study(folder: Path) -> StudyRecord:
    """Read a study.

    Raises
    ------
    ValueError
        If the folder contains none, or it was stopped before there were results.
    """
    settings = (read_object(folder / "run.json") or {}).get("study")
    if not isinstance(settings, dict):
        raise ValueError(f"{folder}: contains no study")
    names = (QUANTILES, "study.csv", TORNADO, SOBOL)
    tables = (read_cells(folder / name, COLUMNS[name]) for name in names)
    quantiles, variants, swings, indices = tables
    pairs = {(row["output"], row["input"]) for row in indices}
    outputs, inputs = ({pair[k] for pair in pairs} for k in (0, 1))
    if len(pairs) != len(outputs) * len(inputs):
        raise ValueError(f"{folder / SOBOL}: needs a row for each output and input")
    try:
        rows = [row for row in variants if row["status"] == "done" and row["part"] in SAMPLE]
        told = [row["output"] for row in quantiles]
        sample = {name: np.array([float(row[name]) for row in rows]) for name in told}
    except (KeyError, ValueError) as error:
        raise ValueError(f"{folder}: study.csv and {QUANTILES} are not of one study") from error
    return StudyRecord(folder, settings, sample, quantiles, indices, swings, model_of(folder))


def _width(row: dict[str, str]) -> float:
    return float(row["output_at_high"]) - float(row["output_at_low"])
