"""Local wear of reciprocating faces in all positions of the stroke, and contact over a cycle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contact.wear.implicit_step import Slope
from ...laws.interfaces import Law, LocalState
from ...model.face_wear import FaceWear
from ...model.interface import Interface
from ..system.system import System


@dataclass(frozen=True)
class CycleContact:
    """Contact of each interface over a cycle.

    Attributes
    ----------
    largest : ndarray, shape (n_interfaces,)
        Largest pressure [Pa].
    area, force, friction, power : ndarray, shape (n_interfaces,)
        Mean contact area, normal force along the load direction, friction force and friction power
        [m², N, N, W].
    motion : ndarray, shape (n_modes,)
        Mean motion of the holders.
    """

    largest: np.ndarray
    area: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    power: np.ndarray
    motion: np.ndarray


@dataclass(frozen=True)
class FaceLaw:
    """Wear law of the carrying or of the swept face of an interface.

    Attributes
    ----------
    own : slice
        Coefficients of the interface.
    law : Law or None
        None: the face does not wear.
    speeds : ndarray, shape (J, 1) [m/s]
    friction : float
    """

    own: slice
    law: Law | None
    speeds: np.ndarray
    friction: float


@dataclass(frozen=True)
class LocalWear:
    """Local wear rates in all positions, see `contact.wear.implicit_step`.

    Attributes
    ----------
    faces : tuple of tuple of FaceLaw
        Laws of the carrying faces, and those of the swept ones, by interface.
    """

    faces: tuple[tuple[FaceLaw, ...], ...]

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Local rates under coefficients of the pressure (J, m), shape (2, J, m) [m/s]."""
        return self._each(pressure, "value")

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivatives of the local rates with respect to pressure [m/s/Pa]."""
        return Slope.diagonal(self._each(pressure, "slope"))

    def _each(self, pressure: np.ndarray, name: str) -> np.ndarray:
        found = np.zeros((len(self.faces), *pressure.shape))
        for side, faces in zip(found, self.faces, strict=True):
            for face in faces:
                if face.law is not None:
                    at = LocalState(pressure[:, face.own], face.speeds, mu=face.friction)
                    side[:, face.own] = getattr(face.law, name)(at)
        return found


def local_wear(
    system: System, functions: tuple[slice, ...], speeds: np.ndarray, strokes: np.ndarray
) -> LocalWear:
    """Local wear of all faces at the mean speeds (J, 1) of the given stroke [m/s]."""
    each = system.model.interfaces, system.contacts.carriers, functions, strokes
    interfaces = list(zip(*each, strict=True))

    def face(one: Interface, carrier: int, own: slice, stroke: float, swept: int) -> FaceLaw:
        wear = one.wear.get(abs(carrier - swept))
        law = wear.law if isinstance(wear, FaceWear) else None
        return FaceLaw(own, law, abs(stroke) * speeds, one.nominal_friction)

    return LocalWear(tuple(tuple(face(*one, swept) for one in interfaces) for swept in (0, 1)))
