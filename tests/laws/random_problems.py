"""Random problems of steady wear that have a solution."""

import numpy as np

from thermowear.laws import PowerWear, contact_patch, rotation, translation


def random_laws(rng):
    """One or two wear laws with rates of an ordinary size."""
    exponents = np.exp(rng.uniform(np.log(0.3), np.log(4.0), rng.integers(1, 3)))
    return [
        PowerWear(10 ** rng.uniform(-15, -12) * 1e6 ** (1 - b), b, rng.uniform(0.0, 2.0))
        for b in exponents
    ]


def carried_load(rng, patch, x, y, eccentric):
    """Load of a positive pressure; large `eccentric` puts it near the edges of the face."""
    angle, steepness = rng.uniform(0, 2 * np.pi), eccentric * rng.uniform()
    pressure = 1e7 * np.exp(steepness * (np.cos(angle) * x + np.sin(angle) * y))
    return patch.force_modes.T @ (patch.weights * pressure)


def free_motions(rng, pivot, count):
    """A translation along -z, and as many turns about horizontal axes as asked for."""
    turns = [rotation((1, 0, 0), pivot), rotation((0, 1, 0), pivot)]
    return [translation((0, 0, -1)), *turns[: count - 1]]


def flat_face(rng, friction, eccentric):
    """A scattered flat face of any size, joints above it, sliding along one direction."""
    n, size = int(rng.integers(20, 150)), 10 ** rng.uniform(-4, 0)
    x, y = rng.uniform(-1, 1, (2, n))
    pivot = size * np.array([*rng.uniform(-3, 3, 2), rng.uniform(0, 0.5)])
    angle = rng.uniform(0, 2 * np.pi)
    patch = contact_patch(
        size * np.column_stack([x, y, 0 * x]),
        size**2 * rng.uniform(0.2, 1, n) / n,
        (0, 0, -1),
        free_motions(rng, pivot, int(rng.integers(1, 4))),
        rng.uniform(0.1, 1, n),
        rng.uniform(0, friction),
        (np.cos(angle), np.sin(angle), 0),
    )
    return patch, carried_load(rng, patch, x, y, eccentric), random_laws(rng)


def curved_face(rng, friction, eccentric, motions=None):
    """A scattered curved face, so that friction has a part along the normal motions."""
    n = int(rng.integers(30, 150))
    x, y = rng.uniform(-1, 1, (2, n))
    curvature, (cx, cy) = rng.uniform(0, 0.8), rng.uniform(-0.5, 0.5, 2)
    normals = np.column_stack([-curvature * (x - cx), -curvature * (y - cy), -np.ones(n)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    drawn = np.array([*rng.normal(size=2), 0.0])
    along = drawn - (normals @ drawn)[:, None] * normals
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    pivot = np.array([*rng.uniform(-0.5, 0.5, 2), rng.uniform(0, 1.5)])
    patch = contact_patch(
        np.column_stack([x, y, -curvature / 2 * ((x - cx) ** 2 + (y - cy) ** 2)]),
        rng.uniform(0.2, 1, n) / n,
        normals,
        free_motions(rng, pivot, motions or int(rng.integers(1, 4))),
        rng.uniform(0.3, 1, n),
        rng.uniform(0, friction),
        along,
    )
    return patch, carried_load(rng, patch, x, y, eccentric), random_laws(rng)
