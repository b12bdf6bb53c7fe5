"""Independent reference for two curved bodies in contact: boundary elements, deformed faces.

A half cylinder on a block in plane strain. Both bodies are linearly elastic; their compliance comes
from boundary elements with constant values, whose integrals are closed (Kelvin's solution: Brebbia
and Dominguez, Boundary Elements, 1989, section 3.3). Nothing of the contact is linearised about the
unloaded faces: points meet that have the same arc length from the first point of contact, normals
and tangents are those of the faces as they are deformed, and slip is summed up by increments, so
that it begins where points touch. The errors fall with the size of an element.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

_GROWTH = 1.12
"""Ratio of elements beside the contact."""
_CYCLES = 60


@dataclass(frozen=True)
class Body:
    """Elements of a body that may be in contact, in the order of x.

    Attributes
    ----------
    points : ndarray, shape (n, 2) [m]
    lengths : ndarray, shape (n,) [m]
    compliance : ndarray, shape (2 n, 2 n)
        Displacements of the points by tractions on the elements, both as x, y, x, y … [m/Pa].
    """

    points: np.ndarray
    lengths: np.ndarray
    compliance: np.ndarray

    def moved(self, tractions: np.ndarray) -> np.ndarray:
        """Displacements by tractions, both of shape (n, 2)."""
        return (self.compliance @ tractions.ravel()).reshape(-1, 2)


@dataclass(frozen=True)
class Material:
    """Young's modulus [Pa] and Poisson's ratio."""

    young: float
    poisson: float

    @property
    def shear(self) -> float:
        """G [Pa]."""
        return self.young / (2 * (1 + self.poisson))


def half_cylinder(radius: float, reach: float, count: int, material: Material) -> Body:
    """Lower half of a cylinder that touches the origin from above, its flat top clamped.

    So many equal elements cover arc lengths from -reach to reach, where it may touch.
    """
    s = _ends(reach, count, pi / 2 * radius, radius / 25)
    arc = np.column_stack([radius * np.sin(s / radius), radius * (1 - np.cos(s / radius))])
    x = np.linspace(radius, -radius, 80)[1:]
    corners = np.vstack([arc, np.column_stack([x, np.full(len(x), radius)])])
    touching = (len(s) - 1 - count) // 2 + np.arange(count)
    clamped = np.arange(len(s) - 1, len(corners) - 1)
    return _body(corners, touching, clamped, material)


def block(width: float, height: float, reach: float, count: int, material: Material) -> Body:
    """Block below ``y = 0``, its bottom clamped; elements as in `half_cylinder`."""
    x = _ends(reach, count, width / 2, width / 100)[::-1]
    y, along = np.linspace(0, -height, 51)[1:], np.linspace(-width / 2, width / 2, 101)[1:]
    corners = np.vstack(
        [
            np.column_stack([x, np.zeros_like(x)]),
            np.column_stack([np.full_like(y, -width / 2), y]),
            np.column_stack([along, np.full_like(along, -height)]),
            np.column_stack([np.full_like(y, width / 2), np.append(y[-2::-1], 0.0)]),
        ]
    )
    touching = ((len(x) - 1 - count) // 2 + np.arange(count))[::-1]
    clamped = len(x) - 1 + len(y) + np.arange(len(along))
    return _body(corners, touching, clamped, material)


def _ends(reach: float, count: int, end: float, largest: float) -> np.ndarray:
    """Ends of elements along a face, symmetric: equal ones in the middle, growing beyond."""
    middle = np.linspace(-reach, reach, count + 1)
    sizes = [middle[1] - middle[0]]
    while sum(sizes) < end - reach:
        sizes.append(min(_GROWTH * sizes[-1], largest))
    beyond = np.cumsum(sizes)
    beyond = reach + beyond * (end - reach) / beyond[-1]
    return np.concatenate([-beyond[::-1], middle, beyond])


def _body(corners: np.ndarray, touching, clamped, material: Material) -> Body:
    """A body inside a polygon that runs counterclockwise, with some sides clamped."""
    by_traction, by_motion = _integrals(corners, material)
    held, loaded = (np.add.outer(2 * n, [0, 1]).ravel() for n in (clamped, touching))
    matrix = by_motion.copy()
    matrix[:, held] = -material.shear * by_traction[:, held]  # their tractions are unknown
    compliance = np.linalg.solve(matrix, by_traction[:, loaded])[loaded]
    sides = np.diff(corners, axis=0)
    points = corners[:-1] + sides / 2
    return Body(points[touching], np.linalg.norm(sides, axis=1)[touching], compliance)


def _integrals(corners: np.ndarray, material: Material) -> tuple[np.ndarray, np.ndarray]:
    """Kelvin's displacements and tractions over each side, at the middle of each side.

    ``T u = U t`` for displacements u and tractions t of the sides.
    """
    sides = np.diff(corners, axis=0)
    length = np.linalg.norm(sides, axis=1)
    along = sides / length[:, None]
    axes = np.stack([along, np.column_stack([-along[:, 1], along[:, 0]])], axis=1)
    middle = corners[:-1] + sides / 2
    x, y = np.einsum("qai,pqi->apq", axes, middle[:, None] - middle)
    y[np.abs(y) < 1e-12 * length.max()] = 0.0  # on one line

    def primitives(u: np.ndarray) -> np.ndarray:
        """Antiderivatives of ln r, (u, -y)(u, -y)/r², y/r² and y (u, -y)(u, -y)/r⁴, and of u/r²."""
        square, log = u**2 + y**2, np.log(u**2 + y**2) / 2
        angle = np.where(y == 0, 0.0, np.arctan(u / np.where(y == 0, 1.0, y)))
        turn, bend = u * y / square, y**2 / (2 * square)
        displacement = u * log - u + y * angle, u - y * angle, -y * log, y * angle
        traction = angle, (angle - turn) / 2, bend, (angle + turn) / 2
        return np.array([*displacement, *traction, log])

    log, xx, xy, yy, a, axx, axy, ayy, b = primitives(length / 2 - x) - primitives(-length / 2 - x)
    nu = material.poisson
    u = np.array([[xx - (3 - 4 * nu) * log, xy], [xy, yy - (3 - 4 * nu) * log]])
    c = 1 - 2 * nu
    t = np.array([[c * a + 2 * axx, 2 * axy + c * b], [2 * axy - c * b, c * a + 2 * ayy]])
    u, t = (
        np.einsum("qai,abpq,qbj->piqj", axes, k, axes).reshape(2 * len(x), -1)
        for k in (u / (8 * pi * material.shear * (1 - nu)), t / (-4 * pi * (1 - nu)))
    )
    return u, t + np.eye(len(t)) / 2


class Contact:
    """Two bodies with friction; `load` goes on to the next loads.

    Attributes
    ----------
    x, pressure, shear : ndarray, shape (n,)
        Of the contact; the shear is that on the upper body [m, Pa].
    """

    def __init__(self, upper: Body, lower: Body, friction: float):
        self._upper, self._lower, self._friction = upper, lower, friction
        count = len(upper.points)
        self.x, self.pressure, self.shear = upper.points[:, 0], np.zeros(count), np.zeros(count)
        self._opposite = (upper.lengths / lower.lengths)[:, None]
        self._both = upper.compliance + lower.compliance * np.repeat(self._opposite, 2)
        self._traction, self._holder = np.zeros((count, 2)), np.zeros(2)
        self._touches = np.abs(np.arange(count) - (count - 1) / 2) < 3
        self._slips = np.zeros(count)

    def load(self, force: float, push: float) -> None:
        """Next loads of the upper body, downward and to the right, per thickness [N/m]."""
        before = self._over()
        for _ in range(3):  # with the faces as they then are
            self._solve(self._tangents(), before, np.array([-push, force]))

    def _over(self) -> np.ndarray:
        """Displacement of the upper body relative to the lower one."""
        return (self._both @ self._traction.ravel()).reshape(-1, 2) + self._holder

    def _tangents(self) -> np.ndarray:
        """Unit tangents of the mean of both deformed faces."""
        upper = self._upper.points + self._upper.moved(self._traction) + self._holder
        lower = self._lower.points - self._lower.moved(self._opposite * self._traction)
        return _unit(sum(_unit(np.gradient(face, axis=0)) for face in (upper, lower)))

    def _solve(self, e: np.ndarray, before: np.ndarray, forces: np.ndarray) -> None:
        """Signorini's and Coulomb's conditions by active sets: touching or not, sticking or not."""
        n, count = np.column_stack([e[:, 1], -e[:, 0]]), len(e)
        every = np.arange(count)
        parts = np.zeros((count, 2, 2 * count))
        parts[every, :, every], parts[every, :, count + every] = -n, e
        response = (self._both @ parts.reshape(2 * count, -1)).reshape(parts.shape)
        rows = [np.hstack([np.einsum("ci,cik->ck", d, response), d]) for d in (n, e)]
        open_by = ((self._lower.points - self._upper.points) * n).sum(axis=1)
        start = (before * e).sum(axis=1)
        scale = np.abs(rows[0]).max()
        weights = scale / self._upper.lengths.sum()
        balance = np.hstack([np.einsum("c,cik->ik", self._upper.lengths, parts), np.zeros((2, 2))])
        unit, mu = scale * np.eye(2 * count + 2)[: 2 * count], self._friction
        touches, slips = self._touches, self._slips
        for _ in range(_CYCLES):
            free = unit[count:] - (mu * slips)[:, None] * unit[:count]
            matrix = np.vstack(
                [
                    np.where(touches[:, None], rows[0], unit[:count]),
                    np.where((touches & (slips == 0))[:, None], rows[1], free),
                    weights * balance,
                ]
            )
            right = np.concatenate(
                [touches * open_by, (touches & (slips == 0)) * start, weights * forces]
            )
            found = np.linalg.solve(matrix, right)
            p, t = found[:count], found[count:-2]
            gap, slip = open_by - rows[0] @ found, rows[1] @ found - start
            closed = np.where(touches, p >= 0, gap < 0)
            beyond = np.where(np.abs(t) > mu * p * (1 + 1e-9), np.sign(t), 0.0)
            sliding = np.where(slips == 0, beyond, np.where(slips * slip <= 0, slips, 0.0))
            sliding = np.where(touches & closed, sliding, 0.0)
            if np.array_equal(closed, touches) and np.array_equal(sliding, slips):
                break
            touches, slips = closed, sliding
        else:
            raise RuntimeError("no convergence")
        self._touches, self._slips = touches, slips
        self.pressure, self.shear, self._holder = p, t, found[-2:]
        self._traction = t[:, None] * e - p[:, None] * n


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]
