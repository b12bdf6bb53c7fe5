"""Results of the search for hot spots: critical speeds by number, growth, and the first mode."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .quantity import as_in, column, table


@table(
    "hot_spots",
    "Hot spots, one row per number and symmetry",
    "stability with `hot_spots`: one row per number of hot spots and symmetry of the mode, with "
    "its critical speed, without and with wear",
    grows=True,
)
class HotSpotRow:
    """First mode of a number of hot spots along the sliding direction to grow with the speed.

    Values are NaN where no mode grows at any speed. The best conductor is the body in contact of
    the largest conductivity.
    """

    number: int = column("number of hot spots", meaning="round the axis, or of the wave length")
    wave_number: float = column("wave number", "1/m", meaning="at the mean radius of the contacts")
    symmetry: int = column(
        "symmetry", meaning="1 symmetric, -1 antisymmetric about the mirror plane, 0 without one"
    )
    speed_factor: float = column("critical speed factor", meaning="of the given speed")
    frequency: float = column("angular frequency", "rad/s", meaning="on the best conductor")
    drift: float = column(
        "drift", "m/s", "mm/s", "velocity of the mode along the sliding on the best conductor"
    )
    speed_factor_with_wear: float = column(
        "critical speed factor with wear", meaning="of the given speed"
    )
    frequency_with_wear: float = column(
        "angular frequency with wear", "rad/s", meaning="on the best conductor"
    )


@table(
    "growth",
    "Growth of the first hot spots, one row per speed",
    "stability with `hot_spots`: one row per speed with the growth rate of the first hot spots",
    grows=True,
)
class GrowthRow:
    """Mode of the first hot spots at a speed; NaN where it could not be followed."""

    speed_factor: float = column("speed factor", meaning="of the given speed")
    growth_rate: float = column("growth rate", "1/s")
    frequency: float = as_in(HotSpotRow)
    growth_rate_with_wear: float = column("growth rate with wear", "1/s")
    frequency_with_wear: float = as_in(HotSpotRow)


@dataclass(frozen=True)
class HotSpotFields:
    """Complex amplitudes of a mode on a fine grid of points in each cell of a section.

    Attributes
    ----------
    points : ndarray, shape (n_cells, n_points, 2) [m]
    pieces : ndarray of int, shape (n_pieces, n_corners)
        Small triangles or quadrilaterals between the points of one cell.
    body : ndarray of int, shape (n_cells,)
        Number of the body, from 1.
    temperature : ndarray, shape (n_cells, n_points)
        Complex; the largest magnitude is 1.
    displacement : ndarray, shape (n_cells, n_points, 3)
        Complex, per unit of the largest temperature: in the section, and along the wave [m/K].
    """

    points: np.ndarray
    pieces: np.ndarray
    body: np.ndarray
    temperature: np.ndarray
    displacement: np.ndarray


@dataclass(frozen=True)
class HotSpotMode:
    """Mode of the first hot spots at its critical speed, ``Re(field exp(i m s))`` along s.

    Attributes
    ----------
    number : float
        Number of hot spots round the axis, or the wave number along a prism [1/m].
    is_ring : bool
        True round an axis.
    symmetry : int
        See `HotSpotRow`.
    mirror : tuple of (int, float) or None
        Coordinate that is constant on the mirror plane, and its value [m].
    speed_factor : float
    conductor : int
        Number of the best conductor, from 1, on which the mode hardly moves.
    blocks : tuple of HotSpotFields
        By type of the cells.
    """

    number: float
    is_ring: bool
    symmetry: int
    mirror: tuple[int, float] | None
    speed_factor: float
    conductor: int
    blocks: tuple[HotSpotFields, ...]
