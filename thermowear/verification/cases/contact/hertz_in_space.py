"""Sphere on a flat and crossed cylinders in space, from mesh files of tetrahedra, against Hertz.

The half-axes are those of the ellipsoid of Hertz with the second moments of the computed pressure,
``∫ p x² dA = F a²/5``: all pressures contribute and none is selected. The peak is the largest
pressure at a contact point. The bodies are so large that half-spaces are the reference: the peak of
the sphere is 0.05 % lower (Lur'e); that of the cylinders over the closed form changes by no more
than the 0.1 % of different meshes under 64 times the force, with a contact four times as wide.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from math import sqrt
from pathlib import Path

import numpy as np

from ....case import load
from ....reference.elastic_contact.hertz import (
    EllipticalContact,
    elliptical_contact,
    sphere_on_half_space,
)
from ....results import Result
from ...check import Check, compare, computed
from ...quarter_meshes import (
    NAMES,
    MeshSizes,
    QuarterPair,
    crossed_cylinders,
    sphere_on_block,
    write_pair,
)
from .hertz import JOHNSON, LURE, MODULUS, STEEL

FORCE = 250.0
"""Force on whole bodies [N]."""
BALL, BLOCK = 10.0, 12.0
"""Radius of the sphere, and radius and depth of the block [mm]."""
CYLINDERS = 10.0, 25.0
"""Radii of the upper and the lower cylinder [mm]."""
COARSE, FINE = (0.2, 0.1), (0.1, 0.05)
"""Element sizes in the contact and at its edge, by its smaller half-axis."""


def hertz_sphere_3d() -> Iterator[Check]:
    """Quarter of a sphere on a block, coarse mesh."""
    yield from _sphere(COARSE, 1e-2)


def hertz_sphere_3d_fine() -> Iterator[Check]:
    """Quarter of a sphere on a block, fine mesh."""
    yield from _sphere(FINE, 3e-3)


def hertz_elliptical() -> Iterator[Check]:
    """Quarter of two cylinders of different radii that cross at right angles."""
    exact = elliptical_contact(FORCE, (CYLINDERS[0] * 1e-3, CYLINDERS[1] * 1e-3), MODULUS)
    yield from _against(exact, pressed(crossed_cylinders(*CYLINDERS), exact, COARSE), 1e-2)


def _sphere(sizes: tuple[float, float], allowed: float) -> Iterator[Check]:
    radius = BALL * 1e-3
    exact = elliptical_contact(FORCE, (radius, radius), MODULUS)
    result = pressed(sphere_on_block(BALL, BLOCK), exact, sizes)
    yield from _against(exact, result, allowed)
    finite = sphere_on_half_space(FORCE, radius, STEEL, STEEL).peak
    peak = result.summary["max_pressure_Pa"]
    yield compare("peak pressure of a sphere of finite size [Pa]", peak, finite, allowed, LURE)
    resolved = pressed(sphere_on_block(BALL, BLOCK), exact, sizes, method="pointwise")
    yield from _against(exact, resolved, allowed, ", contact at each point")


def pressed(
    pair: QuarterPair, exact: EllipticalContact, sizes: tuple[float, float], **contact
) -> Result:
    """Contact of two bodies meshed for the expected contact.

    Parameters
    ----------
    pair : QuarterPair
    exact : EllipticalContact
    sizes : tuple of float
        Element sizes in the contact and at its edge, by its smaller half-axis.
    **contact
        Keys of the table ``contact``.
    """
    a, b = (1e3 * axis for axis in exact.half_axes)
    with tempfile.TemporaryDirectory() as folder:
        path = write_pair(Path(folder, "pair.msh"), pair, MeshSizes((a, b), *sizes))
        young, poisson = STEEL
        steel = {"young_modulus": f"{young} Pa", "poisson_ratio": poisson}
        tables = {
            "title": "Hertz's contact in space",
            "model": "3d",
            "geometry": {"type": "file", "path": str(path)} | NAMES,
            "mesh": {"degree": 2},
            "bodies": {"upper": steel, "lower": {"like": "upper"}},
            "load": {"force": f"{FORCE / 4} N"},
            "contact": contact,
            "analysis": {"type": "initial"},
        }
        return computed(load(tables))


def _against(
    exact: EllipticalContact, result: Result, allowed: float, note: str = ""
) -> Iterator[Check]:
    """Peak pressures, and half-axes along x and y by second and fourth moments."""
    i, peak = result.interface, result.summary["max_pressure_Pa"]
    force = np.sum(i.weight * i.pressure)
    part = i.weight * i.pressure / force
    yield compare(f"peak pressure{note} [Pa]", peak, exact.peak, allowed, JOHNSON)
    found, quantity = 4 / 3 * np.sum(part * i.pressure), "peak pressure by the mean square"
    yield compare(f"{quantity}{note} [Pa]", found, exact.peak, allowed, JOHNSON)
    for axis, x, known in zip("xy", (i.x, i.y), exact.half_axes, strict=True):
        second, fourth = sqrt(5 * np.sum(part * x**2)), (35 / 3 * np.sum(part * x**4)) ** 0.25
        yield compare(f"half-axis along {axis}{note} [m]", second, known, allowed, JOHNSON)
        quantity = f"half-axis along {axis} by the fourth moment{note} [m]"
        yield compare(quantity, fourth, known, allowed, JOHNSON)
