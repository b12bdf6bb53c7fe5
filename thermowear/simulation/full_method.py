"""Contact solved on the full system, by penalty or by Nitsche's method."""

from __future__ import annotations

import numpy as np

from ..contact.full_system import FullContact, FullSolution
from ..contact.stabilisation import (
    default_penalty,
    nitsche_stiffness,
    nitsche_warning,
    stability_limit,
)
from ..contact.traction import normal_traction, thermal_traction
from ..errors import ComputationError
from ..parallel import sum_over_ranks
from .friction_heat import FrictionHeat
from .interface_problem import Contact, WearRates
from .system import System

_PASSES = 60
_SETTLED = 1e-9  # of the largest pressure
_REMEMBERED = 6


class FullMethod:
    """The contact conditions point by point, on all nodal displacements.

    Heat and contact are solved in turn: the bodies conduct the friction heat of a pressure, their
    distortion changes the pressure. The turns are accelerated, as one after the other they converge
    no faster than the speed is below the critical one.

    Parameters
    ----------
    system : System
    heat : FrictionHeat or None
    """

    def __init__(self, system: System, heat: FrictionHeat | None):
        self._system = system
        self._heat = heat
        self._contact, self.note = _full_contact(system)
        still = np.zeros(len(system.elastic.fixed))
        self._dead = still if system.dead_load is None else system.dead_load
        self._softening = None if heat is None else thermal_traction(system.elastic, system.pairing)

    def solve(self, gap, slope, guess: Contact | None, closed) -> Contact:
        start = None if guess is None else guess.memory
        if self._heat is None:
            return self._result(self._solved(gap, slope, start, self._dead, None))
        pressure = np.zeros(len(gap)) if guess is None else guess.pressure
        tried: list[np.ndarray] = []
        missed: list[np.ndarray] = []
        for _ in range(_PASSES):
            start = self._warm(gap, slope, start, closed, pressure)
            tried.append(pressure)
            missed.append(start.pressure - pressure)
            if np.abs(missed[-1]).max() <= _SETTLED * np.abs(start.pressure).max():
                return self._result(start)
            pressure = _accelerated(tried[-_REMEMBERED:], missed[-_REMEMBERED:])
        raise ComputationError(
            f"contact: heat and pressure do not settle in {_PASSES} turns; reduce the speed, "
            'or use contact.method = "condensed", which solves both at once'
        )

    def steady(self, pressure, rates: WearRates) -> np.ndarray:
        """The principle point by point: the full system has no pressure space of its own."""
        return pressure

    def opening(self, contact: Contact) -> float:
        system = self._system
        opened = system.trace.T @ contact.memory.displacement
        return float(np.abs(sum_over_ranks(system.comm, opened)).max())

    def _warm(self, gap, slope, start, closed, pressure) -> FullSolution:
        """Contact of bodies that the friction heat of a pressure has distorted."""
        thermal, heat = self._system.thermal, self._heat
        assert thermal is not None
        assert heat is not None
        faces = heat.state(pressure, closed)
        rise = thermal.conduction.solve(thermal.face.nodal_heat(faces, bath=True))
        traction = -np.asarray(self._softening) * faces.rise[0]
        return self._solved(gap, slope, start, self._dead + thermal.forces(rise), traction)

    def _solved(self, gap, slope, start, nodal_loads, traction) -> FullSolution:
        load = self._system.holder.load
        return self._contact.solve(gap, load, slope, nodal_loads, traction, start)

    def _result(self, solution: FullSolution) -> Contact:
        motion = self._system.holder.amounts(solution.motion)
        return Contact(solution.pressure, motion, solution)


def _full_contact(system: System) -> tuple[FullContact, str | None]:
    """The equations that the case asks for, and a warning where its numbers are out of range."""
    settings, holder = system.case.contact, system.holder
    elastic, pairing = system.elastic, system.pairing
    stress, note = None, None
    theta = 1 if settings.theta is None else settings.theta
    if settings.method == "nitsche":
        stress = normal_traction(elastic, pairing)
        gamma = () if settings.gamma is None else (settings.gamma,)
        stiffness = nitsche_stiffness(elastic, pairing, *gamma)
        note = nitsche_warning(stiffness, stability_limit(elastic, pairing), theta)
    elif settings.penalty is not None:
        stiffness = np.full(len(pairing.weights), settings.penalty)
    else:
        stiffness = default_penalty(elastic, pairing)
    contact = FullContact(
        elastic,
        pairing,
        system.trace,
        system.traction,
        holder.modes,
        holder.force_modes,
        stiffness,
        stress,
        theta,
    )
    return contact, note


def _accelerated(tried: list[np.ndarray], missed: list[np.ndarray]) -> np.ndarray:
    """What to try next: Anderson's mixing of what was tried and by how much it missed.

    Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715, method without damping.
    """
    last = tried[-1] + missed[-1]
    if len(tried) == 1:
        return last
    Δtried, Δmissed = np.diff(tried, axis=0).T, np.diff(missed, axis=0).T
    mixing = np.linalg.lstsq(Δmissed, missed[-1], rcond=1e-12)[0]
    return last - (Δtried + Δmissed) @ mixing
