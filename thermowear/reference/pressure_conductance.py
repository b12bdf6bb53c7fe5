"""Pressure-dependent contact conductance, and face temperatures of two blocks in contact.

Heat is conducted through touching asperities, a fraction ``p/H`` of the face governed by the softer
material. With harmonic means of conductivities and hardnesses,

    h = C k_h p/H_h,   k_h = 2 k1 k2/(k1 + k2),   H_h = 2 H1 H2/(H1 + H2),

as in MOOSE (class GapFluxModelPressureDependentConduction of its heat transfer module) and, with
another constant, in 4C.
"""

from __future__ import annotations

from .slabs import contact_temperatures


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

    Parameters
    ----------
    coefficient : float
        C [1/m].
    conductivities : tuple of float
        k of both bodies [W/(m K)].
    hardnesses : tuple of float
        H of both bodies [Pa].
    pressure : float [Pa]
    """
    return coefficient * harmonic_mean(*conductivities) * pressure / harmonic_mean(*hardnesses)


def block_temperatures(
    lengths: tuple[float, float],
    conductivities: tuple[float, float],
    hardnesses: tuple[float, float],
    ends: tuple[float, float],
    coefficient: float,
    pressure: float,
    friction_heat: float = 0.0,
    partition: float = 0.5,
) -> tuple[float, float]:
    """Temperatures of the faces of two blocks in contact.

    The far ends have prescribed temperatures, the sides are insulated; see `slabs` for resistances.

    Parameters
    ----------
    lengths, conductivities, hardnesses, ends : tuple of float
        For each block: length [m], conductivity [W/(m K)], hardness [Pa], temperature of its end.
    coefficient : float
        See `conductance` [1/m].
    pressure : float
        Contact pressure > 0 [Pa].
    friction_heat : float
        Friction heat [W/m²].
    partition : float
        Fraction of it released on block 1.
    """
    h = conductance(coefficient, conductivities, hardnesses, pressure)
    return contact_temperatures(lengths, conductivities, ends, friction_heat, partition, h)[0]
