"""Heat steps of a system, linearised about the last temperatures.

Once where the properties of the bodies are constant, by Newton's method where conductivity or
expansion depend on temperature. Operators are kept for the step sizes used last.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...contact.operators.heat import BaselineResponse, baseline_response
from ...contact.operators.heat_condensation import condense_heat
from ..system.system import System
from ..system.thermal_loads import ThermalLoad
from ..system.thermal_system import ThermalSystem
from .heat_operators import CondensedDistortion, HeatOperators
from .heat_states import StoredHeat
from .heat_steps import ConductingStep, LinearHeatStep, NonlinearHeatStep

_MEMORY = 1e9
"""Memory limit for the operators of all step sizes on a rank [bytes]."""
_FEWEST = 3
"""Least number of step sizes whose operators are kept: a step, its half and its double."""
_FILL = {2: 100, 3: 1000}
"""Entries of the triangular factors per unknown, by dimension of the mesh."""


@dataclass
class Tangents:
    """Last operators for one step size [s], or for the steady state (None).

    Each needs a factorisation: Newton's method reuses them while its increments keep decreasing.

    Attributes
    ----------
    step : float or None
    reference : ndarray or None, shape (n_owned,)
        Rise at which they were linearised [K].
    last : HeatOperators or None
    """

    step: float | None
    reference: np.ndarray | None = None
    last: HeatOperators | None = None


class HeatSteps:
    """Conduction at the times of an analysis, condensed to the interface.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem
    """

    def __init__(self, system: System, thermal: ThermalSystem):
        self._system = system
        self._thermal = thermal
        self._distorts = system.model.interface.method.name == "condensed"
        self._distortion = CondensedDistortion(system, thermal)
        self._steps: OrderedDict[float, Tangents] = OrderedDict()
        self._steady: tuple[Tangents, ConductingStep] | None = None

    @property
    def steady(self) -> ConductingStep:
        """Steady conduction."""
        if self._steady is None:
            self._steady = self._steady_about(Tangents(None), self._thermal.conduction.prescribed)
        return self._steady[1]

    def after(self, before: StoredHeat, step: float, time: float) -> ConductingStep:
        """Conduction in an implicit Euler step that ends at a time [s]; every rank calls."""
        tangents = self._steps.setdefault(step, Tangents(step))
        self._steps.move_to_end(step)
        if len(self._steps) > self._kept:
            self._steps.popitem(last=False)
        load = self._thermal.loads.at(time)
        supplied = load.heat + before.content / step
        return self._conducting(tangents, load, supplied, before.rise)

    def restart_data(self) -> tuple | None:
        """Linearisation points, which the Newton iterates depend on; None for linear heat.

        Rise (n_owned,) by step size, the last used at the end; and for the steady state this rise,
        the last temperatures [K], and their last change.
        """
        if not self._thermal.varies:
            return None
        steps = {step: tangents.reference for step, tangents in self._steps.items()}
        if self._steady is None:
            return steps, None
        tangents, last = self._steady
        assert isinstance(last, NonlinearHeatStep)
        return steps, (tangents.reference, last.last_rise, last.last_change)

    def restore(self, data: tuple | None) -> None:
        """Restore the linearisation points from `restart_data`."""
        if data is None:
            return
        steps, steady = data
        self._steps.update({step: Tangents(step, rise) for step, rise in steps.items()})
        if steady is not None:
            reference, rise, change = steady
            self._steady = self._steady_about(Tangents(None, reference), rise, change)

    def at_rest(
        self,
        rise: np.ndarray,
        operators: HeatOperators | None = None,
        about: np.ndarray | None = None,
    ) -> BaselineResponse:
        """Interface response to a nodal rise (n_owned,); every rank calls.

        With operators the distortion is linearised about another rise, with their tangent.
        """
        traces, comm, distortion = self._thermal.face.traces, self._system.comm, self._distortion
        if not self._distorts:
            return baseline_response(rise, traces, comm)
        if operators is None or about is None:
            return baseline_response(
                rise, traces, comm, distortion.per_rise, distortion.excess(rise)
            )
        excess = distortion.excess(about, operators.reference)
        return baseline_response(rise, traces, comm, operators.per_rise, excess)

    def _steady_about(
        self, tangents: Tangents, rise: np.ndarray, change: float = np.inf
    ) -> tuple[Tangents, ConductingStep]:
        """Steady conduction for tangents and an initial rise (n_owned,)."""
        load = self._thermal.loads.at(0.0)
        return tangents, self._conducting(tangents, load, load.heat, rise, change)

    def _conducting(
        self,
        tangents: Tangents,
        load: ThermalLoad,
        supplied: np.ndarray,
        rise: np.ndarray,
        change: float = np.inf,
    ) -> ConductingStep:
        """Conduction at one time; if nonlinear, with an initial rise and its last change."""

        def linearise(rise: np.ndarray, renew: bool) -> LinearHeatStep:
            if renew or tangents.last is None:
                at = rise if renew or tangents.reference is None else tangents.reference
                tangents.reference, tangents.last = at, self._operators(at, tangents.step)
            return self._about(tangents.last, load, supplied, rise)

        if self._thermal.varies:
            return NonlinearHeatStep(linearise, self._system.comm, rise, change)
        return linearise(rise, False)

    def _about(
        self, operators: HeatOperators, load: ThermalLoad, supplied: np.ndarray, rise: np.ndarray
    ) -> LinearHeatStep:
        """Heat linearised about a rise, with tangents of a nearby rise; every rank calls."""
        conduction = self._thermal.conduction
        heat = supplied + conduction.linearisation_error(rise, operators.reference)

        def alone() -> BaselineResponse:
            return self.at_rest(load.on(operators.conduction).solve(heat), operators, rise)

        if operators.conduction is not conduction:  # of a time step, or a tangent
            return LinearHeatStep(operators, load, heat, alone())
        key = self._system.inputs.conduction, self._distorts
        return LinearHeatStep(operators, load, heat, self._system.parts.get("at rest", key, alone))

    @cached_property
    def _kept(self) -> int:
        """Number of step sizes whose operators are kept."""
        conduction, points = self._thermal.conduction, len(self._thermal.face.weights)
        dense, nodes = 12 * points**2, len(conduction.fixed)
        numbers = dense + _FILL[conduction.space.mesh.topology.dim] * nodes
        least = min(self._system.comm.allgather(_MEMORY / (8 * numbers)))
        return max(int(least), _FEWEST)

    def _operators(self, rise: np.ndarray, step: float | None) -> HeatOperators:
        """Operators linearised at a rise (n_owned,), steady or of a time step; every rank calls."""
        face, steady = self._thermal.face, self._thermal.conduction
        conduction = steady.tangent(rise, step)
        if conduction is not steady:
            with self._system.phases("condense conduction"):
                face = condense_heat(
                    conduction, face.weights, face.basis, face.traces, face.shift, face.partition
                )
        return HeatOperators(conduction, face, self._distortion, rise)
