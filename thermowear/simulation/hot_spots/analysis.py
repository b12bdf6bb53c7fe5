"""Search for hot spots: critical speeds of all numbers, growth rates and modes.

A wave of the frequency ω in the frame of a body reaches as deep as ``1/|λ|``, ``λ² = m² + i ω/κ``,
and its face takes up the heat ``k λ`` per temperature. Elements that are larger than the skin take
up another heat, whatever their degree: how much this changes the gain of a mode tells its error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ...bulk.spaces import gathered_rows
from ...errors import CaseError, ComputationError, percent
from ...laws.waves import Gains, WaveMode
from ...model.analyses import StabilityAnalysis
from ...model.model import Model
from ...results import GrowthRow, HotSpotRow, HotSpots, Result
from ..results.recording import Snapshot
from ..runtime.observer import Observer
from ..system.building import build
from ..system.system import System
from ..system.thermal_system import conducting_parts
from .bodies import Symmetry
from .mode_fields import SIGNS, mode_fields
from .search import CriticalWaves, growth, refined, search
from .wave_model import WaveModel, WaveSystem


def require_waves(system: System, analysis: StabilityAnalysis) -> None:
    """Reject models without waves along the sliding.

    Raises
    ------
    CaseError
    """
    model = system.model
    ring = model.kinematics == "axisymmetric"
    if ring != bool(analysis.hot_spots):
        wanted = "an axisymmetric model" if analysis.hot_spots else "a plane-strain model"
        key = "hot_spots" if analysis.hot_spots else "wave_lengths"
        raise CaseError(f"analysis.{key}: needs {wanted}; found model = {model.kinematics!r}")
    if model.kinematics not in ("axisymmetric", "plane-strain"):
        raise CaseError(
            f"analysis.wave_lengths: found model = {model.kinematics!r}; waves along the sliding "
            "need a plane-strain section"
        )
    if not ring and any(not (i.motion.at_rest or i.motion.across) for i in model.interfaces):
        raise CaseError(
            "analysis.wave_lengths: a body slides within the section; waves along the sliding need "
            "a section normal to it (across = true)"
        )
    if system.thermal is None or system.thermal.conduction.capacity is None:
        raise ComputationError(
            "hot spots move on at least one body; they need density and specific_heat of all bodies"
        )
    unknown = set(analysis.mirror) - set(system.bodies.each[0].surfaces)
    if unknown:
        raise CaseError(f"analysis.mirror: found {sorted(unknown)[0]!r}; it is no surface")
    guided = {*model.symmetry, *(s for b in model.bodies for s in b.rollers)}
    if set(analysis.mirror) - guided:
        raise CaseError(
            f"analysis.mirror: {sorted(set(analysis.mirror) - guided)[0]} is no plane of symmetry; "
            "its normal displacement must vanish (symmetry or rollers)"
        )


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


_NAN = float("nan")
_REMEDY = "refine the mesh, or resolve the thermal skin (mesh.skin)"
_COARSE = 0.01
"""Error estimate from which the mesh is reported as too coarse."""
_UNRESOLVED = 0.5
"""Error estimate from which the critical speed is not known."""


def hot_spots(
    end: Snapshot,
    analysis: StabilityAnalysis,
    observer: Observer,
    base: Callable[[System, Observer], tuple[Snapshot, Result]],
) -> tuple[dict[str, Any], HotSpots]:
    """Summary entries and tables of the hot spots of an unperturbed state. Every rank calls.

    Parameters
    ----------
    end : Snapshot
        Unperturbed state.
    analysis : StabilityAnalysis
    observer : Observer
    base : callable
        Unperturbed state of another discretisation, for the error estimate.

    Raises
    ------
    CaseError
        If the model has no waves along the sliding.
    ComputationError
    """
    require_waves(end.system, analysis)
    model = _wave_model(end, analysis)
    symmetries: list[Symmetry] = ["symmetric", "antisymmetric"] if analysis.mirror else ["whole"]
    found = search(model, analysis.waves, symmetries)
    rows = [_row(model, analysis, one) for one in found]
    spots = [one for one in found if one.number > 0]
    for row in rows:
        observer.row(row, _NAN)
    _note_missing(model, found, observer)
    extra = _summary(model, found, "mode") | _summary(model, spots, "hot_spots")
    first = min(spots, key=lambda one: one.factor, default=None)
    if first is None or first.without_wear is None:
        observer.note("no hot spots grow at any speed: the bodies expand too little")
        return extra, HotSpots(rows, [], None)
    extra |= _error_estimate(end, analysis, observer, base, first)
    curve = [_growth_row(*one) for one in growth(model, first)]
    for step in curve:
        observer.row(step, _NAN)
    _note_unknown(curve, model.system.laws and first.with_wear, observer)
    waves = model.at(first.number, first.symmetry)
    return extra, HotSpots(rows, curve, mode_fields(model, waves, first.without_wear))


def _note_missing(model: WaveModel, found: list[CriticalWaves], observer: Observer) -> None:
    """Report waves that grow but were not found, without or with wear."""
    for one in found:
        waves = f"waves of the number {one.number:g} ({one.symmetry})"
        if not one.complete:
            observer.note(
                f"{waves} grow below their critical speed in hot_spots.csv, but were not found; "
                f"{_REMEDY}"
            )
        if model.system.laws and one.without_wear is not None and one.with_wear is None:
            observer.note(
                f"{waves} grow without wear; no critical speed with wear was found: wear may hold "
                f"them at any speed; otherwise {_REMEDY}"
            )


def _note_unknown(curve: list[GrowthRow], wears: object, observer: Observer) -> None:
    """Report speeds at which the first hot spots could not be followed."""
    unknown = [
        f"{step.speed_factor:.4g}"
        for step in curve
        if np.isnan(step.growth_rate) or (wears and np.isnan(step.growth_rate_with_wear))
    ]
    if unknown:
        observer.note(
            "the growth rate of the first hot spots is unknown (nan) at the speed factors "
            f"{', '.join(unknown)}: the mode could not be followed there; {_REMEDY}"
        )


def _wave_model(end: Snapshot, analysis: StabilityAnalysis) -> WaveModel:
    return WaveModel(end.system, end.contact.pressure, end.contact.conditions, analysis.mirror)


def _row(model: WaveModel, analysis: StabilityAnalysis, one: CriticalWaves) -> HotSpotRow:
    """Row of the table of critical speeds."""
    m, plain, worn = model.wave_number(one.number), one.without_wear, one.with_wear
    frequency = _NAN if plain is None else plain.rate.imag
    frequency = frequency if one.number else abs(frequency)  # of a pair of bands
    wears = bool(model.system.laws)
    return HotSpotRow(
        number=round(one.number) if analysis.hot_spots else 1,
        wave_number=m,
        symmetry=SIGNS[one.symmetry],
        speed_factor=_finite(one.factor),
        frequency=frequency,
        drift=-frequency / m if m else 0.0,
        speed_factor_with_wear=_finite(one.worn_factor) if wears else _NAN,
        frequency_with_wear=_NAN if worn is None or not wears else worn.rate.imag,
    )


def _growth_row(factor: float, plain, worn) -> GrowthRow:
    rates = [complex(_NAN, _NAN) if mode is None else mode.rate for mode in (plain, worn)]
    (rate, own), (with_wear, worn_own) = ((r.real, r.imag) for r in rates)
    return GrowthRow(factor, rate, own, with_wear, worn_own)


def _finite(value: float) -> float:
    return value if np.isfinite(value) else _NAN


def _summary(model: WaveModel, found: list[CriticalWaves], name: str) -> dict[str, Any]:
    """Summary entries of the first mode, or of the first hot spots, without and with wear."""
    entries: dict[str, Any] = {}
    kinds = [("", lambda one: one.factor)]
    if model.system.laws:
        kinds.append(("_with_wear", lambda one: one.worn_factor))
    for which, factor in kinds:
        first = min(found, key=factor, default=None)
        if first is None or not np.isfinite(factor(first)):
            continue
        mode = first.with_wear if which else first.without_wear
        assert mode is not None
        m = model.wave_number(first.number)
        entries |= {
            f"first_{name}{which}_number": _number(model, first),
            f"first_{name}{which}_symmetry": first.symmetry,
            f"first_{name}{which}_speed_factor": mode.factor,
            f"first_{name}{which}_drift_m_per_s": -mode.rate.imag / m if m else 0.0,
            **_speeds(model.system.model, f"first_{name}{which}", mode.factor),
        }
    return entries


def _number(model: WaveModel, waves: CriticalWaves) -> float:
    """Number of hot spots round the axis, or wave number along a prism [1/m]."""
    return waves.number if model.radius is None else int(waves.number)


def _speeds(model: Model, name: str, factor: float) -> dict[str, float]:
    """Critical speed of the fastest contact [m/s, rad/s]."""
    motions = [interface.motion for interface in model.interfaces]
    velocities = [abs(m.velocity) for m in motions if m.velocity is not None]
    turning = [abs(m.angular_velocity) for m in motions if m.angular_velocity is not None]
    found = {}
    if velocities:
        found[f"{name}_speed_m_per_s"] = factor * max(velocities)
    if turning:
        found[f"{name}_angular_velocity_rad_per_s"] = factor * max(turning)
    return found


def _error_estimate(
    end: Snapshot,
    analysis: StabilityAnalysis,
    observer: Observer,
    base: Callable[[System, Observer], tuple[Snapshot, Result]],
    first: CriticalWaves,
) -> dict[str, Any]:
    """Relative error of the first critical speed.

    By elements of one degree more, and by thermal skins that no degree resolves.
    """
    system, discretisation = end.system, end.system.model.discretisation
    finer = replace(discretisation, degree=discretisation.degree + 1, positioning=False)
    try:
        other = build(replace(system.model, discretisation=finer), system.comm, system.phases)
        factor = refined(_wave_model(base(other, observer)[0], analysis), first)
    except (CaseError, ComputationError) as reason:
        return {"error_estimate_missing": {"first_hot_spots": str(reason)}}
    if factor is None:
        return {"error_estimate_missing": {"first_hot_spots": "no mode on finer elements"}}
    model, mode = _wave_model(end, analysis), first.without_wear
    assert mode is not None
    of_skin, skins = skin_error(model, model.at(first.number, first.symmetry), mode)
    error = max(abs(factor / first.factor - 1.0), of_skin)
    if error > _UNRESOLVED:
        thin = ", ".join(f"{name} {1e6 * skin:.2g} µm" for name, skin in skins.items())
        observer.note(
            "the critical speed of hot spots is not resolved by the mesh"
            + f": thermal skins are thin ({thin})" * bool(skins)
            + "; use rows as thin at the contact (mesh.skin), or more elements of a higher degree"
        )
    elif error > _COARSE:
        observer.note(
            f"the critical speed of hot spots is uncertain by about {percent(error)}; refine "
            "the mesh: more elements, a higher degree, or thinner rows at the contact (mesh.skin)"
        )
    return {"first_hot_spots_error_estimate_relative": error}
