"""Pin that reciprocates on a block in space, against its steady state.

Its face has arched ends, so that it is longer along the stroke in the middle than at the sides. The
block has other elements. Half of both is meshed.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .... import geometry  # noqa: F401  (makes the geometries known)
from ....case import load
from ....geometry.mesh.tagged import TaggedMesh, compact
from ....geometry.meshing.cells import level, mesh_lattice, tagged_bodies
from ....geometry.reading.export import write_mesh
from ....results import Result
from ...check import Check, compare, computed

HALF, HEIGHTS = 4e-3, np.array([0.0, 2.5e-3, 1e-2])
"""Half the largest length of the pin, which is the breadth of the model; heights of rows [m]."""
AMPLITUDE, FREQUENCY, FORCE, COEFFICIENT = 5e-3, 2.0, 1000.0, 1e-13
SPEED = 4 * AMPLITUDE * FREQUENCY
SLIDING = "k F times the sliding distance"
END = "uniform closing of the gap, see `reciprocating_problem`"
_INNER = 0.8
"""Part of the lines along the stroke that is compared point by point."""


def reciprocating_3d() -> Iterator[Check]:
    """Worn volumes, and rates of both faces at the end."""
    result = _worn()
    known = COEFFICIENT * FORCE * SPEED * result.summary["time_s"]
    for body in (1, 2):
        found = result.summary[f"wear_volume_{body}_m3"]
        yield compare(f"worn volume, body {body} [m³]", found, known, 1e-9, SLIDING)
    assert result.track is not None
    i, track = result.interface, result.track.last
    inner = (np.abs(i.x) < _INNER * length(i.y) / 2) & (i.y < 0.9 * HALF)
    at = "at the point of largest deviation"
    found, known = i.wear_rate_1[inner], steady_rates(i.y[inner])[0]
    yield _worst(f"wear rate of the pin {at} [m/s]", found, known, 2e-2)
    inner = np.abs(track.x) < _INNER * (length(track.y) / 2 + AMPLITUDE)
    inner &= track.y < HALF * (1 - 1e-9)  # the side is a corner of both bodies
    found, known = track.wear_rate_2[inner], steady_rates(track.y[inner])[1]
    yield _worst(f"wear rate of the block {at} [m/s]", found, known, 8e-2)
    for y in np.unique(track.y)[:-1]:
        on = track.y == y
        mean = float(np.average(track.wear_rate_2[on], weights=track.weight[on]))
        quantity = f"mean wear rate of the block along y = {1e3 * y:.3g} mm [m/s]"
        yield compare(quantity, mean, float(steady_rates(y)[1]), 1e-2, END)


def length(y):
    """Length of the pin along the stroke, ``2 h (1 - y²/2h²)`` [m]."""
    return 2 * HALF * (1 - (y / HALF) ** 2 / 2)


def steady_rates(y) -> tuple[np.ndarray, np.ndarray]:
    """Wear rates of pin and block on lines along the stroke at the end [m/s]."""
    points, weights = np.polynomial.legendre.leggauss(20)
    on_1, on_2 = _per_length(HALF / 2 * (points + 1))
    closing = COEFFICIENT * FORCE * SPEED / (HALF / 2 * weights @ (1 / (on_1 + on_2)))
    on_1, on_2 = _per_length(y)
    return closing * on_1 / (on_1 + on_2), closing * on_2 / (on_1 + on_2)


def _per_length(y) -> tuple[np.ndarray, np.ndarray]:
    """Inverse lengths of the pin and of its track on lines along the stroke [1/m]."""
    return 1 / length(y), 1 / (length(y) + 2 * AMPLITUDE)


def arched_pin(elements: int, across: int) -> TaggedMesh:
    """Mesh of the halves ``pin`` and ``block``, of hexahedra of order 2, exact for the pin.

    Parameters
    ----------
    elements : int
        Number along the pin.
    across : int
        Number along the block.
    """

    def arched(p):
        x, y, z = np.moveaxis(p, -1, 0)
        return np.stack([x * length(y) / (2 * HALF), y, z], axis=-1)

    reach = HALF + 1.2 * AMPLITUDE
    breadth = np.linspace(0.0, HALF, elements // 2 + 1)
    pin = mesh_lattice((np.linspace(-HALF, HALF, elements + 1), breadth, HEIGHTS), 2, arched)
    lattice = np.linspace(-reach, reach, across + 1), np.linspace(0.0, 1.5 * HALF, across // 3 + 1)
    bodies = {"pin": pin, "block": mesh_lattice((*lattice, -HEIGHTS[::-1]), 2)}
    levels = {f"{name}_middle": level(1, 0.0) for name in bodies}
    for name, end in (("pin", HEIGHTS[-1]), ("block", -HEIGHTS[-1])):
        levels |= {f"{name}_face": level(2, 0.0), f"{name}_end": level(2, end)}
    return tagged_bodies(bodies, levels)


def _worn() -> Result:
    """Run until the rates are nearly steady."""
    steel = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}
    law = {"coefficient": f"{COEFFICIENT!r} 1/Pa", "per": "pressure"}
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "pin.msh"
        write_mesh(compact(arched_pin(8, 21)), path)
        tables = {
            "title": "Pin that reciprocates on a block",
            "model": "3d",
            "geometry": {
                "type": "file",
                "path": str(path),
                "bodies": {"pin": "pin", "block": "block"},
                "contact": ["pin_face", "block_face"],
                "held": "pin_end",
                "fixed": "block_end",
                "rollers": ["pin_middle", "block_middle"],
            },
            "mesh": {"degree": 2},
            "bodies": {"pin": steel, "block": {"like": "pin"}},
            "load": {"force": f"{FORCE!r} N"},
            "motion": {"amplitude": f"{AMPLITUDE!r} m", "frequency": f"{FREQUENCY!r} Hz"},
            "wear": {"pin": law, "block": law},
            "analysis": {
                "type": "reciprocating",
                "until": "steady",
                "steady_tolerance": 0.1,
                "positions": 12,
            },
        }
        return computed(load(tables))


def _worst(quantity: str, found: np.ndarray, known: np.ndarray, allowed: float) -> Check:
    """Comparison at the point of the largest relative deviation."""
    at = int(np.abs(found / known - 1.0).argmax())
    return compare(quantity, float(found[at]), float(known[at]), allowed, END)
