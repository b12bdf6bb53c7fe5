"""Depth worn by slip in one increment, as a function of the pressure at its end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .slip_wear import SlipWear
from .stick_slip_state import StickSlipState

_ITERATIONS = 20
_ROUNDING = 1e-12
_ROUNDED_SLIP = 1e-13
"""Slip that is rounding, relative to the displacement of the bodies."""


@dataclass(frozen=True)
class IncrementWear:
    """Depth worn at the contact in an increment, see `contact.wear.implicit_step`.

    The slip is that of the last solution.

    Attributes
    ----------
    wear : SlipWear
    before : StickSlipState
        State at the start of the increment.
    areas : ndarray, shape (m,)
        Areas of the basis functions [m²].
    travel : ndarray, shape (n_interfaces,), in space (n_interfaces, 3)
        Displacement of the first bodies along the faces at the end of the increment, see
        `FrictionalContact` [m].
    travel_before : ndarray
        That at its start [m].
    """

    wear: SlipWear
    before: StickSlipState
    areas: np.ndarray
    travel: np.ndarray
    travel_before: np.ndarray

    @cached_property
    def wear_transfer(self) -> tuple[np.ndarray, ...]:
        """Profile of each body from its depth worn at the contact, shape (m_Ψ, m) each."""
        return tuple(profile.wear_transfer(self.travel) for profile in self.wear.profiles)

    @cached_property
    def interpolation(self) -> tuple[np.ndarray, ...]:
        """Depth at the contact from the profile of each body, shape (m, m_Ψ) each."""
        return tuple(profile.interpolation(self.travel) for profile in self.wear.profiles)

    @cached_property
    def depth_per_wear(self) -> tuple[np.ndarray, ...]:
        """Depth of each profile at the contact from the depth worn there, shape (m, m) each."""
        pairs = zip(self.interpolation, self.wear_transfer, strict=True)
        return tuple(seen @ collected for seen, collected in pairs)

    def at_contact(self, depths: np.ndarray) -> np.ndarray:
        """Depth of all profiles at the contact, (m,), from those worn there, (n_wearing, m)."""
        triples = zip(self.interpolation, self.wear_transfer, depths, strict=True)
        parts = (seen @ (collected @ depth) for seen, collected, depth in triples)
        return sum(parts, start=np.zeros(len(self.areas)))

    def value(self, pressure: np.ndarray, last: StickSlipState) -> np.ndarray:
        """Depth at the contact, shape (m,) [m]."""
        return self.at_contact(self.depths(pressure, last))

    def slope(self, pressure: np.ndarray, last: StickSlipState) -> WearSlope:
        """Derivative of the depth [m/Pa]."""
        wearing, slip = self._wearing(pressure, last)
        rates = self.wear.slopes(wearing, slip)
        wears = ~self.before.crossed | (pressure >= self._relieved)
        shared = wears / (1.0 + rates.sum(axis=0) * self._stiffness)
        return WearSlope(self, rates * shared)

    def depths(self, pressure: np.ndarray, last: StickSlipState) -> np.ndarray:
        """Depths worn off the bodies at the contact, shape (n_wearing, m) [m]."""
        return self.wear.depths(*self._wearing(pressure, last))

    def unrelieved(self, after: StickSlipState) -> np.ndarray:
        """Depth of both bodies if wear relieved no pressure across the stick edge, (m,) [m]."""
        pressure = np.maximum(after.pressure - self.before.unsheared, 0.0)
        return self.wear.depths(pressure, self._wearing(after.pressure, after)[1]).sum(axis=0)

    def rounding(self, pressure: np.ndarray) -> float:
        """Largest depth at the contact by a slip that is rounding [m]."""
        moved = max(np.abs(travel).max() for travel in (self.travel, self.travel_before))
        slip = np.full(len(pressure), _ROUNDED_SLIP * moved)
        return float(self.at_contact(self.wear.depths(pressure, slip)).max())

    def profiles(self, depths: np.ndarray) -> np.ndarray:
        """Coefficients of the profile of each body, shape (n_wearing, m_Ψ), from `depths` [m]."""
        each = [own @ depth for own, depth in zip(self.wear_transfer, depths, strict=True)]
        return np.reshape(each, self.before.worn.shape)

    def dissipated(self, after: StickSlipState) -> np.ndarray:
        """Energy dissipated by coefficients across the stick edge, 0 by others, (m,) [J/m²]."""
        wearing, slip = self._wearing(after.pressure, after)
        return np.where(self.before.crossed, self.wear.friction * wearing * slip, 0.0)

    @cached_property
    def _stiffness(self) -> np.ndarray:
        """Pressure that a depth relieves, shape (m,) [Pa/m]."""
        edge = self.wear.edge
        return np.zeros(len(self.areas)) if edge is None else 1.0 / edge.opening(self.before.part)

    @cached_property
    def _relieved(self) -> np.ndarray:
        """Pressure that no longer wears at the start of the increment, shape (m,) [Pa]."""
        return self.before.unsheared + self._stiffness * self.before.excess

    def _wearing(self, pressure: np.ndarray, last: StickSlipState) -> tuple[np.ndarray, np.ndarray]:
        """Pressure that wears at the end of the increment, and mean slip, (m,) each [Pa, m]."""
        moved = np.linalg.norm(last.slip - self.before.slip, axis=1) / self.areas
        slip = last.not_sticking * moved
        edge = self.wear.edge
        if edge is None or not self.before.crossed.any():
            return pressure, slip
        slip = edge.slip(slip, last.pressure, self.before.part)
        most = np.maximum(pressure - self._relieved, 0.0)
        wearing = most
        for _ in range(_ITERATIONS):  # one of them for wear in proportion to the pressure
            depth = self.wear.depths(wearing, slip).sum(axis=0)
            rate = self.wear.slopes(wearing, slip).sum(axis=0)
            left = wearing + self._stiffness * depth - most
            wearing = np.clip(wearing - left / (1.0 + self._stiffness * rate), 0.0, most)
            if np.abs(left).max() <= _ROUNDING * most.max():
                break
        return wearing, slip


@dataclass(frozen=True)
class WearSlope:
    """Derivative of the depth worn at the contact in an increment by the pressure.

    Attributes
    ----------
    worn : IncrementWear
    rates : ndarray, shape (n_wearing, m)
        Depth worn off each body per pressure of the same coefficient [m/Pa].
    """

    worn: IncrementWear
    rates: np.ndarray

    def __matmul__(self, pressure: np.ndarray) -> np.ndarray:
        """Depth (m,) of pressures (m,) [m]."""
        return self.worn.at_contact(self.rates * pressure)

    @property
    def lumped(self) -> np.ndarray:
        """Sums of the rows, shape (m,) [m/Pa]."""
        return self.worn.at_contact(self.rates)

    @property
    def dense(self) -> np.ndarray:
        """Matrix, shape (m, m) [m/Pa]."""
        m, pairs = len(self.worn.areas), zip(self.worn.depth_per_wear, self.rates, strict=True)
        return sum((each * rates for each, rates in pairs), start=np.zeros((m, m)))
