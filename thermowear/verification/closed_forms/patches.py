"""Special cases of Páczelt and Mróz as contact patches, built from their geometry.

No formula for a pressure is used: the principle gets points, normals, sliding directions and
free motions of the holder only; the closed forms provide just the dimensions. Faces are integrated
by Gauss's rule; points of interest are added with zero area.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from ...laws import PowerWear, rotation, translation
from ...laws.principle.patch import ContactPatch, contact_patch
from ...laws.principle.steady import SteadyWear
from ...reference.rigid_faces import ArcBlock, DrumBrakeShoe, LeverBlock
from ..check import Check, compare, compare_worst

CLOSED_FORM = "Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, closed form"
EXPONENTS, MPA = (0.5, 1.0, 2.0), 1e6
DOWN = (0.0, 0.0, -1.0)
POINTS = 40


@dataclass(frozen=True)
class SpecialCase:
    """Contact patch with its load and wear laws.

    Attributes
    ----------
    patch : ContactPatch
    load : ndarray, shape (k,)
        Load along each motion [N or N m].
    laws : tuple of PowerWear
    """

    patch: ContactPatch
    load: np.ndarray
    laws: tuple[PowerWear, ...]

    def steady(self) -> SteadyWear:
        """Steady state, by the generic solver."""
        return self.patch.steady(self.load, self.laws)


def wear_law(b: float, a: float = 1.0) -> PowerWear:
    """Wear law with realistic rates for pressures of some MPa."""
    return PowerWear(1e-13 * 1e6 ** (1 - b), b, a)


def along(
    start: float, end: float, probes: Sequence[float] | np.ndarray = (), split: Sequence[float] = ()
) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights on an interval, piecewise, and probes with weight 0."""
    x, w = np.polynomial.legendre.leggauss(POINTS)
    parts = list(pairwise([start, *split, end]))
    points = [(low + high) / 2 + (high - low) / 2 * x for low, high in parts]
    weights = [(high - low) / 2 * w for low, high in parts]
    return np.concatenate([*points, probes]), np.concatenate([*weights, np.zeros(len(probes))])


def punch(b: float, force: float, length: float, width: float, speed: float) -> SpecialCase:
    """Case 1: flat punch that translates."""
    x, w = along(0.0, length)
    points = np.column_stack([x, 0 * x, 0 * x])
    patch = contact_patch(points, w * width, DOWN, [translation(DOWN)], speed)
    return SpecialCase(patch, np.array([force]), (wear_law(b),))


def tilting_punch(b: float, probes: Sequence[float] = ()) -> SpecialCase:
    """Case 2: 60 x 80 mm, 10 kN at (25, 40) mm, moments about the corner."""
    length, width, force, speed = 0.06, 0.08, 10e3, 5e-3
    x, w = along(0.0, length, probes)
    y, v = along(0.0, width)
    points = np.array([(p, q, 0.0) for q in y for p in x])
    corner = (0.0, 0.0, 0.0)
    motions = [translation(DOWN), rotation((-1, 0, 0), corner), rotation((0, 1, 0), corner)]
    patch = contact_patch(points, np.outer(v, w).ravel(), DOWN, motions, speed)
    return SpecialCase(patch, np.array([force, 0.04 * force, 0.025 * force]), (wear_law(b),))


def block_on_disk(
    face: ArcBlock, force: float, probes: Sequence[float] = (), side: int = -1
) -> SpecialCase:
    """Case 3: block above a disk; with positive friction the disk rotates anticlockwise.

    With its normal upwards (`side` +1) it is a segment inside a ring, see `ring_segment`.
    """
    α, w = along(face.start, face.end, probes)
    outward = np.column_stack([np.sin(α), np.cos(α)])  # outward normal of the disk
    clockwise = np.column_stack([np.cos(α), -np.sin(α)])
    patch = contact_patch(
        face.radius * outward,
        w * face.radius * face.width,
        side * outward,
        [translation((0.0, side))],
        speed=0.3,
        friction=abs(face.friction),
        sliding=-side * np.copysign(1, face.friction) * clockwise,
    )
    return SpecialCase(patch, np.array([force]), (wear_law(face.b),))


ring_segment = partial(block_on_disk, side=1)
"""Case 4: segment inside a ring; with positive friction the ring rotates clockwise."""


def brake_block(face: LeverBlock, moment: float, probes: Sequence[float] = ()) -> SpecialCase:
    """Case 5: block on a lever; with positive friction the strip moves away from the pivot."""
    z, w = along(face.inner, face.outer, probes)
    patch = contact_patch(
        np.column_stack([np.full_like(z, face.offset), 0 * z, z]),
        w * face.width,
        (1.0, 0.0, 0.0),
        [rotation((0.0, 1.0, 0.0), (0.0, 0.0, 0.0))],
        speed=2.0,
        friction=abs(face.friction),
        sliding=(0.0, 0.0, -np.copysign(1, face.friction)),
    )
    return SpecialCase(patch, np.array([moment]), (wear_law(face.b),))


def tilting_block(
    b: float,
    sense: int,
    force: float,
    moment: float,
    ends: tuple[float, float],
    joint: float,
    height: float,
    width: float,
    friction: float,
    split: Sequence[float] = (),
) -> SpecialCase:
    """Case 6: block that moves along x and rotates about a joint at ``z = joint``.

    The joint lies `height` behind the face; `split` are ends of the contact, where the quadrature
    is subdivided.
    """
    z, w = along(*ends, split=split)
    patch = contact_patch(
        np.column_stack([np.full_like(z, height), 0 * z, z]),
        w * width,
        (1.0, 0.0, 0.0),
        [translation((1.0, 0.0, 0.0)), rotation((0.0, 1.0, 0.0), (0.0, 0.0, joint))],
        speed=2.0,
        friction=friction,
        sliding=(0.0, 0.0, -sense),
    )
    return SpecialCase(patch, np.array([force, moment]), (wear_law(b),))


def drum_brake(face: DrumBrakeShoe, moment: float, probes: Sequence[float] = ()) -> SpecialCase:
    """Case 7: shoe inside a drum; trailing with positive friction, as the drum turns."""
    θ, w = along(face.start, face.end, probes)
    outward = np.column_stack([np.cos(θ), np.sin(θ)])
    clockwise = np.column_stack([np.sin(θ), -np.cos(θ)])
    patch = contact_patch(
        face.radius * outward,
        w * face.radius * face.width,
        outward,
        [rotation((0.0, 0.0, -1.0), (face.pivot_distance, 0.0))],
        speed=3.0,
        friction=abs(face.friction),
        sliding=np.copysign(1, face.friction) * clockwise,
    )
    return SpecialCase(patch, np.array([moment]), (wear_law(face.b),))


def annular_punch(
    b: float,
    a: float,
    force: float,
    radius: np.ndarray,
    area: np.ndarray,
    angle: np.ndarray | float = np.pi / 2,
    friction: float = 0.0,
    transverse_friction: float = 0.0,
) -> SpecialCase:
    """Case 8: ring that rotates about its axis, on a face with any meridian.

    Parameters
    ----------
    b, a, force
    radius, area : ndarray, shape (n,)
        Radii of the points, and area of the face around the axis per point.
    angle : float or ndarray
        α between the face's normal and the radius.
    friction, transverse_friction : float
        Circumferential, and along the meridian.
    """
    α = np.broadcast_to(angle, radius.shape)
    zero = np.zeros_like(radius)
    patch = contact_patch(
        np.column_stack([radius, zero, zero]),
        area,
        np.column_stack([np.cos(α), zero, -np.sin(α)]),
        [translation(DOWN)],
        speed=10.0 * radius,
        friction=friction,
        sliding=(0.0, 1.0, 0.0),
        transverse_friction=transverse_friction,
        transverse=np.column_stack([-np.sin(α), zero, -np.cos(α)]),
    )
    return SpecialCase(patch, np.array([force]), (wear_law(b, a),))


def disk_brake(
    b: float,
    a: float,
    force: float,
    radii: tuple[float, float],
    angle: float,
    centre: tuple[float, float] | None = None,
    friction: float = 0.0,
    height: float = 0.0,
) -> SpecialCase:
    """Case 9: pad on a disk that rotates clockwise; it may tilt if a centre of load is given.

    The joint about which it tilts lies `height` above the centre of the disk.
    """
    r, w = along(*radii)
    φ, v = along(-angle / 2, angle / 2)
    area = np.outer(v, w * r).ravel()
    r, φ = np.tile(r, len(φ)), np.repeat(φ, len(r))
    zero = np.zeros_like(r)
    motions, load = [translation(DOWN)], [force]
    if centre is not None:
        joint = (0.0, 0.0, height)
        motions += [rotation((-1.0, 0.0, 0.0), joint), rotation((0.0, 1.0, 0.0), joint)]
        load += [force * centre[1], force * centre[0]]
    patch = contact_patch(
        np.column_stack([r * np.cos(φ), r * np.sin(φ), zero]),
        area,
        DOWN,
        motions,
        speed=10.0 * r,
        friction=friction,
        sliding=np.column_stack([-np.sin(φ), np.cos(φ), zero]),
    )
    return SpecialCase(patch, np.array(load), (wear_law(b, a),))


def worst(quantity: str, computed, exact, allowed: float = 1e-9) -> Check:
    """Compare values at points with a formula, at the point of largest deviation."""
    quantity = f"{quantity}, at the point of largest deviation"
    return compare_worst(quantity, computed, exact, allowed, CLOSED_FORM)


def dissipation(case: SpecialCase, name: str) -> Check:
    """Compare ``D_w = ∫ p·w' dS`` with the power of the load, ``F·V``."""
    steady = case.steady()
    quantity = f"wear dissipation power{name} [W]"
    power = float(case.load @ steady.velocity)
    return compare(quantity, steady.dissipation, power, 1e-9, "D_w = F·V")
