"""Record and tables of a calibration, as they are written."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...calibration.measurement import Measurement
from ...calibration.planning import Planned
from ...calibration.solution import Calibration
from ...case.studies.calibration import CalibrationTable
from ...inference import JointNormal, linear_band


def record_of(found: Calibration) -> dict[str, Any]:
    """Content of ``calibration.json``."""
    fit = found.fit
    quality = {
        "chi2": fit.chi2,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "reduced_chi2": fit.reduced_chi2,
        "p_value": None if found.estimated else fit.p_value,
        "converged": fit.converged,
        "message": fit.message,
        "evaluations": fit.evaluations,
        "runs": found.runs,
        "seconds": round(found.seconds, 3),
    }
    combinations = [
        {"text": one.text, "value": float(one.value(fit.values)), "deviation": one.deviation}
        for one in found.identifiability.combinations
    ]
    posterior = {}
    if found.posterior is not None:
        intervals = found.posterior.intervals(found.table.confidence)
        posterior = {
            "posterior": {
                "steps": found.posterior.steps,
                "acceptance": found.posterior.acceptance,
                "autocorrelation_steps": found.posterior.autocorrelation.tolist(),
                "intervals": dict(zip(found.table.parameters, intervals.tolist(), strict=True)),
            }
        }
    return {
        **_parameters(found.table, found.normal, found.fit.values),
        "at_bounds": list(found.at_bounds),
        "identifiable": found.identifiability.identified,
        "singular_values": found.identifiability.singular_values.tolist(),
        "combinations": combinations,
        "suggestions": [one.text for one in found.suggestions],
        "notes": found.notes(),
        **quality,
        **posterior,
    }


def record_of_plan(found: Planned, values: np.ndarray) -> dict[str, Any]:
    """Content of ``calibration.json`` of planned measurements."""
    names, design = list(found.table.parameters), found.design
    alone, without = (
        {
            label: dict(zip(names, one.standard_errors.tolist(), strict=True))
            for label, one in each.items()
        }
        for each in (design.alone, design.without)
    )
    return {
        "planned": True,
        **_parameters(found.table, design.complete.normal, values),
        "identifiable": found.identifiability.identified,
        "combinations": [
            {"text": one.text, "deviation": one.deviation}
            for one in found.identifiability.combinations
        ],
        "suggestions": [one.text for one in found.suggestions],
        "notes": found.notes(),
        "standard_errors_alone": alone,
        "standard_errors_without": without,
    }


def _parameters(table: CalibrationTable, normal: JointNormal, values: np.ndarray) -> dict[str, Any]:
    intervals = normal.intervals(table.confidence)
    parameters = {}
    for k, (name, own) in enumerate(table.parameters.items()):
        parameters[name] = {
            "key": own.key,
            "unit": own.start.unit,
            "value": float(values[k]),
            "interval": intervals[k].tolist(),
            "standard_error": float(normal.standard_errors[k]),
            "scale": own.scale,
            "lower": float(normal.space.limits[0, k]),
            "upper": float(normal.space.limits[1, k]),
            "internal": float(normal.mean[k]),
            "internal_scale": float(normal.space.scale[k]),
        }
    return {
        "confidence": table.confidence,
        "parameters": parameters,
        "set": dict(table.set),
        "covariance": normal.covariance.tolist(),
        "correlation": normal.correlation.tolist(),
    }


def rows_of(
    measurements: tuple[Measurement, ...],
    predicted: np.ndarray,
    deviations: np.ndarray,
    jacobian: np.ndarray,
    normal: JointNormal,
    level: float,
    noise: float,
) -> list[dict[str, Any]]:
    """Rows of ``observations.csv``: measured and predicted values with their bands [SI].

    Parameters
    ----------
    jacobian : ndarray, shape (n, p)
        Derivatives of the predictions with respect to the internal coordinates.
    noise : float
        Relative noise of the derivatives.
    """
    band = linear_band(predicted, jacobian, normal, level, noise)
    along = dict.fromkeys(_header(name) for one in measurements for name in one.reading.at)
    rows, k = [], 0
    for one in measurements:
        at = {_header(name): values for name, values in one.reading.at.items()}
        for i, value in enumerate(one.values):
            rows.append(
                {
                    "observation": one.label,
                    "quantity": one.reading.quantity.header,
                    **{name: float(at[name][i]) if name in at else np.nan for name in along},
                    "observed": float(value),
                    "deviation": float(deviations[k]),
                    "predicted": float(predicted[k]),
                    "lower": float(band.lower[k]),
                    "upper": float(band.upper[k]),
                    "weighted_residual": float((value - predicted[k]) / deviations[k]),
                }
            )
            k += 1
    return rows


def _header(name: str) -> str:
    return {"time": "time_s", "cycle": "cycle"}.get(name, f"{name}_m")
