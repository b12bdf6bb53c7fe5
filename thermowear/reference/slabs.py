"""Two slabs in contact with friction heat between them."""

from __future__ import annotations

from math import inf


def contact_temperatures(
    lengths: tuple[float, float],
    conductivities: tuple[float, float],
    ends: tuple[float, float],
    friction_heat: float,
    partition: float,
    conductance: float,
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Temperatures and heat fluxes at the contact of two slabs held at given temperatures.

    From the series of resistances ``R_i = L_i/k_i`` and the conductance of the contact (Carslaw and
    Jaeger, Conduction of Heat in Solids, 1959, section 3.2).

    Parameters
    ----------
    lengths, conductivities, ends : tuple of float
        For each slab: length [m], conductivity [W/(m K)], temperature at the far end.
    friction_heat : float
        Friction heat [W/m²].
    partition : float
        Fraction of it released on slab 1.
    conductance : float
        Contact conductance [W/(m² K)]; may be 0 or infinite.

    Returns
    -------
    temperatures, fluxes : tuple of float
        Temperatures of the faces, and fluxes into each slab [W/m²].
    """
    R1, R2 = (length / k for length, k in zip(lengths, conductivities, strict=True))
    T1, T2 = ends
    drive = T2 - T1 + friction_heat * ((1 - partition) * R2 - partition * R1)
    through = (
        drive / (R1 + R2)
        if conductance == inf
        else conductance * drive / (1 + conductance * (R1 + R2))
    )
    q1 = partition * friction_heat + through
    q2 = (1 - partition) * friction_heat - through
    return (T1 + q1 * R1, T2 + q2 * R2), (q1, q2)


def harmonic_mean(first: float, second: float) -> float:
    """Harmonic mean ``2 a b/(a + b)``."""
    return 2 * first * second / (first + second)


def conductance(
    coefficient: float,
    conductivities: tuple[float, float],
    hardnesses: tuple[float, float],
    pressure: float,
) -> float:
    """Contact conductance at a pressure [W/(m² K)].

    Heat is conducted through touching asperities, a fraction ``p/H`` of the face governed by the
    softer material. With harmonic means of conductivities and hardnesses,

        h = C k_h p/H_h,   k_h = 2 k1 k2/(k1 + k2),   H_h = 2 H1 H2/(H1 + H2),

    as in MOOSE (class GapFluxModelPressureDependentConduction of its heat transfer module) and,
    with another constant, in 4C.

    Parameters
    ----------
    coefficient : float
        C [1/m].
    conductivities, hardnesses : tuple of float
        k and H of both bodies [W/(m K), Pa].
    pressure : float [Pa]
    """
    return coefficient * harmonic_mean(*conductivities) * pressure / harmonic_mean(*hardnesses)
