"""Interface of contact solvers: a contact problem under given loads, and its solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ...contact.wear.implicit_step import Slope, WearRates
from ...serialise import serialisable
from ..heat.friction_heat import AnyHeat
from ..system.conditions import InterfaceConditions


@serialisable
@dataclass(frozen=True)
class ContactSolution:
    """Solution of a contact problem.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    motion : ndarray, shape (n_modes,)
        Amount of each rigid mode of the holder [m or rad].
    warm_start : object
        Solution to start the solver from.
    apart : ndarray or None, shape (n,)
        Gap of the points with pointwise contact: 0 where they press, NaN at other points; None
        without such points [m].
    """

    pressure: np.ndarray
    motion: np.ndarray
    warm_start: Any
    apart: np.ndarray | None = None


class ContactSolver(Protocol):
    """Solver of contact under given loads: condensed, or on the full system."""

    def solve(
        self,
        gap: np.ndarray,
        slope: Slope,
        guess: ContactSolution | None,
        conditions: InterfaceConditions,
        heat: AnyHeat | None,
        pointwise: np.ndarray | None = None,
    ) -> ContactSolution:
        """Solve contact of bodies with friction heat and a local compliance.

        Parameters
        ----------
        gap : ndarray, shape (n,)
            Gap without pressure, heat and motion of the holder [m].
        slope : Slope
            Gap per pressure in addition to the deflection of the bodies [m/Pa].
        guess : ContactSolution or None
        conditions : InterfaceConditions
        heat : AnyHeat or None
        pointwise : ndarray of bool, shape (n,), optional
            Points at the edge of the wear with pointwise contact, see `contact.wear.wear_edge`.

        Raises
        ------
        ComputationError
        """

    def point_compliance(self, points: np.ndarray) -> np.ndarray:
        """Deflection per pressure of a single point, NaN at other points, shape (n,) [m/Pa].

        Parameters
        ----------
        points : ndarray of bool, shape (n,)
            From `InterfaceProblem.begin`.
        """

    def steady(
        self,
        pressure: np.ndarray,
        rates: WearRates,
        conditions: InterfaceConditions,
        pointwise: np.ndarray | None = None,
    ) -> np.ndarray:
        """Steady pressure in the discretisation of the solver, from that of the principle [Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,) [Pa]
        rates : WearRates
        conditions : InterfaceConditions
            Conditions in the steady state.
        pointwise : ndarray of bool, shape (n,), optional
            Points with pointwise contact.
        """

    def largest_deflection(self, contact: ContactSolution) -> float:
        """Largest change of the gap by elastic deflection [m]."""

    def deflection_range(self, contact: ContactSolution) -> float:
        """Range of the elastic deflection over the contact area [m]."""
