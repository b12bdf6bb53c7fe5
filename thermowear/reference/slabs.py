"""Two slabs in contact with friction heat between them: one-dimensional conduction."""

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
