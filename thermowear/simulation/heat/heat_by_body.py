"""Heat balance of each body of a model of several bodies."""

from __future__ import annotations

import numpy as np

from ...balances import relative
from ...contact.operators.heat import ThermalState
from ...parallel import sum_over_ranks
from ..system.system import System
from ..system.thermal_loads import ThermalLoad
from ..system.thermal_system import ThermalSystem

_LEAST = 1e-3
"""Least scale of the balance of a body, relative to the heat turned over in all of them."""


def tracked_bodies(system: System) -> int:
    """Number of bodies whose heat is summed up in time: none of a pair."""
    return 0 if system.model.is_pair else len(system.model.bodies)


def of_bodies(system: System, nodal: np.ndarray) -> np.ndarray:
    """Sums of nodal values (k, n_owned) over each body, shape (k, n_bodies); every rank calls.

    Shape (k, 0) for a pair.
    """
    if not tracked_bodies(system):
        return np.zeros((len(nodal), 0))
    assert system.thermal is not None
    spaces, bodies = system.thermal.conduction.spaces, system.model.bodies
    result = np.zeros((len(nodal), len(bodies)))
    for k, mesh in enumerate(system.bodies.each):
        owner = next(i for i, body in enumerate(bodies) if mesh.parts[0] in body.parts)
        result[:, owner] += nodal[:, spaces.rows(k)].sum(axis=1)
    return sum_over_ranks(system.comm, result)


def into_bodies(
    system: System,
    thermal: ThermalSystem,
    faces: ThermalState,
    rise: np.ndarray,
    load: ThermalLoad,
    stored: np.ndarray | float = 0.0,
) -> np.ndarray:
    """Net heat into each body and the sum of its magnitudes, shape (2, n_bodies) [W].

    Nothing for a pair, shape (2, 0). Every rank calls.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem
    faces : ThermalState
    rise : ndarray, shape (n_owned,) [K]
    load : ThermalLoad
    stored : ndarray, shape (n_owned,), optional
        Rate of the nodal stored heat [W].
    """
    if not tracked_bodies(system):
        return np.zeros((2, 0))
    heat = thermal.face.nodal_heat(faces, bath=False) + load.heat - stored
    net, sizes = thermal.conduction.into_bodies(rise, heat)
    return of_bodies(system, np.array([net + stored, sizes]))


def errors(net: np.ndarray, sizes: np.ndarray) -> list[float]:
    """Relative errors of balances of bodies, from their defects and magnitudes, (n_bodies,)."""
    scales = np.maximum(sizes, _LEAST * sizes.sum())
    return [relative(float(d), float(s)) for d, s in zip(net, scales, strict=True)]
