"""Thermal skins of bodies that pass a wave, against the elements that ought to resolve them.

A wave of the frequency ω in the frame of a body reaches as deep as ``1/|λ|``, ``λ² = m² + i ω/κ``,
and its face takes up the heat ``k λ`` per temperature. Elements that are larger than the skin take
up another heat, whatever their degree: how much this changes the gain of a mode tells its error.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ...bulk.spaces import gathered_rows
from ...laws.wave_modes import WaveMode
from ...laws.waves import Gains
from ..system.thermal_system import conducting_parts
from .wave_model import WaveModel, WaveSystem

_THIN = 0.01
"""Largest thickness of a thin skin, relative to the contact."""


def skin_error(
    model: WaveModel, waves: WaveSystem, mode: WaveMode
) -> tuple[float, dict[str, float]]:
    """Relative error of the gain of a mode by thin skins, and these skins. Every rank calls.

    Parameters
    ----------
    model : WaveModel
    waves : WaveSystem
        Discrete equations of the mode.
    mode : WaveMode

    Returns
    -------
    error : float
        Infinite where nothing is left of the mode.
    skins : dict of str to float
        Thickness by the name of the body [m].
    """
    system, conduction, heat = model.system, waves.conduction, waves.equations.heat
    assert system.thermal is not None
    face, contacts, skins = system.thermal.face, system.contacts, dict[str, float]()
    traces = [_padded(gathered_rows(t, system.comm), conduction.kept) for t in face.traces]
    direct, matrix = face.divided(model.conditions.conductance)[0], heat.conducted
    in_contact = sorted({k for pair in contacts.bodies for k in pair})
    extent = min(pairing.extent for pairing in contacts.each)
    for body in in_contact:
        frequency = mode.rate.imag + mode.factor * waves.wave.number * model.speeds[body]
        own = [conducting_parts(system.model)[part] for part in system.model.bodies[body].parts]
        best = max(own, key=lambda material: material.conductivity)
        assert best.capacity is not None
        slope = model.wave_number(waves.wave.number) ** 2
        depth = np.sqrt(slope + 1j * frequency * best.capacity / best.conductivity)
        if abs(depth) * extent * _THIN < 1.0:
            continue
        skins[system.model.bodies[body].name] = float(1 / abs(depth))
        sides = contacts.of_body(body)
        trace = sp.hstack([traces[side][:, points] for side, points in sides]).tocsr()
        weights = np.concatenate([system.weights[points] for _, points in sides])
        passed = np.concatenate([(system.weights * direct)[points] for _, points in sides])
        rows = np.flatnonzero(conduction.body[conduction.kept] == body)
        rows = rows[heat.stored[rows].getnnz(axis=1) > 0]  # without multipliers
        inside = heat.conducted + 1j * frequency * heat.stored
        inside = (inside - trace @ sp.diags(passed) @ trace.T).tocsr()[rows][:, rows].tocsc()
        load = (trace @ weights)[rows]
        discrete = weights.sum() / (load @ splu(inside).solve(load + 0j))
        added = weights * (best.conductivity * depth - discrete)
        matrix = matrix + trace @ sp.diags(added) @ trace.T
    if not skins:
        return 0.0, skins
    turned = mode.rate * heat.stored + 1j * mode.factor * sp.diags(heat.turning) @ heat.stored
    rises = splu((matrix + turned).tocsc()).solve(mode.factor * heat.heated + 0j)
    flexibility = waves.equations.without_wear.flexibility(mode.factor, mode.rate)
    influence = -np.linalg.solve(flexibility, heat.opening @ rises)
    gain, _ = Gains(*np.linalg.eig(influence)).like(mode.shape)
    return float(np.expm1(abs(np.log(gain)))) if gain else np.inf, skins


def _padded(trace: sp.csr_matrix, kept: np.ndarray) -> sp.csr_matrix:
    """Transposed trace with rows of multipliers, and without those of given temperatures."""
    extra = sp.csr_matrix((len(kept) - trace.shape[0], trace.shape[1]))
    return sp.vstack([trace, extra]).tocsr()[kept]
