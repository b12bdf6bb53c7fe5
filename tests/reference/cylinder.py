"""Thick-walled cylinder under internal pressure in plane strain (Lamé)."""

from __future__ import annotations


def radial_displacement(
    r, inner: float, outer: float, pressure: float, young_modulus: float, poisson_ratio: float
):
    """Radial displacement in plane strain (Timoshenko and Goodier, Theory of Elasticity, §28) [m].

    Parameters
    ----------
    r : array_like [m]
    inner, outer : float
        Inner and outer radius [m].
    pressure : float
        Pressure on the inner surface [Pa].
    young_modulus, poisson_ratio : float
    """
    E, ν = young_modulus, poisson_ratio
    scale = (1 + ν) * pressure * inner**2 / (E * (outer**2 - inner**2))
    return scale * ((1 - 2 * ν) * r + outer**2 / r)
