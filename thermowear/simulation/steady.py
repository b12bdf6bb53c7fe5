"""The steady state, directly from the principle of minimum wear dissipation power."""

from __future__ import annotations

from ..laws import SteadyWear, steady_pressure
from .system import System


def steady_wear(system: System) -> SteadyWear:
    """Steady pressure, wear rates and rigid-body wear velocity of a system."""
    return steady_pressure(
        weights=system.weights,
        normal_modes=system.holder.modes,
        force_modes=system.holder.force_modes,
        load=system.holder.load,
        laws=list(system.laws.values()),
        speed=system.speed,
    )
