"""The steady state of wear from the principle of minimum wear dissipation power (q = 1).

In the steady state the worn faces move as rigid bodies do: the normal wear rate equals the normal
component of the rigid-body wear velocity, ``Σ Z_i p^b_i = V·n``, and ``p = 0`` where that is
negative. Where both bodies wear with the same b this is what makes ``D_w = ∫ p·Σ w'_i dS``
stationary under equilibrium (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895; `minimum`
finds it that way). With ``b_1 ≠ b_2`` the derivative of D_w has terms ``(b_i + 1) Z_i p^b_i``, of
different weight, while the bodies still wear as they approach: the pressure is then that of the
kinematics, which minimises ``Σ ∫ p·w'_i/(b_i + 1) dS``. Friction enters through equilibrium only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import ComputationError
from ..distribution import InPlace, Spreading
from ..wear import WearLaw
from .interior_point import Common, PowerSum, solve
from .solvability import why_no_steady_state

_DEPENDENT = 1e-10  # relative: motions nearer than this to each other press the faces the same way


@dataclass(frozen=True)
class SteadyWear:
    """The steady state of wear at the contact points.

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
        Normal component of the rigid-body wear velocity ``V·n`` [m/s]; where there is pressure, the
        sum of the rates.
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
    laws: Sequence[WearLaw],
    speed: np.ndarray,
    spread: Sequence[Spreading] | None = None,
    factors: np.ndarray | None = None,
) -> SteadyWear:
    """Solve the principle for pressure and rigid-body wear velocity.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Areas of the contact points [m²]; points without area are solved for and bear nothing.
    normal_modes : ndarray, shape (n, k)
        Normal component of each unit rigid motion at the points, R.
    force_modes : ndarray, shape (n, k)
        T, the same for ``n + mu e_1 + mu_d e_2``, which carries the pressure and its friction in
        equilibrium.
    load : ndarray, shape (k,)
        Force or moment along each free direction [N or N m].
    laws : sequence of WearLaw
        Of the wearing bodies, one or two.
    speed : ndarray, shape (n,)
        Sliding speed [m/s].
    spread : sequence of Spreading, optional
        Where the wear of each body goes; by default each wears in place.
    factors : ndarray, shape (n_wearing, n), optional
        Of the wear rates at the points, by default 1.

    Returns
    -------
    SteadyWear

    Raises
    ------
    SelfLocking
        If friction carries the load whatever the pressure.
    NotCarried
        If the load opens the contact.
    ComputationError
        If points do not slide, nothing wears where it is pressed, or a motion presses nothing.
    """
    spread = spread if spread is not None else [InPlace()] * len(laws)
    factors = factors if factors is not None else np.ones((len(laws), len(weights)))
    if not np.all(speed > 0):
        raise ComputationError("no steady state: some contact points do not slide")
    if not laws:
        raise ComputationError("no steady state: no body wears")
    if not any(way.share > 0 for way in spread):
        raise ComputationError(
            "no steady pressure: all wear is spread over a track, which takes any pressure"
        )
    _check_motions(weights, normal_modes)
    found = solve(
        weights,
        normal_modes,
        force_modes,
        load,
        local=_power_sum(laws, speed, factors, [way.share for way in spread]),
        common=_common(laws, speed, factors, spread),
    )
    if found is None or not found.regular:
        raise why_no_steady_state(weights, normal_modes, force_modes, load)
    rates = tuple(
        way.rate(factor * law.rate(found.pressure, speed))
        for law, way, factor in zip(laws, spread, factors, strict=True)
    )
    return SteadyWear(
        found.pressure,
        rates,
        found.velocity,
        dissipation=float(weights @ (found.pressure * (force_modes @ found.velocity))),
        approach=normal_modes @ found.velocity,
    )


def _power_sum(laws: Sequence[WearLaw], speed: np.ndarray, factors, portions) -> PowerSum:
    """The part of the bodies' rates ``Z p^b`` that goes one way."""
    each = zip(portions, laws, factors, strict=True)
    Z = [portion * factor * law.factor(speed) for portion, law, factor in each]
    return PowerSum(np.array(Z), np.array([law.pressure_exponent for law in laws]))


def _common(
    laws: Sequence[WearLaw], speed: np.ndarray, factors, spread: Sequence[Spreading]
) -> Common | None:
    """The means of the bodies' rates that points have in common; None without any."""
    found = [
        (way.rows * (factor * law.factor(speed)), law.pressure_exponent, way.reach(len(speed)))
        for law, way, factor in zip(laws, spread, factors, strict=True)
        if way.rows is not None
    ]
    if not found:
        return None
    rows, exponents, reach = zip(*found, strict=True)
    each = np.repeat(exponents, [len(weights) for weights in rows])
    return Common(PowerSum(np.vstack(rows), each), np.hstack(reach))


def _check_motions(weights: np.ndarray, normal_modes: np.ndarray) -> None:
    """Each free motion of the holder must press the faces in a way of its own."""
    modes = np.sqrt(weights)[:, None] * normal_modes
    lengths = np.linalg.norm(modes, axis=0)
    if (
        lengths.min() <= _DEPENDENT * np.linalg.norm(np.sqrt(weights)) * np.abs(normal_modes).max()
        or np.linalg.svd(modes / lengths, compute_uv=False)[-1] < _DEPENDENT
    ):
        raise ComputationError(
            "no steady state: a free motion of the holder does not press the faces, or presses "
            "them as another one does; a guide must take its load"
        )
