"""States of a fretting analysis as rows and tables."""

from __future__ import annotations

import numpy as np

from ...contact.friction.stick_slip_state import StickSlipState
from ...results import CycleRow, FrictionInterface, LoadRow
from ..model.system import System
from .increments import Increment, Jump

_SLIDES = 1 - 1e-6  # fraction of the friction limit from which a point slips


class FrettingTables:
    """Rows and tables of the fretting states of a system."""

    def __init__(self, system: System):
        self._system = system

    def depths(self, state: StickSlipState) -> np.ndarray:
        """Worn depths of both bodies at the contact points, shape (2, n) [m]."""
        system = self._system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = state.worn @ system.basis.T
        return both

    def row(self, instant: Increment) -> LoadRow:
        """Load row at the end of an increment."""
        system, state = self._system, instant.state
        w, pressure = system.weights, system.basis @ state.pressure
        forces, motions = (np.append(v, [0.0, 0.0]) for v in (state.force, state.motion))
        volumes = self.depths(state) @ w
        return LoadRow(
            time=instant.time,
            normal_force=float(forces[0]),
            approach=float(motions[0]),
            tangential_force=float(forces[1]),
            tangential_displacement=float(motions[1]),
            max_pressure=float(pressure.max()),
            contact_area=float(w[pressure > 0].sum()),
            stick_area=float(w[self._sticking(state)].sum()),
            dissipated=float(w @ state.dissipated),
            iterations=state.iterations,
            cycle=instant.leg.cycle,
            wear_volume_1=float(volumes[0]),
            wear_volume_2=float(volumes[1]),
        )

    def cycle(self, instants: list[Increment], jump: Jump) -> CycleRow:
        """Cycle row from the increments of the last cycle of a jump."""
        w, last = self._system.weights, instants[-1]
        end = self.depths(last.state)
        pressures = np.array([i.state.pressure for i in instants]) @ self._system.basis.T
        return CycleRow(
            cycle=last.leg.cycle,
            time=last.time,
            wear_volume_1=float(end[0] @ w),
            wear_volume_2=float(end[1] @ w),
            dissipated=float(w @ last.state.dissipated),
            max_wear_1=float(end[0].max()),
            max_wear_2=float(end[1].max()),
            contact_area=float(w[(pressures > 0).any(axis=0)].sum()),
            max_pressure=float(pressures.max()),
            jump=jump.cycles,
            error=jump.error,
        )

    def friction(self, state: StickSlipState) -> FrictionInterface:
        """Stick and slip at the contact points in a state."""
        system = self._system
        points, pressure = system.pairing.on_body_1, system.basis @ state.pressure
        status = np.where(pressure > 0, np.where(self._sticking(state), 1, 2), 0)
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.pairing.position,
            weight=system.weights,
            pressure=pressure,
            shear=system.basis @ state.shear[:, 0],
            slip=state.point_slip[:, 0],
            dissipated=state.dissipated,
            status=status,
        )

    def _sticking(self, state: StickSlipState) -> np.ndarray:
        """Mask of points with shear below the friction limit, shape (n,)."""
        basis = self._system.basis
        pressure, shear = basis @ state.pressure, basis @ state.shear[:, 0]
        return np.abs(shear) < _SLIDES * self._system.friction * pressure
