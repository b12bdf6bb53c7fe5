"""Wear by local slip: depths of the increments, and worn profiles of the bodies.

The worn depth has coefficients ω in the basis of pressure and shear. The worn depth of an increment
follows, coefficient by coefficient, from the pressure and the weighted mean slip,

    κ λ^b |Δs|^a Δt^(1-a),      Δs = Ψᵀ w Δs(x) / Ψᵀ w 1.

Pointwise slip scatters about zero in stick zones; the weighted mean vanishes exactly, and so does
wear. In slip zones the shear is ``mu λ``, coefficient by coefficient: for ``a = b = 1`` the wear
volume is exactly ``κ/mu`` times the dissipated energy.

Coefficients refer to the common face, with the share of each body (see `common_face`). The worn
profiles slide along it: at a slip s, ``W1(x - s_2 s)`` and ``W2(x + s_1 s)`` lie at x. Profiles are
interpolated linearly between the functions by a matrix L (in space: see `worn_surface`); worn depth
is transferred back to ω by its adjoint, which conserves volume.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol, TypeAlias

import numpy as np
from scipy.linalg import block_diag

from ...laws.interfaces import Law, LocalState
from ..operators.pressure import function_ranges
from ..search.pairing import Contacts, Pairing
from ..wear.worn_profile import hat_functions
from .stick_edge import StickEdge
from .stick_slip_state import StickSlipState
from .worn_surface import worn_surface


@dataclass(frozen=True)
class WornProfile:
    """Worn profile of a body: positions of its coefficients on the face.

    Attributes
    ----------
    places : ndarray, shape (m,)
        Positions of the basis functions, arc length along the face [m].
    areas : ndarray, shape (m,)
        Areas of the basis functions [m²].
    shift_per_slip : float
        Displacement along the common face per unit slip.
    """

    places: np.ndarray
    areas: np.ndarray
    shift_per_slip: float

    def interpolation(self, slip: float) -> np.ndarray:
        """Matrix L: coefficients at the contact from those of the profile at a slip [m], (m, m)."""
        shift = self.shift_per_slip * slip
        if shift == 0.0:
            return np.eye(len(self.places))
        return hat_functions(self.places, self.places - shift)

    def wear_transfer(self, slip: float) -> np.ndarray:
        """Coefficients of the profile from the depths worn at the contact, shape (m, m)."""
        return self.interpolation(slip).T * self.areas / self.areas[:, None]


class SlidingProfile(Protocol):
    """Worn profile of a body at one interface, `WornProfile` or `worn_surface.WornSurface`."""

    def interpolation(self, slip: Any) -> np.ndarray:
        """Matrix L: coefficients at the contact from those of the profile at a slip, (m, m)."""

    def wear_transfer(self, slip: Any) -> np.ndarray:
        """Coefficients of the profile from the depths worn at the contact, shape (m, m)."""


@dataclass(frozen=True)
class WornProfiles:
    """Worn profiles of the first, or of the second bodies of all interfaces.

    Attributes
    ----------
    each : tuple of SlidingProfile
        Profile at each interface.
    """

    each: tuple[SlidingProfile, ...]

    def interpolation(self, travel: np.ndarray) -> np.ndarray:
        """Matrix L for the slips of the interfaces, see `FrictionalContact.travel`, (m, m)."""
        pairs = zip(self.each, travel, strict=True)
        return block_diag(*(profile.interpolation(slip) for profile, slip in pairs))

    def wear_transfer(self, travel: np.ndarray) -> np.ndarray:
        """Coefficients of the profiles from the depths worn at the contacts, shape (m, m)."""
        pairs = zip(self.each, travel, strict=True)
        return block_diag(*(profile.wear_transfer(slip) for profile, slip in pairs))


@dataclass(frozen=True)
class ProfilesAtPoints:
    """Worn profiles seen by a contact in points, each with a function of its own.

    The profiles keep the basis Ψ: depths worn at the points, collected by the adjoint of their
    interpolation, do not roughen the faces within an element.

    Attributes
    ----------
    profiles : WornProfiles
    basis : ndarray, shape (m, m_Ψ)
        Ψ at the points.
    areas : ndarray, shape (m,)
        Areas of the points [m²].
    """

    profiles: WornProfiles
    basis: np.ndarray
    areas: np.ndarray

    @cached_property
    def _means(self) -> np.ndarray:
        """Weighted means with the functions Ψ of depths at the points, shape (m_Ψ, m)."""
        weighted = self.basis.T * self.areas
        return weighted / weighted.sum(axis=1, keepdims=True)

    def interpolation(self, travel: np.ndarray) -> np.ndarray:
        """Depths at the points from coefficients of the profiles, shape (m, m_Ψ)."""
        return self.basis @ self.profiles.interpolation(travel)

    def wear_transfer(self, travel: np.ndarray) -> np.ndarray:
        """Coefficients of the profiles from the depths worn at the points, shape (m_Ψ, m)."""
        return self.profiles.wear_transfer(travel) @ self._means


AnyProfiles: TypeAlias = WornProfiles | ProfilesAtPoints


def worn_profiles(contacts: Contacts, weighted: np.ndarray, side: int) -> WornProfiles:
    """Worn profiles of the first (side 0) or of the second bodies in the basis of the pressure.

    Parameters
    ----------
    contacts : Contacts
    weighted : ndarray or csr_array, shape (n, m)
        ``diag(w) Ψ``.
    side : int
    """
    build = worn_surface if contacts.in_space else _profile
    ranges = zip(contacts, function_ranges(contacts, weighted), strict=True)
    each = (
        build(pairing, weighted[own, chosen], _shift_per_slip(pairing, side))
        for (pairing, own), chosen in ranges
    )
    return WornProfiles(tuple(each))


def _shift_per_slip(pairing: Pairing, side: int) -> float:
    share = float(pairing.weights @ pairing.share / pairing.weights.sum())
    return 1.0 - share if side == 0 else -share


def _profile(pairing: Pairing, weighted: np.ndarray, shift_per_slip: float) -> WornProfile:
    """Worn profile at one interface in a plane."""
    areas = weighted.sum(axis=0)
    return WornProfile((pairing.carrying.position @ weighted) / areas, areas, shift_per_slip)


@dataclass(frozen=True)
class SlipWear:
    """Wear of the bodies in one increment of a load history.

    Attributes
    ----------
    laws : tuple of Law
        Wear laws of the first, of the second faces or of both, independent of temperature and
        depth.
    profiles : tuple of WornProfiles or ProfilesAtPoints
        Worn profiles of the same faces.
    friction : float or ndarray, shape (m,)
        Coefficient of friction.
    duration : float
        Duration of the increment; no wear if it is 0 [s].
    repeats : int
        Number of such increments that it represents, one per cycle.
    edge : StickEdge, optional
        Without it coefficients wear as a whole.
    """

    laws: tuple[Law, ...]
    profiles: tuple[AnyProfiles, ...]
    friction: float | np.ndarray
    duration: float
    repeats: int = 1
    edge: StickEdge | None = None

    def depths_at_contact(self, worn: np.ndarray, travel: np.ndarray) -> np.ndarray:
        """Worn depths at the contact from the profiles, (n_wearing, m_Ψ) to (n_wearing, m) [m]."""
        pairs = zip(worn, self.profiles, strict=True)
        return np.array([profile.interpolation(travel) @ own for own, profile in pairs])

    def depths(self, pressure: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Depths worn off the bodies at the contact, shape (n_wearing, m) [m].

        Parameters
        ----------
        pressure : ndarray, shape (m,)
            λ at the end of the increment [Pa].
        slip : ndarray, shape (m,)
            Magnitude of the weighted mean slip of the increment [m].
        """
        return self._each(pressure, slip, [law.value for law in self.laws])

    def slopes(self, pressure: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Derivatives of `depths` with respect to the pressure, shape (n_wearing, m) [m/Pa]."""
        return self._each(pressure, slip, [law.slope for law in self.laws])

    def _each(self, pressure, slip, functions) -> np.ndarray:
        if self.duration == 0.0:
            return np.zeros((len(self.laws), len(pressure)))
        speed, time = slip / self.duration, self.repeats * self.duration
        state = LocalState(pressure, speed, mu=self.friction)
        values = [time * of_law(state) for of_law in functions]
        return np.reshape(values, (-1, len(pressure)))

    def halved(self) -> SlipWear:
        """Wear of half the increment."""
        return replace(self, duration=self.duration / 2)


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
