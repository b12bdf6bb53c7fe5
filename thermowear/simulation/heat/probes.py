"""Temperatures at the probes of a model."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ...bulk.points import point_rows
from ...parallel import sum_over_ranks
from ...results import ProbeRow
from ..points.probe_points import probe_points
from ..system.system import System


def probe_temperatures(system: System, rise: np.ndarray) -> np.ndarray:
    """Temperatures at the probes, shape (n_probes,); every rank calls [K].

    That of a point which has been worn off is NaN.

    Parameters
    ----------
    system : System
    rise : ndarray, shape (n_owned,)
        Nodal temperature rise over the ambient [K].
    """
    model, thermal = system.model, system.thermal
    if not model.probes or thermal is None:
        return np.zeros(0)
    made_from = system.inputs.mesh, model.discretisation.degree, model.probes
    rows, lost = system.parts.get("probes", made_from, lambda: _rows(system))
    found = sum_over_ranks(system.comm, rows @ rise)
    return np.where(lost, np.nan, found + thermal.ambient)


def _rows(system: System) -> tuple[sp.csr_matrix, np.ndarray]:
    """Values at the probes per nodal value (n_probes, n_owned), and mask of those worn off."""
    assert system.thermal is not None
    at, lost = probe_points(system.model, system.bodies, worn=system.worn is not None)
    return point_rows(system.thermal.conduction.spaces, at), lost


def probe_rows(system: System, rise: np.ndarray, time: float) -> list[ProbeRow]:
    """Rows of the probes at a time [s], see `probe_temperatures`; every rank calls."""
    found = enumerate(probe_temperatures(system, rise), start=1)
    return [ProbeRow(time=time, probe=number, temperature=float(T)) for number, T in found]
