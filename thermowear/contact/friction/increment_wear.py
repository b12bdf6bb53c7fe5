"""Depth worn by slip in one increment, as a function of the pressure at its end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .slip_wear import SlipWear
from .stick_slip_state import StickSlipState


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
    """

    wear: SlipWear
    before: StickSlipState
    areas: np.ndarray
    travel: np.ndarray

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
        return self.at_contact(self.wear.depths(pressure, self._slip(last)))

    def slope(self, pressure: np.ndarray, last: StickSlipState) -> WearSlope:
        """Derivative of the depth [m/Pa]."""
        return WearSlope(self, self.wear.slopes(pressure, self._slip(last)))

    def profiles(self, after: StickSlipState) -> np.ndarray:
        """Worn coefficients in the profile of each body, shape (n_wearing, m_Ψ) [m]."""
        depths = self.wear.depths(after.pressure, self._slip(after))
        each = [own @ depth for own, depth in zip(self.wear_transfer, depths, strict=True)]
        return np.reshape(each, self.before.worn.shape)

    def _slip(self, after: StickSlipState) -> np.ndarray:
        """Magnitude of the weighted mean slip of the increment, shape (m,) [m]."""
        return (
            after.not_sticking * np.linalg.norm(after.slip - self.before.slip, axis=1) / self.areas
        )


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
