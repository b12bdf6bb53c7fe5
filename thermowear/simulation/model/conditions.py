"""What holds at the interface at one moment, and may be different at the next."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...case.tables.history import FactorHistory, History
from ...contact.operators.heat import ThermalState
from .system import System

_SETTLED = 1e-10
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Conditions:
    """Arrays of shape (n,) unless stated otherwise.

    Attributes
    ----------
    load : ndarray, shape (k,)
        On the free motions of the holder [N or N m].
    speed : ndarray
        Of sliding [m/s].
    friction : ndarray
        Coefficient.
    wear : ndarray, shape (n_wearing, n)
        Factor of the wear rate of each wearing body.
    conductance : ndarray
        Between the faces; infinite in perfect contact [W/(m² K)].
    """

    load: np.ndarray
    speed: np.ndarray
    friction: np.ndarray
    wear: np.ndarray
    conductance: np.ndarray

    @property
    def heating(self) -> np.ndarray:
        """Friction heat per pressure, ``mu v`` [m/s]."""
        return self.friction * self.speed

    @property
    def released(self) -> bool:
        """Whether nothing presses the bodies together any more."""
        return self.load.size > 0 and not self.load.any()

    def differ(self, other: Conditions) -> float:
        """Largest relative difference."""
        pairs = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return max(_difference(a, b) for a, b in pairs)

    def settled(self, other: Conditions) -> bool:
        """Whether they are the same, but for rounding."""
        return self is other or self.differ(other) <= _SETTLED


def _difference(a: np.ndarray, b: np.ndarray) -> float:
    if a.size == 0 or np.array_equal(a, b):
        return 0.0
    if not np.array_equal(np.isinf(a), np.isinf(b)):
        return np.inf
    a, b = (np.where(np.isinf(values), 0.0, values) for values in (a, b))
    return float(np.abs(a - b).max() / max(np.abs(a).max(), np.abs(b).max()))


def _part(course: History | FactorHistory | None, time: float) -> float:
    """How much of a load, speed or friction there is; none where rounding alone leaves some."""
    part = 1.0 if course is None else course.factor_at(time)
    return part if part > _ROUNDING else 0.0


class Surroundings:
    """The conditions of a case at any time, pressure and temperature.

    Parameters
    ----------
    system : System
    """

    def __init__(self, system: System):
        self._system = system
        self._case = system.case
        bodies = self._case.geometry.bodies
        self._laws = [(index, self._case.wear[bodies[index]]) for index in system.laws]
        self._courses = list(self._case.histories.values())
        self._lasting: tuple[bytes, Conditions] | None = None

    def at(
        self, time: float, pressure: np.ndarray, faces: ThermalState | None, closed: np.ndarray
    ) -> Conditions:
        """Conditions in a state.

        Parameters
        ----------
        time : float
            [s]
        pressure : ndarray, shape (n,) [Pa]
        faces : ThermalState or None
            Temperatures of the faces, where they are known.
        closed : ndarray of bool, shape (n,)
            Which points exchange heat by contact.
        """
        if self._case.varies or self._courses:
            return self._present(time, pressure, faces, closed)
        key = closed.tobytes()  # nothing else changes: most cases ask for the same again and again
        if self._lasting is None or self._lasting[0] != key:
            self._lasting = (key, self._present(time, pressure, faces, closed))
        return self._lasting[1]

    def _present(self, time, pressure, faces, closed) -> Conditions:
        system, case = self._system, self._case
        load, motion = case.load.history, case.motion
        pressed = _part(load, time)
        moved = _part(None if motion is None else motion.history, time)
        speed = moved * system.speed
        temperatures = self._temperatures(faces)
        friction = self._friction(time, temperatures, pressure, speed)
        return Conditions(
            load=pressed * system.holder.load + system.holder.dead,
            speed=speed,
            friction=friction,
            wear=self._wear(temperatures, pressure, speed, friction),
            conductance=self._conductance(pressure, closed),
        )

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end at which something changes its course [s]."""
        return tuple(t for course in self._courses for t in course.corners(end))

    def _temperatures(self, faces: ThermalState | None):
        if faces is None or self._system.thermal is None:
            return None
        ambient = self._system.thermal.ambient
        return faces.rise[0] + ambient, faces.rise[1] + ambient

    def _friction(self, time, temperatures, pressure, speed) -> np.ndarray:
        mean = None if temperatures is None else (temperatures[0] + temperatures[1]) / 2
        contact = self._case.contact
        present = _part(contact.friction_history, time) * self._system.friction
        return present * contact.friction_factor.value(mean, pressure, speed)

    def _wear(self, temperatures, pressure, speed, friction) -> np.ndarray:
        """Factors by table, and of a friction that is not the nominal one."""
        result = np.ones((len(self._laws), len(pressure)))
        for row, (index, wear) in enumerate(self._laws):
            own = None if temperatures is None else temperatures[index]
            result[row] = wear.factor.value(own, pressure, speed)
            if wear.per == "friction-stress" and self._case.friction_varies:
                result[row] *= (friction / self._system.friction) ** wear.pressure_exponent
        return result

    def _conductance(self, pressure: np.ndarray, touching: np.ndarray) -> np.ndarray:
        heat = self._case.heat
        if heat is None:
            return np.zeros(len(pressure))
        given = self._case.conductance(pressure, self._system.facing)
        closed = np.inf if given is None else given
        return np.where(touching, closed, heat.gap_conductance or 0.0)
