"""Gross slip: whether the contacts can carry the tangential forces on a holder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.optimize import minimize

from ...errors import ComputationError
from ..operators.rigid_motion import HeldMotion

_MARGIN = 1e-9
_SWEEPS = 4
"""Solutions for the pressure, each with the mechanism of the last one."""


class FullSliding(ComputationError):
    """Error for a tangential force that exceeds the friction limit."""


class SlidingProblem(Protocol):
    """Contact problem of one increment, `coulomb.CoulombProblem` or on the full system."""

    @property
    def friction(self) -> np.ndarray:
        """Coefficients of friction, shape (m,)."""

    @property
    def modes(self) -> np.ndarray:
        """Weak modes of the free motions, shape (M, k) [m²]."""

    @property
    def force(self) -> np.ndarray:
        """Forces on the free motions, shape (k,) [N]."""

    def sliding_pressure(self, presses: np.ndarray, drag: np.ndarray) -> np.ndarray:
        """Coefficients λ, shape (m,), where all contacts slide [Pa].

        Parameters
        ----------
        presses : ndarray of bool, shape (k,)
            Motions that remain free.
        drag : ndarray, shape (t, m)
            Shear per pressure.
        """


def check_gross_slip_of_holders(
    problem: SlidingProblem, presses: np.ndarray, slides: np.ndarray, held: Sequence[HeldMotion]
) -> None:
    """Check each holder under tangential forces, see `check_gross_slip`.

    Parameters
    ----------
    problem : SlidingProblem
    presses, slides : ndarray of bool, shape (k,)
        True for the free motions along load directions, and under tangential forces.
    held : sequence of HeldMotion
        All k free motions.
    """
    for holder in dict.fromkeys(held[k].holder for k in np.flatnonzero(slides)):
        own = [k for k in np.flatnonzero(slides) if held[k].holder == holder]
        check_gross_slip(problem, presses, np.array(own), [held[k] for k in own])


def check_gross_slip(
    problem: SlidingProblem,
    presses: np.ndarray,
    slides: np.ndarray,
    held: Sequence[HeldMotion],
) -> None:
    """Raise if the contacts carry less than the tangential forces when they slip.

    In gross slip all contacts slide along one combination v of the motions under tangential forces,
    and the shear is a multiple of the pressure, which then solves a Signorini problem. By the upper
    bound theorem, forces with ``F·v > D(v) = λ·(R_n v) + Σ mu λ |R_t v|`` for any v are not
    carried; v makes ``D/F·v`` smallest. Contacts that no motion slides are taken as frictionless.

    Parameters
    ----------
    problem : SlidingProblem
    presses : ndarray of bool, shape (k,)
        True for the motions along load directions, which are free in gross slip.
    slides : ndarray of int
        Motions of a holder under tangential forces.
    held : sequence of HeldMotion
        These motions, for the message.

    Raises
    ------
    FullSliding, ComputationError
    """
    sliding = _Sliding(problem, presses, slides)
    asked, slip = sliding.asked, sliding.first_slip
    if not problem.friction.any():
        raise FullSliding(_message(asked, 0.0, 1.0, held))
    if len(slides) > 1 and not asked.any():
        return
    for _ in range(_SWEEPS if len(slides) > 1 else 1):
        λ = sliding.pressure(slip)
        if not np.any(λ > 0):
            raise ComputationError(
                "contact: the bodies do not touch, so that nothing balances a tangential force; "
                "give a tangential displacement, or press"
            )
        if not asked.any():
            return
        slip = sliding.mechanism(λ, slip)
    carried = sliding.power(λ, slip)
    if asked @ slip >= (1 - _MARGIN) * carried:
        raise FullSliding(_message(asked, carried, asked @ slip, held))


@dataclass(frozen=True)
class _Sliding:
    """Contacts that slide by motions v under tangential forces; see `check_gross_slip`."""

    problem: SlidingProblem
    presses: np.ndarray
    slides: np.ndarray

    @property
    def asked(self) -> np.ndarray:
        """Tangential forces and torques F."""
        return self.problem.force[self.slides]

    @cached_property
    def closing(self) -> np.ndarray:
        """Weak gap closed per unit of the motions, shape (m, k)."""
        return self.problem.modes[: len(self.problem.friction), self.slides]

    @cached_property
    def drawn(self) -> np.ndarray:
        """Weak slips against the motions per unit of them, shape (t, m, k)."""
        m = len(self.problem.friction)
        return self.problem.modes[m:, self.slides].reshape(-1, m, len(self.slides))

    @cached_property
    def sizes(self) -> np.ndarray:
        """Magnitudes of the motions, which make forces and torques comparable, shape (k,)."""
        return np.linalg.norm(self.drawn, axis=(0, 1))

    @property
    def first_slip(self) -> np.ndarray:
        """Motions along the forces."""
        if len(self.slides) == 1:
            return np.sign(self.asked)
        return self.asked / self.sizes**2

    def pressure(self, slip: np.ndarray) -> np.ndarray:
        """Pressure λ (m,) of the contacts that slide."""
        slid = self.drawn @ slip
        lengths = np.linalg.norm(slid, axis=0)
        drag = self.problem.friction * slid / np.where(lengths > 0, lengths, 1.0)  # τ = drag λ
        return self.problem.sliding_pressure(self.presses, drag)

    def power(self, λ: np.ndarray, slip: np.ndarray) -> float:
        """Power D(v) that the contacts of a pressure take, convex in v."""
        friction = np.linalg.norm(self.drawn @ slip, axis=0) @ (self.problem.friction * λ)
        return float(λ @ (self.closing @ slip) + friction)

    def mechanism(self, λ: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Motions v with the smallest D(v) among those of the same power of the forces."""
        if len(start) == 1:
            return start
        start = start / (self.asked @ start)
        across = np.linalg.svd((self.asked / self.sizes)[None])[2][1:].T  # steps of no power
        scale, unit = np.linalg.norm(start * self.sizes), self.power(λ, start)
        turn = scale * across / self.sizes[:, None]
        found = minimize(
            lambda step: self.power(λ, start + turn @ step) / unit,
            np.zeros(across.shape[1]),
            method="Nelder-Mead",
            options={"xatol": 1e-9, "fatol": 1e-12},
        )
        return start + turn @ found.x


def _message(asked: np.ndarray, carried: float, power: float, held: Sequence[HeldMotion]) -> str:
    remedy, holder = "Give a smaller force, or a tangential displacement", held[0].holder
    if len(asked) > 1:
        loads = ", ".join(f"{load:.6g}" for load in asked)
        return (
            f"{holder} slides; friction carries {carried / power:.6g} times the tangential forces "
            f"and torques ({loads}; N, N m). {remedy}"
        )
    load, unit = "tangential force", "N"
    if held[0].motion.rotation.any():
        load, unit, remedy = "torque", "N m", "Give a smaller torque, or a twist"
    return (
        f"{holder} slides; friction carries {abs(carried):.6g} {unit}, and the {load} "
        f"is {asked[0]:.6g} {unit}. {remedy}"
    )
