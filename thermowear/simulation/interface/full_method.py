"""Contact solver on the full system, by penalty or by Nitsche's method."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from ...contact.full.edge_deflection import EdgeDeflection, edge_deflection, wave_compliance
from ...contact.full.full_system import FullContact, FullSolution
from ...contact.full.nitsche import (
    default_penalty,
    nitsche_stiffness,
    nitsche_warning,
    normal_traction,
    stability_limit,
    thermal_traction,
)
from ...contact.solvers.coupled_positions import AndersonMixing
from ...contact.wear.implicit_step import WearRates
from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ..system.setup_cache import SetupCache
from ..system.system import System
from .condensed_method import ContactSolution

_ITERATIONS = 60
_TOLERANCE = 1e-9  # of the largest pressure


class FullMethod:
    """Pointwise contact conditions on all nodal displacements.

    At the edge of the wear points have a deflection of their own, see
    `contact.full.edge_deflection`.

    Heat and contact are solved in a staggered iteration: friction heat distorts the bodies, and the
    distortion changes the pressure. It uses Anderson acceleration, as its plain convergence rate is
    the ratio of the speed to the critical one.
    """

    def __init__(self, system: System, note: Callable[[str], None] | None):
        self._system = system
        self._contact = _full_contact(system, note)
        unloaded = np.zeros(len(system.elastic.fixed))
        self._dead = unloaded if system.dead_load is None else system.dead_load
        heated = system.thermal is not None
        self._softening = thermal_traction(system.elastic, system.pairing) if heated else None
        self._last = SetupCache()

    def solve(
        self, gap, slope, guess: ContactSolution | None, conditions, heat, pointwise=None
    ) -> ContactSolution:
        start, load = None if guess is None else guess.warm_start, conditions.load
        slope = slope.point  # means occur for rotating disks in 3D, with condensed contact only
        edge = self._deflection(pointwise)
        if heat is None:
            found = self._contact.solve(gap, load, slope, self._dead, None, start, edge)
            return self._result(found)
        pressure = np.zeros(len(gap)) if guess is None else guess.pressure
        mixing = AndersonMixing()
        for _ in range(_ITERATIONS):
            start = self._warm(gap, slope, start, conditions, heat, pressure, edge)
            residual = start.pressure - pressure
            if np.abs(residual).max() <= _TOLERANCE * np.abs(start.pressure).max():
                return self._result(start)
            pressure = mixing.next(pressure, residual)
        raise ComputationError(
            f"contact: heat and pressure did not converge in {_ITERATIONS} iterations; reduce the "
            'speed, or use contact.method = "condensed", which solves both at once'
        )

    def point_compliance(self, points) -> np.ndarray:
        return np.where(points, self._edge_compliance, np.nan)

    def steady(self, pressure, rates: WearRates, conditions, pointwise=None) -> np.ndarray:
        """Pressure of the principle unchanged: the full system has no pressure space."""
        return pressure

    def largest_deflection(self, contact: ContactSolution) -> float:
        return float(np.abs(self._opened(contact)).max())

    def deflection_range(self, contact: ContactSolution) -> float:
        opened = self._opened(contact)[contact.pressure > 0.0]
        return float(np.ptp(opened)) if opened.size else 0.0

    def _opened(self, contact: ContactSolution) -> np.ndarray:
        """Change of the gap by elastic deflection at the points, shape (n,) [m]."""
        system = self._system
        return sum_over_ranks(system.comm, system.trace.T @ contact.warm_start.displacement)

    @cached_property
    def _edge_compliance(self) -> np.ndarray:
        """Compliance ε of the points at the edge of the wear, shape (n,) [m/Pa]."""
        system = self._system
        degree = system.model.pressure_degree(system.model.interface)
        return wave_compliance(system.elastic, system.pairing, degree)

    def _deflection(self, points: np.ndarray | None) -> EdgeDeflection | None:
        """Unresolved deflection at given points, None without any; the last result is cached."""
        if points is None:
            return None
        basis, weights = self._system.basis, self._system.weights
        return self._last.get(
            "deflection",
            points.tobytes(),
            lambda: edge_deflection(basis, weights, points, self._edge_compliance),
        )

    def _warm(self, gap, slope, start, conditions, heat, pressure, edge) -> FullSolution:
        """Solve contact of bodies distorted by the friction heat of a pressure."""
        assert self._system.thermal is not None
        faces = heat.faces(conditions, pressure)
        traction = -np.asarray(self._softening) * faces.rise[self._system.pairing.carrier]
        loads = self._dead + self._system.thermal.forces(heat.rise(faces))
        return self._contact.solve(gap, conditions.load, slope, loads, traction, start, edge)

    def _result(self, solution: FullSolution) -> ContactSolution:
        motion = self._system.holder.amplitudes(solution.motion)
        return ContactSolution(solution.pressure, motion, solution)


def _full_contact(system: System, note: Callable[[str], None] | None) -> FullContact:
    """Contact equations of a system; a note tells if its parameters are out of range."""
    settings, holder = system.model.interface.method, system.holder
    nitsche = settings.name == "nitsche"
    return FullContact(
        system.elastic,
        system.pairing,
        system.trace,
        system.traction,
        holder.modes,
        holder.force_modes,
        contact_stiffness(system, note),
        normal_traction(system.elastic, system.pairing) if nitsche else None,
        settings.theta,
    )


def contact_stiffness(system: System, note: Callable[[str], None] | None) -> np.ndarray:
    """Stiffness γ of the penalty method or of Nitsche's, shape (n,) [Pa/m].

    A note tells if it is out of range. Every rank calls.
    """
    settings, elastic, pairing = system.model.interface.method, system.elastic, system.pairing
    if settings.name == "nitsche":
        gamma = () if settings.gamma is None else (settings.gamma,)
        stiffness = nitsche_stiffness(elastic, pairing, *gamma)
        warning = nitsche_warning(stiffness, stability_limit(elastic, pairing), settings.theta)
        if note is not None and warning is not None:
            note(warning)
        return stiffness
    if settings.penalty is not None:
        return np.full(len(pairing.weights), settings.penalty)
    return default_penalty(elastic, pairing)
