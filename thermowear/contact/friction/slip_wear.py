"""Wear by local slip: where the faces rub each wearing body loses depth, by its own wear law.

The depth worn off has coefficients ω in the basis of pressure and shear. In an increment the bodies
lose, coefficient by coefficient, by the pressure and by the slip in the mean of each function,

    κ λ^b |Δs|^a Δt^(1-a),      Δs = Ψᵀ w Δs(x) / Ψᵀ w 1.

Slip at single points scatters about zero where it sticks; in the mean it vanishes exactly, and so
does wear. Where it slips, the shear is ``mu λ``, coefficient by coefficient: for ``a = b = 1`` the
volume worn off is exactly ``κ/mu`` times the energy dissipated.

Coefficients are counted along the common face, of which each body takes its share (see
`common_face`). The worn profiles slide along it: at a slip s, ``W1(x - s_2 s)`` and
``W2(x + s_1 s)`` lie at x. Between the functions it is interpolated linearly, by a matrix
L; what is lost there goes back to ω by its adjoint, so that no volume is lost on the way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...errors import ComputationError
from ...laws.interfaces import WearRate
from ..search.pairing import Pairing
from .stick_slip_state import StickSlipState

_PASSES = 40
_SETTLED = 1e-6  # of the depth worn off in the increment


@dataclass(frozen=True)
class WornProfile:
    """Where a wearing body has its worn profile.

    Attributes
    ----------
    places : ndarray, shape (m,)
        Of the basis functions, as lengths along the face, which runs along +x [m].
    areas : ndarray, shape (m,)
        Of the basis functions [m²].
    moves : float
        How far it goes along the common face per slip.
    """

    places: np.ndarray
    areas: np.ndarray
    moves: float

    def seen(self, slip: float) -> np.ndarray:
        """L: coefficients at the contact, of the profile's own, at a slip along +x [m], (m, m)."""
        m = len(self.places)
        if self.moves * slip == 0.0:
            return np.eye(m)
        places, at = self.places, self.places - self.moves * slip
        upper = np.clip(np.searchsorted(places, at), 1, m - 1)
        part = (at - places[upper - 1]) / (places[upper] - places[upper - 1])
        part = np.clip(part, 0.0, 1.0)
        result, rows = np.zeros((m, m)), np.arange(m)
        result[rows, upper - 1], result[rows, upper] = 1 - part, part
        return result

    def lost(self, slip: float) -> np.ndarray:
        """The profile's own coefficients, of what is lost at the contact, shape (m, m)."""
        return self.seen(slip).T * self.areas / self.areas[:, None]


def profile(pairing: Pairing, weighted: np.ndarray, body: int) -> WornProfile:
    """The worn profile of a body (0 is body 1) in the basis of the pressure.

    Parameters
    ----------
    pairing : Pairing
        Of plane bodies.
    weighted : ndarray, shape (n, m)
        ``diag(w) Ψ``.
    body : int
    """
    areas = weighted.sum(axis=0)
    share = float(pairing.weights @ pairing.share / pairing.weights.sum())
    moves = 1.0 - share if body == 0 else -share
    return WornProfile((pairing.position @ weighted) / areas, areas, moves)


@dataclass(frozen=True)
class SlipWear:
    """Wear of the bodies in one increment of a history of loads.

    Attributes
    ----------
    laws : tuple of WearRate
        Of the wearing bodies; they depend on neither temperature nor depth.
    profiles : tuple of WornProfile
        Of the same bodies.
    friction : float
        Coefficient.
    duration : float
        Of the increment; nothing wears in none [s].
    repeats : int
        How many such increments it stands for, one a cycle.
    """

    laws: tuple[WearRate, ...]
    profiles: tuple[WornProfile, ...]
    friction: float
    duration: float
    repeats: int = 1

    def seen(self, worn: np.ndarray, slid: float) -> np.ndarray:
        """Depth at the contact of profiles worn so far, shape (n_wearing, m) to (m,) [m]."""
        depth = np.zeros(worn.shape[1])
        for own, profile in zip(worn, self.profiles, strict=True):
            depth += profile.seen(slid) @ own
        return depth

    def depths(self, pressure: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """What the bodies lose at the contact, shape (n_wearing, m) [m].

        Parameters
        ----------
        pressure : ndarray, shape (m,)
            λ at the end of the increment [Pa].
        slip : ndarray, shape (m,)
            Amount of slip of the increment, in the mean of each function [m].
        """
        return self._each(pressure, slip, [law.rate for law in self.laws])

    def slopes(self, pressure: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Their derivatives by the pressure, shape (n_wearing, m) [m/Pa]."""
        return self._each(pressure, slip, [law.slope for law in self.laws])

    def _each(self, pressure, slip, functions) -> np.ndarray:
        if self.duration == 0.0:
            return np.zeros((len(self.laws), len(pressure)))
        speed, time = slip / self.duration, self.repeats * self.duration
        values = [time * of_law(pressure, speed, friction=self.friction) for of_law in functions]
        return np.reshape(values, (-1, len(pressure)))

    def halved(self) -> SlipWear:
        """Of half the increment."""
        return replace(self, duration=self.duration / 2)


def implicitly(
    solve: Callable[[StickSlipState, np.ndarray, np.ndarray], StickSlipState],
    wear: SlipWear,
    slid: float,
    before: StickSlipState,
    unworn: StickSlipState,
    areas: np.ndarray,
) -> tuple[StickSlipState, np.ndarray]:
    """The end of an increment and the depths worn off in it, which the pressure there decides.

    However much is worn off, that is stable. Each pass is a step of Newton's method for the
    pressure, from half way back where the last one went too far, and takes the slip from the pass
    before.

    Parameters
    ----------
    solve : callable
        The end for a guess, and coefficients of the depth at the contact: what is worn off at no
        pressure, shape (m,), and its slope by the pressure, shape (m, m).
    wear : SlipWear
    slid : float
        How far body 1 has been moved along +x [m].
    before, unworn : StickSlipState
        Begin of the increment, and its end without wear.
    areas : ndarray, shape (m,)
        Of the basis functions [m²].

    Returns
    -------
    StickSlipState
    depths : ndarray, shape (n_wearing, m)
        Coefficients of the bodies' own profiles [m].

    Raises
    ------
    ComputationError
        If slip and wear do not settle.
    """
    m = len(areas)
    kept = np.reshape([profile.lost(slid) for profile in wear.profiles], (-1, m, m))
    seen = np.reshape([profile.seen(slid) for profile in wear.profiles], (-1, m, m))
    opens = seen @ kept
    after, expected = unworn, np.zeros(m)
    pressure, least = unworn.pressure, np.inf
    for _ in range(_PASSES):
        slip = after.moves * np.linalg.norm(after.slip - before.slip, axis=1) / areas
        depths = wear.depths(after.pressure, slip)
        opened = np.einsum("bmn,bn->m", opens, depths)
        error = np.abs(opened - expected).max()
        if error <= _SETTLED * opened.max():
            return after, np.einsum("bmn,bn->bm", kept, depths)
        back = 0.0 if error < least else 0.5
        pressure, least = back * pressure + (1 - back) * after.pressure, min(error, least)
        slope = np.einsum("bmn,bn->mn", opens, wear.slopes(pressure, slip))
        start = np.einsum("bmn,bn->m", opens, wear.depths(pressure, slip)) - slope @ pressure
        after = solve(after, start, slope)
        expected = start + slope @ after.pressure
    raise ComputationError(
        "contact: slip and wear of an increment do not settle; take smaller increments, or let "
        "each computed cycle stand for fewer (analysis.jump)"
    )
