"""Motion of a holder at which worn faces conform with the least wear volume.

In the steady state the worn faces move as rigid bodies: the normal wear rate equals the normal
component of the rigid-body wear velocity, ``Σ Z_i p^b_i = V·n``, and ``p = 0`` where that is
negative. If both bodies wear with the same b this makes ``D_w = ∫ p·Σ w'_i dS`` stationary under
equilibrium (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895; see `minimum`). With
``b_1 ≠ b_2`` the derivative of D_w has terms ``(b_i + 1) Z_i p^b_i``, of different weight, while
the kinematic condition is unchanged: the pressure is then defined by the kinematics, and minimises
``Σ ∫ p·w'_i/(b_i + 1) dS``. Friction enters through equilibrium only: it may carry any load
(self-locking).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeGuard

import numpy as np
import scipy
import scipy.sparse as sp

from ...errors import ComputationError
from ..distribution import IN_PLACE, Distribution
from ..interfaces import Law, LocalState, Values
from ..wear import PowerWear
from .interior_point import BoundLaw, Common, LawSum, PowerSum, RateSum, solve

_TOLERANCE = 1e-10
"""Feasibility of linear programs, relative to the largest change of the gap; the least of HiGHS."""
_SLACK = 1e-11
"""Depth by which other motions of least volume may add material, relative to the same change."""
_SAME = 1e-6
"""Difference of depths below which there is one motion of least volume, as `_SLACK` allows it."""


def least_worn(
    modes: np.ndarray, opening: np.ndarray, weights: np.ndarray, pressing: np.ndarray
) -> np.ndarray:
    """Motion of the holder at which the faces conform with the least wear volume.

    The wear depth is ``R d - B u``, non-negative at all points in contact. For a single translation
    of a flat face the highest point is then just unworn. Where many motions wear as little, as
    tilts of a symmetric face, the one of least squares of the depth is taken, which is unique: a
    symmetric face stays symmetric. Likewise where every motion would need material to be added, as
    of a body between two others.

    Parameters
    ----------
    modes : ndarray, shape (n, k)
        R of the free motions.
    opening : ndarray, shape (n,)
        ``B u``, change of the gap by load and heat [m].
    weights : ndarray, shape (n,) [m²]
    pressing : ndarray of bool, shape (n,)

    Returns
    -------
    ndarray, shape (k,)
    """
    R, size = modes[pressing], np.abs(opening).max() or 1.0
    stretch = np.abs(R).max(axis=0)
    R, gap, weights = R / stretch, opening[pressing] / size, weights[pressing] / weights.sum()
    volume = weights @ R
    found = scipy.optimize.linprog(
        volume / np.abs(volume).max(),
        A_ub=-R,
        b_ub=-gap,
        bounds=(None, None),
        options={
            "primal_feasibility_tolerance": _TOLERANCE,
            "dual_feasibility_tolerance": _TOLERANCE,
        },
    ).x
    if found is None:
        roots = np.sqrt(weights)
        found = np.linalg.lstsq(R * roots[:, None], gap * roots, rcond=None)[0]
        return found / stretch * size
    return _fitted(R, gap, weights, found) / stretch * size


def _fitted(R: np.ndarray, gap: np.ndarray, weights: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Motion of least squares among those with the volume of one; that one if there is no other."""
    free = np.linalg.svd((weights @ R)[None])[2][1:].T  # changes that leave the volume as it is
    rows, missing = R @ free, gap - R @ motion
    if rows.size == 0 or np.linalg.matrix_rank(rows) < rows.shape[1]:
        return motion
    bounds, root = np.minimum(missing, 0.0) - _SLACK, np.sqrt(weights)
    try:
        shift = _constrained_fit(root[:, None] * rows, root * missing, rows, bounds)
    except RuntimeError:  # of nnls, without convergence
        return motion
    change = rows @ shift
    feasible = np.all(change >= bounds - _SLACK)
    return motion + free @ shift if feasible and np.abs(change).max() > _SAME else motion


def _constrained_fit(
    A: np.ndarray, b: np.ndarray, rows: np.ndarray, bounds: np.ndarray
) -> np.ndarray:
    """Least squares of ``A x - b`` with ``rows @ x >= bounds``.

    Problem LSI of Lawson and Hanson, Solving Least Squares Problems, chapter 23: reduced to the
    least distance, whose dual has non-negative unknowns only.
    """
    Q, R = np.linalg.qr(A)
    middle = np.linalg.solve(R, Q.T @ b)
    reduced = np.linalg.solve(R.T, rows.T)
    aim = np.zeros(len(R) + 1)
    aim[-1] = 1.0
    dual = np.vstack((reduced, bounds - rows @ middle))
    residual = dual @ scipy.optimize.nnls(dual, aim)[0] - aim
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # no x is feasible: the result is not finite
        return middle - np.linalg.solve(R, residual[:-1] / residual[-1])


_NOTHING = 1e-9  # relative size below which a force or an approach is zero
_DEPENDENT = 1e-10  # relative singular value below which motions are linearly dependent


class SelfLocking(ComputationError):
    """Error: self-locking, friction carries any load without steady wear."""


class NotCarried(ComputationError):
    """Error: the load lifts the body off, or tips it over the edge of its face."""


@dataclass(frozen=True)
class SteadyWear:
    """Steady state of wear at the contact points.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    rates : tuple of ndarray, shape (n,)
        Normal wear rate of each wearing body [m/s].
    velocity : ndarray, shape (k,)
        Rigid-body wear velocity along each free direction [m/s or rad/s].
    dissipation : float
        Wear dissipation power D_w [W]; equals load times velocity.
    approach : ndarray, shape (n,)
        Normal component of the rigid-body wear velocity ``V·n`` [m/s]; equals the sum of the rates
        at points under pressure.
    """

    pressure: np.ndarray
    rates: tuple[np.ndarray, ...]
    velocity: np.ndarray
    dissipation: float
    approach: np.ndarray


def steady_pressure(
    weights: np.ndarray,
    normal_modes: np.ndarray,
    force_modes: np.ndarray,
    load: np.ndarray,
    laws: Sequence[Law],
    speed: np.ndarray,
    spread: Sequence[Distribution] | None = None,
    factors: np.ndarray | None = None,
    temperature: np.ndarray | None = None,
    friction: Values = 0.0,
) -> SteadyWear:
    """Solve the principle for pressure and rigid-body wear velocity.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Areas of the contact points [m²]; points without area carry no load.
    normal_modes : ndarray, shape (n, k)
        R: normal component of each unit rigid motion at the points.
    force_modes : ndarray, shape (n, k)
        T: component along ``n + mu e_1 + mu_d e_2``, for the equilibrium of pressure and friction.
    load : ndarray, shape (k,)
        Force or moment along each free direction [N or N m].
    laws : sequence of Law
        Laws of one or two wearing bodies; rates must increase with the pressure.
    speed : ndarray, shape (n,)
        Sliding speed [m/s].
    spread : sequence of Distribution, optional
        Distribution of the wear of each body; by default in place.
    factors : ndarray, shape (n_wearing, n), optional
        Factors of the wear rates at the points, by default 1.
    temperature : ndarray, shape (n_wearing, n), optional
        Temperature of the wearing faces, for laws that depend on it [K].
    friction : ndarray, shape (n,), optional
        Coefficient of friction, for laws that depend on it.

    Returns
    -------
    SteadyWear

    Raises
    ------
    SelfLocking
        If friction carries any load.
    NotCarried
        If the load opens the contact.
    ComputationError
        If points do not slide, all wear is spread over tracks, free motions are dependent at the
        faces, or a rate decreases with pressure.
    """
    spread = spread if spread is not None else [IN_PLACE] * len(laws)
    factors = factors if factors is not None else np.ones((len(laws), len(weights)))
    if not np.all(speed > 0):
        raise ComputationError("no steady state: the sliding speed is 0 at some contact points")
    if not laws:
        raise ComputationError("no steady state: no body has a wear law")
    if not any(np.any(distribution.share > 0) for distribution in spread):
        raise ComputationError(
            "no unique steady pressure: all wear is spread uniformly along tracks, which does not "
            "constrain it; let one body wear in place"
        )
    _check_motions(weights, normal_modes)
    temperature = np.zeros((len(laws), 1)) if temperature is None else temperature
    states = (LocalState(0.0, speed, T, mu=friction) for T in temperature)
    bound = [BoundLaw(law, state) for law, state in zip(laws, states, strict=True)]
    found = solve(
        weights,
        normal_modes,
        force_modes,
        load,
        local=_rate_sum(
            bound, factors, np.array([np.broadcast_to(d.share, len(weights)) for d in spread])
        ),
        common=_common(bound, factors, spread),
    )
    if found is None or not found.regular:
        raise why_no_steady_state(weights, normal_modes, force_modes, load)
    for law in bound:
        if not _in_closed_form(law.law):
            law.require_growth(found.pressure)
    rates = tuple(
        distribution.rate(factor * law.rate(found.pressure))
        for law, distribution, factor in zip(bound, spread, factors, strict=True)
    )
    return SteadyWear(
        found.pressure,
        rates,
        found.velocity,
        dissipation=float(weights @ (found.pressure * (force_modes @ found.velocity))),
        approach=normal_modes @ found.velocity,
    )


def _rate_sum(laws: Sequence[BoundLaw], factors: np.ndarray, weights: np.ndarray) -> RateSum:
    """Weighted rates of the laws, shape (m, n); power laws in closed form."""
    powers = [law.law for law in laws if _in_closed_form(law.law)]
    if len(powers) < len(laws):
        return LawSum(laws, weights * factors, np.ones(factors.shape[1]))
    Z = [law.factor(bound.state.v) for law, bound in zip(powers, laws, strict=True)]
    exponents = [np.reshape(law.pressure_exponent, -1) for law in powers]  # (1,), or by point
    of_each = np.array(np.broadcast_arrays(*exponents)).reshape(len(powers), -1)
    return PowerSum(weights * factors * np.reshape(Z, factors.shape), of_each)


def _in_closed_form(law: Law) -> TypeGuard[PowerWear]:
    """True if a law is exactly a power law; a derived class may override its rate."""
    return type(law) is PowerWear


def _common(
    laws: Sequence[BoundLaw], factors: np.ndarray, spread: Sequence[Distribution]
) -> Common | None:
    """Means of the rates shared by several points; None without any."""
    tracks = [(k, track.means) for k, track in enumerate(spread) if track.means is not None]
    if not tracks:
        return None
    owners, every = [k for k, _ in tracks], [means for _, means in tracks]
    rates = _rate_sum([laws[k] for k in owners], factors[owners], np.ones(factors[owners].shape))
    rows = [sp.csr_array(means.rows) for means in every]
    return Common(rates, rows, np.hstack([means.reach for means in every]))


def _check_motions(weights: np.ndarray, normal_modes: np.ndarray) -> None:
    """Raise if free motions of the holder are linearly dependent at the faces."""
    modes = np.sqrt(weights)[:, None] * normal_modes
    lengths = np.linalg.norm(modes, axis=0)
    if (
        lengths.min() <= _DEPENDENT * np.linalg.norm(np.sqrt(weights)) * np.abs(normal_modes).max()
        or np.linalg.svd(modes / lengths, compute_uv=False)[-1] < _DEPENDENT
    ):
        raise ComputationError(
            "no steady state: the free motions of the holder are linearly dependent at the "
            "contact faces; remove one of them from holder.free"
        )


def not_carried(weights: np.ndarray, modes: np.ndarray, load: np.ndarray) -> NotCarried | None:
    """Error if no pressure ``p >= 0`` carries the load, ``modesᵀ w p = F``; otherwise None."""
    scale = np.abs(modes).max(axis=0)
    _, left = scipy.optimize.nnls((modes[weights > 0] / scale).T, load / scale)
    if left < _NOTHING * np.linalg.norm(load / scale):
        return None
    return NotCarried(
        "no contact pressure is in equilibrium with the load: it lifts the body off or tips it "
        "over an edge of the face; change the load or its line of action"
    )


def why_no_steady_state(
    weights: np.ndarray, normal_modes: np.ndarray, force_modes: np.ndarray, load: np.ndarray
) -> ComputationError:
    """Error to raise if the principle has no solution.

    Self-locking requires pressures in equilibrium with their friction without load, at some
    coefficient of friction up to the given one. It is excluded if a motion of the holder exists
    against which every pressure does work, with and without friction: ``R y > 0`` and ``T y > 0``
    at all points bound the pressures by ``F·y``.

    Parameters
    ----------
    weights : ndarray, shape (n,)
    normal_modes, force_modes : ndarray, shape (n, k)
        R and T.
    load : ndarray, shape (k,)
    """
    outside = not_carried(weights, normal_modes, load)
    if outside is None and not _bounded(normal_modes, force_modes):
        return SelfLocking(
            "self-locking: friction carries any load, without steady wear in this direction of "
            "sliding; lower the friction or reverse the motion"
        )
    return (
        outside
        or not_carried(weights, force_modes, load)
        or ComputationError(
            "no steady state: the solver found no pressure and rigid-body wear velocity in "
            "equilibrium with the load"
        )
    )


def _bounded(R: np.ndarray, T: np.ndarray) -> bool:
    """Test whether a motion y exists with ``R y > 0`` and ``T y > 0`` at all points."""
    rows = np.vstack([R, T])
    rows = rows / np.abs(rows).max(axis=0)
    least = scipy.optimize.linprog(  # the largest t with rows y >= t
        c=np.append(np.zeros(R.shape[1]), -1.0),
        A_ub=np.column_stack([-rows, np.ones(len(rows))]),
        b_ub=np.zeros(len(rows)),
        bounds=(-1.0, 1.0),
    )
    return bool(-least.fun > _NOTHING)
