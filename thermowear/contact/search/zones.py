"""Contact zones: ends of the zones with subelement accuracy."""

from __future__ import annotations

import numpy as np

from .pairing import Pairing
from .surface import Surface

_ZERO_PRESSURE = 1e-9  # of the largest pressure
_FIT_FRACTION = 0.8  # fraction of half a zone used to fit its edge
_DEGREE = 2
_SKIPPED_ELEMENTS = 2  # number of elements next to the edge


def contact_zones(pairing: Pairing, pressure: np.ndarray) -> list[tuple[float, float]]:
    """Ranges of the position s of the contact zones, in order [m]; empty on a surface.

    At the edge of contact of smooth faces the pressure vanishes as the square root of the distance
    times an analytic function (Johnson, Contact Mechanics, 1985, ch. 4). The squared pressure is
    fitted by a polynomial, without the elements next to the edge, and extrapolated to its zero.
    Zones of few elements end with their last point.

    Parameters
    ----------
    pairing : Pairing
    pressure : ndarray, shape (n,) [Pa]
    """
    if isinstance(pairing.sides[0].face, Surface):
        return []
    pressing = pressure > _ZERO_PRESSURE * pressure.max(initial=0.0)
    change = np.flatnonzero(np.diff(pressing.astype(int), prepend=0, append=0))
    zones = []
    for first, after in change.reshape(-1, 2):
        zone = np.arange(first, after)
        bounded = (first == 0) + (after == len(pressure))
        part = 0.5 if bounded == 0 else 1.0  # fraction of the zone that belongs to an edge
        start, end = pairing.position[zone[[0, -1]]]
        if first > 0:
            start = _edge(pairing, pressure, zone[::-1], part)
        if after < len(pressure):
            end = _edge(pairing, pressure, zone, part)
        zones.append((float(start), float(end)))
    return zones


def _edge(pairing: Pairing, pressure: np.ndarray, zone: np.ndarray, part: float) -> float:
    """Position of the edge beyond the last point of a zone."""
    s, facet = pairing.position[zone], pairing.sides[0].facet[zone]
    distance = np.abs(s - s[-1])
    last = np.unique(np.abs(facet - facet[-1]))[:_SKIPPED_ELEMENTS]
    chosen = ~np.isin(np.abs(facet - facet[-1]), last)
    chosen &= distance <= _FIT_FRACTION * part * distance[0]
    if chosen.sum() <= 2 * _DEGREE:
        return float(s[-1])
    fit = np.polynomial.Polynomial.fit(distance[chosen], pressure[zone][chosen] ** 2, _DEGREE)
    roots = fit.roots()
    nearest = distance[chosen].min()
    roots = roots[np.abs(roots.imag) < 1e-9].real
    roots = roots[(roots < nearest) & (roots > -nearest)]
    if len(roots) == 0:
        return float(s[-1])
    return float(s[-1] + np.sign(s[0] - s[-1]) * roots.max())
