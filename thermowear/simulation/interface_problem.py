"""The interface alone: contact, friction heat and an implicit step of wear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..errors import ComputationError
from ..laws import WearLaw
from ..laws.spreading import Spreading
from .friction_heat import FrictionHeat
from .system import System

_NEWTON_STEPS = 40


@dataclass(frozen=True)
class Contact:
    """A solved contact.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    motion : ndarray, shape (n_drives,)
        How far the holder has made each of its motions [m or rad].
    memory : object
        What the method that solved it starts from next time.
    """

    pressure: np.ndarray
    motion: np.ndarray
    memory: Any


class ContactMethod(Protocol):
    """A way to solve contact with given loads: condensed, or on the full system.

    Attributes
    ----------
    note : str or None
        What the user should know about its settings.
    """

    note: str | None

    def solve(
        self, gap: np.ndarray, slope: np.ndarray, guess: Contact | None, closed: np.ndarray
    ) -> Contact:
        """Contact of bodies with friction heat and a local compliance.

        Parameters
        ----------
        gap : ndarray, shape (n,)
            Without pressure, heat and motion of the holder [m].
        slope : ndarray, shape (n,)
            Gap that each point's own pressure opens in addition to the bodies [m/Pa].
        guess : Contact or None
        closed : ndarray of bool, shape (n,)
            Points that exchange heat.

        Raises
        ------
        ComputationError
        """

    def steady(self, pressure: np.ndarray, rates) -> np.ndarray:
        """Steady pressure as the method discretises it, from that of the principle [Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,) [Pa]
        rates : WearRates
        """

    def opening(self, contact: Contact) -> float:
        """Largest change of the gap by the bodies' deformation [m]."""


@dataclass(frozen=True)
class WearRates:
    """The wear laws at the contact points.

    Attributes
    ----------
    laws : list of WearLaw
        Of the wearing bodies.
    spreads : list of Spreading
        Of the same bodies.
    speed : ndarray, shape (n,) [m/s]
    """

    laws: list[WearLaw]
    spreads: list[Spreading]
    speed: np.ndarray

    def __call__(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates, shape (n_wearing, n) [m/s]."""
        local = [law.rate(pressure, self.speed) for law in self.laws]
        return np.array([s.rate(rate) for s, rate in zip(self.spreads, local, strict=True)])

    def slope(self, pressure: np.ndarray) -> np.ndarray:
        """Derivative of their sum by the pressure on the spot, shape (n,) [m/s/Pa].

        What a track has in common hardly changes with the pressures: their sum is the load.
        """
        slopes = [law.slope(pressure, self.speed) for law in self.laws]
        parts = [s.share * slope for s, slope in zip(self.spreads, slopes, strict=True)]
        return np.sum(parts, axis=0)


class InterfaceProblem:
    """Contact with heat and wear for given loads.

    Parameters
    ----------
    system : System
    method : ContactMethod
    heat : FrictionHeat or None
    """

    def __init__(self, system: System, method: ContactMethod, heat: FrictionHeat | None):
        self._method = method
        self._heat = heat
        self._gap = system.pairing.gap - system.holder.imposed
        self._softness = system.softness
        laws, spreads = list(system.laws.values()), list(system.spreads.values())
        self.rates = WearRates(laws, spreads, system.speed)

    @property
    def note(self) -> str | None:
        """What the user should know about the settings of the method."""
        return self._method.note

    def deflection(self, contact: Contact) -> float:
        """Largest change of the gap by the bodies' deformation under a pressure [m]."""
        return self._method.opening(contact)

    def hottest(self, pressure: np.ndarray) -> float:
        """Highest temperature of both faces [K]; NaN without heat."""
        return float("nan") if self._heat is None else self._heat.hottest(pressure)

    def unworn(self) -> Contact:
        """Contact of the unworn faces; the points that exchange heat are found by iteration.

        Raises
        ------
        ComputationError
            If the set of touching points does not settle.
        """
        nothing = np.zeros(len(self._gap))
        closed, contact = nothing == 0, None
        for _ in range(50):
            contact = self.solve(nothing, 0.0, None, closed)
            touching = contact.pressure > 0
            if self._heat is None or np.array_equal(touching, closed):
                return contact
            closed = touching
        raise ComputationError(
            "contact: the touching points do not settle under friction heat; "
            "give the contact a (smaller) heat.conductance"
        )

    def solve(
        self, worn: np.ndarray, step: float, guess: Contact | None, closed: np.ndarray
    ) -> Contact:
        """Contact at the end of an implicit step of wear, by Newton's method.

        Each Newton step is a contact problem of its own: wear that grows with the pressure adds
        ``step · ∂rate/∂p`` to the compliance of each point.

        Parameters
        ----------
        worn : ndarray, shape (n,)
            Depth worn off both bodies before the step [m].
        step : float
            [s]; 0 for contact alone.
        guess : Contact or None
        closed : ndarray of bool, shape (n,)
            Points that exchange heat.

        Raises
        ------
        ComputationError
        """
        gap, soft = self._gap + worn, np.full(len(worn), self._softness)
        if guess is None or step == 0.0:
            guess = self._method.solve(gap, soft, guess, closed)
        if step == 0.0:
            return guess
        return self._with_wear(gap, step, guess, closed)

    def steady(self, pressure: np.ndarray) -> np.ndarray:
        """Steady pressure of the discrete interface: what a running-in of it tends to [Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,)
            The steady pressure point by point [Pa].
        """
        return self._method.steady(pressure, self.rates)

    def distance(self, pressure: np.ndarray, steady: np.ndarray | None) -> float:
        """Largest difference to a steady pressure, relative to the largest of that; NaN without."""
        if steady is None:
            return float("nan")
        return float(np.abs(pressure - steady).max() / steady.max())

    def _with_wear(self, gap, step: float, guess: Contact, closed) -> Contact:
        return newton_with_wear(
            lambda worn, slope, last: self._method.solve(
                gap + worn, self._softness + slope, last, closed
            ),
            self.rates,
            step,
            guess,
        )


def newton_with_wear(solve, rates: WearRates, step: float, guess: Contact) -> Contact:
    """Newton's method on contact with wear that grows with the pressure.

    Parameters
    ----------
    solve : callable
        Contact for a worn depth at zero pressure (n,), its slope by the pressure (n,), and a guess.
    rates : WearRates
    step : float
        [s]
    guess : Contact

    Raises
    ------
    ComputationError
    """
    pressure = guess.pressure
    for _ in range(_NEWTON_STEPS):
        rate = step * rates(pressure).sum(axis=0)
        slope = step * rates.slope(pressure)
        guess = solve(rate - slope * pressure, slope, guess)
        change = guess.pressure - pressure
        pressure = guess.pressure
        exact = step * rates(pressure).sum(axis=0)
        if np.abs(exact - rate - slope * change).max() <= 1e-11 * np.abs(exact).max():
            return guess
    raise ComputationError("contact: Newton's method for the implicit step of wear failed")
