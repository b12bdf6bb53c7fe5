"""Condensed contact with pressure and shear as unknowns; signs: see `tangential`."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...laws.motions import RigidMotion
from .pressure import PressureSpace, scaled


@dataclass(frozen=True)
class HeldMotion:
    """Motion of a holder, free or given.

    Attributes
    ----------
    motion : RigidMotion
    bodies : tuple of int
        Indices of the bodies that move.
    role : str
        ``"press"`` along the load direction, ``"slide"`` across it, ``"other"``.
    holder : str
        Subject of messages about it.
    """

    motion: RigidMotion
    bodies: tuple[int, ...] = (0,)
    role: str = "other"
    holder: str = "contact: body 1"


@dataclass(frozen=True)
class FrictionalContact(PressureSpace):
    """Gap and slip of the elastic bodies as functions of pressure and shear.

    Below, t tangential directions give ``M = m (1 + t)`` coefficients.

    Attributes
    ----------
    gap : ndarray, shape (n,)
        Gap of the unloaded, unworn bodies [m].
    rigid : ndarray, shape (1 + t, n, k)
        R at the points: decrease of gap and slips per unit of each motion of the holder.
    compliance : ndarray, shape (M, M)
        A, symmetric [m⁵/N].
    modes : ndarray, shape (M, k)
        Weak R [m²].
    travel : ndarray, shape (n_interfaces, k), in space (n_interfaces, 3, k)
        Displacement of the first body over the second one in the middle of the face per unit of
        each motion: along increasing positions on the face; in space along the axes of the frame
        there, and rotation about its pole, see `faces.tangent_frame`.
    held : tuple of HeldMotion
        The k motions.
    """

    gap: np.ndarray
    rigid: np.ndarray
    compliance: np.ndarray
    modes: np.ndarray
    travel: np.ndarray
    held: tuple[HeldMotion, ...]

    @property
    def directions(self) -> int:
        """Number t of tangential directions."""
        return len(self.rigid) - 1

    @cached_property
    def areas(self) -> np.ndarray:
        """Areas of the basis functions, shape (m,) [m²]."""
        return np.asarray(self.weighted.sum(axis=0)).ravel()

    def with_role(self, role: str) -> np.ndarray:
        """True for the motions with a role, shape (k,)."""
        return np.array([motion.role == role for motion in self.held], dtype=bool)

    def stack(self, pressure: np.ndarray, shear: np.ndarray) -> np.ndarray:
        """Coefficients λ, shape (m,), and τ, shape (m, t), as one vector x."""
        return np.concatenate([pressure, shear.T.ravel()])

    def split(self, stacked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Split x into λ and τ, the inverse of `stack`."""
        blocks = stacked.reshape(-1, self.basis.shape[1])
        return blocks[0], blocks[1:].T

    def weak_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Weak slip under coefficients x and motion d of the holder, shape (m, t) [m³]."""
        return self.split(self.compliance @ stacked - self.modes @ motion)[1]

    @abstractmethod
    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Slip at the points under coefficients x and motion d of the holder, shape (n, t) [m]."""

    @abstractmethod
    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        """Energy dissipated at the points in an increment, shape (n,) [J/m²].

        Its integral is exactly that of the weak conditions, to which each coefficient contributes
        at least 0.

        Parameters
        ----------
        shear : ndarray, shape (m, t)
            Coefficients τ at the end of the increment [Pa].
        slip : ndarray, shape (m, t)
            Weak slip of the increment [m³].
        point_slip : ndarray, shape (n, t)
            Slip of the increment at the points [m].
        """


@dataclass(frozen=True)
class LineContact(FrictionalContact):
    """Frictional contact of plane bodies, with the slip of the bodies at each point.

    Attributes
    ----------
    response : ndarray, shape (1 + t, n, M)
        Gap and slips at the points per coefficient [m/Pa].
    influence : ndarray, shape (n_owned, M)
        Displacement per coefficient [m/Pa]; weak gap and slips due to any nodal load f are
        ``influenceᵀ f``.
    """

    response: np.ndarray
    influence: np.ndarray

    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        return (self.response[1:] @ stacked - self.rigid[1:] @ motion).T

    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        return -((self.basis @ shear) * point_slip).sum(axis=1)


@dataclass(frozen=True)
class SurfaceContact(FrictionalContact):
    """Frictional contact of bodies in space.

    The slip at a point is the mean of the slips of its coefficients, the weak slips over their
    areas, as no displacements are stored: it vanishes exactly where all of them stick.
    """

    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        return self.basis @ (self.weak_slip(stacked, motion) / self.areas[:, None])

    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        worked = np.maximum(-(shear * slip).sum(axis=1), 0.0)  # rounding where it sticks
        return self.basis @ (worked / self.areas)


def frictional_contact(
    basis: np.ndarray,
    weights: np.ndarray,
    gap: np.ndarray,
    response: np.ndarray,
    rigid: np.ndarray,
    travel: np.ndarray,
    held: Sequence[HeldMotion],
    influence: np.ndarray,
) -> LineContact:
    """Assemble weak operators from responses at the points; arguments as in `LineContact`.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Area of each point [m²].
    """
    weighted = scaled(weights, basis)
    compliance = np.concatenate([weighted.T @ component for component in response])
    compliance = (compliance + compliance.T) / 2
    modes = weak(weighted, rigid)
    common = basis, weighted, gap, rigid, compliance, modes, travel, tuple(held)
    return LineContact(*common, response, influence)


def weak(weighted, rigid: np.ndarray) -> np.ndarray:
    """Weak modes, shape (M, k), of a matrix R at the points, shape (1 + t, n, k)."""
    return np.concatenate([weighted.T @ component for component in rigid])
