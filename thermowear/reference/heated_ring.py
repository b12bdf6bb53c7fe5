"""Free ring with a uniform axial temperature gradient: rotation of its cross-section (coning).

A temperature ``T = G z`` that is linear in space causes no stress in a free body (Boley and Weiner,
Theory of Thermal Stresses, 1960, section 3.9). With all normal strains ``alpha G z`` and no shear,

    u_r = alpha G r z,   u_z = alpha G (z² - r²) / 2,

so that a face ``z = const`` becomes a paraboloid, of slope ``-alpha G r``. In the mean over its
width this is the ring formula: a difference of temperature ``G h`` across the height h turns the
section by ``alpha (G h) r_m / h`` at the mean radius r_m.

In the steady state of uniform wear ``p r`` is constant, so that the friction heat ``mu p v`` of a
turning ring is uniform; with insulated sides it crosses both rings axially.
"""

from __future__ import annotations

from math import pi

import numpy as np


def face_deflection(radius, expansion: float, gradient: float) -> np.ndarray:
    """Axial displacement ``-alpha G r² / 2`` of a face, up to a constant [m]."""
    return -expansion * gradient * np.square(radius) / 2


def rotation(inner: float, outer: float, expansion: float, gradient: float) -> float:
    """Mean slope of a face, ``-alpha G r_m`` [rad]."""
    return -expansion * gradient * (inner + outer) / 2


def steady_heat(inner: float, outer: float, friction: float, force: float, speed: float) -> float:
    """Friction heat ``mu F omega / (2 pi (r_o - r_i))`` of uniform wear per area [W/m²]."""
    return friction * force * speed / (2 * pi * (outer - inner))
