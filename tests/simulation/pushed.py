"""Cylinders of steel that are pressed together and pushed: cases, and references for them."""

import numpy as np

import thermowear as tw
from thermowear.reference.elastic_contact.hertz import MindlinLine, contact_modulus

from .boundary_elements import Contact, Material, block, half_cylinder

R = 100e-3
STEEL = Material(200e9, 0.3)
MODULUS = contact_modulus((200e9, 0.3), (200e9, 0.3))
FRICTION = 0.6


def law(ratio: float, radius: float) -> MindlinLine:
    """A contact of a half-width of so many R; the relative radius is given [m]."""
    force = np.pi * MODULUS * (ratio * R) ** 2 / (4 * radius)
    return MindlinLine(force, radius, MODULUS, FRICTION)


def pushed(tables: dict, exact: MindlinLine, part: float, increments: int):
    """The last state of bodies that are pressed, then pushed by a part of what friction holds."""
    push = f"{part * exact.limit * 1e-3!r} N"
    tables["load"] = {
        "force": f"{exact.force * 1e-3!r} N",
        "history": {"time": ["0 s", "1 s"], "tangential_force": ["0 N", push]},
    }
    tables["contact"] = {"friction": FRICTION}
    tables["analysis"] = {"type": "fretting", "increments": increments}
    return tw.run(tw.load(tables)).friction.last


def on_flat(size: tuple[float, float], elements: int, degree: int = 4, **changes) -> dict:
    """A half cylinder on a block of a width and height, in radii."""
    steel = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}
    width, height = (f"{part * R!r} m" for part in size)
    geometry = {"block_width": width, "block_height": height, "thickness": "1 mm"}
    return {
        "title": "cylinder on flat",
        "model": "plane-strain",
        "geometry": {"type": "cylinder-on-block", "radius": f"{R!r} m"} | geometry,
        "bodies": {"cylinder": steel, "block": steel},
        "mesh": {"degree": degree, "elements": elements, "grading": 0.5},
    } | changes


def by_boundary_elements(
    ratio: float, count: int, friction: float, size: tuple[float, float] = (4.0, 2.0)
) -> Contact:
    """A half cylinder on a block of a width and height in radii, not loaded."""
    reach, (width, height) = 1.15 * ratio * R, size
    below = block(width * R, height * R, reach, count, STEEL)
    bodies = half_cylinder(R, reach, count, STEEL), below
    return Contact(*bodies, friction)


def known(ratio: float, count: int, part: float, size: tuple[float, float] = (4.0, 2.0)) -> Contact:
    """The state of `pushed` by boundary elements."""
    contact, exact = by_boundary_elements(ratio, count, FRICTION, size), law(ratio, R)
    for step in range(1, 41):  # the half-width grows evenly
        contact.load(exact.force * (step / 40) ** 2, 0.0)
    for step in range(1, 21):
        contact.load(exact.force, step / 20 * part * exact.limit)
    return contact


def centres(state) -> tuple[float, float]:
    """Middles of the contact and of the zone that sticks, pushed to the right [m]."""
    stuck = FRICTION * state.pressure + state.shear
    return _centre(state.x, state.pressure), _centre(state.x, stuck)


def _centre(x: np.ndarray, traction: np.ndarray) -> float:
    """Middle of an ellipse, fitted where there is more than a third of its peak."""
    inner = traction > 0.3 * traction.max()
    c, b, _ = np.polyfit(x[inner], traction[inner] ** 2, 2)
    return -b / (2 * c)
