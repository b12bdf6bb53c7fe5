"""Solvability of steady wear: self-locking by friction, and loads that cannot be carried."""

from __future__ import annotations

import numpy as np
import scipy

from ...errors import ComputationError

_NOTHING = 1e-9  # relative size below which a force or an approach is zero


class SelfLocking(ComputationError):
    """Error: self-locking, friction carries any load without steady wear."""


class NotCarried(ComputationError):
    """Error: the load lifts the body off, or tips it over the edge of its face."""


def not_carried(weights: np.ndarray, modes: np.ndarray, load: np.ndarray) -> NotCarried | None:
    """Error if no pressure ``p >= 0`` carries the load, ``modesᵀ w p = F``; otherwise None."""
    scale = np.abs(modes).max(axis=0)
    _, left = scipy.optimize.nnls((modes[weights > 0] / scale).T, load / scale)
    if left < _NOTHING * np.linalg.norm(load / scale):
        return None
    return NotCarried(
        "no contact pressure is in equilibrium with the load: it lifts the body off or tips it "
        "over an edge of the face; change the load or its line of action"
    )


def why_no_steady_state(
    weights: np.ndarray, normal_modes: np.ndarray, force_modes: np.ndarray, load: np.ndarray
) -> ComputationError:
    """Error to raise if the principle has no solution.

    Self-locking requires pressures in equilibrium with their friction without load, at some
    coefficient of friction up to the given one. It is excluded if a motion of the holder exists
    against which every pressure does work, with and without friction: ``R y > 0`` and ``T y > 0``
    at all points bound the pressures by ``F·y``.

    Parameters
    ----------
    weights : ndarray, shape (n,)
    normal_modes, force_modes : ndarray, shape (n, k)
        R and T.
    load : ndarray, shape (k,)
    """
    outside = not_carried(weights, normal_modes, load)
    if outside is None and not _bounded(normal_modes, force_modes):
        return SelfLocking(
            "self-locking: friction carries any load, without steady wear in this direction of "
            "sliding; lower the friction or reverse the motion"
        )
    return (
        outside
        or not_carried(weights, force_modes, load)
        or ComputationError(
            "no steady state: the solver found no pressure and rigid-body wear velocity in "
            "equilibrium with the load"
        )
    )


def _bounded(R: np.ndarray, T: np.ndarray) -> bool:
    """Test whether a motion y exists with ``R y > 0`` and ``T y > 0`` at all points."""
    rows = np.vstack([R, T])
    rows = rows / np.abs(rows).max(axis=0)
    least = scipy.optimize.linprog(  # the largest t with rows y >= t
        c=np.append(np.zeros(R.shape[1]), -1.0),
        A_ub=np.column_stack([-rows, np.ones(len(rows))]),
        b_ub=np.zeros(len(rows)),
        bounds=(-1.0, 1.0),
    )
    return bool(-least.fun > _NOTHING)
