"""Outer loop of a transient analysis: meshes are moved to the worn faces when wear is large.

Contact, heat and wear are integrated in time on fixed meshes, with the wear since the last update
kept in the gap. When it exceeds a fraction of the dimensions of the bodies, the meshes are moved
and time integration continues. The fraction follows from the change by the last update.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from ...contact.search.refinement import Rule
from ...errors import ComputationError
from ...geometry.mesh.tagged import TaggedMesh
from ...geometry.moving.new_face import NewFace
from ...model.analyses import TransientAnalysis
from ...serialise import serialisable
from ..interface.factory import interface_problem
from ..interface.interface_problem import InterfaceProblem
from ..interface.sdirk import advance_with_error
from ..interface.steady import SteadyState
from ..runtime.observer import Observer
from ..system.building import build
from ..system.setup_cache import SetupCache
from ..system.system import System
from ..system.worn_geometry import WornGeometry
from ..time.step_sizes import StepSizes
from ..time.time_loop import Moment, is_over, moments
from .gap_wear import GapWear
from .geometry_update import updated
from .update_counts import UpdateCounts
from .wider_zone import meshed_wider, wider_zone

_CHANGE = 5e-3
"""Target change of pressure and temperatures by an automatic update."""
_OVER = 0.1
"""Overshoot of the allowed fraction that a step may cause, relative to it."""
_ROOM = 5.0
"""Upper limit of the allowed fraction, as a multiple of the automatic one."""

Principle = Callable[[System], SteadyState | None]
"""Steady state that a system approaches; None if there is none."""

serialisable(WornGeometry)
serialisable(TaggedMesh)
serialisable(NewFace)
serialisable(Rule)


class OuterLoop:
    """Time loop of a transient analysis with geometry updates between its moments.

    Parameters
    ----------
    system : System
        System of the unworn bodies.
    settings : TransientAnalysis
    problem : InterfaceProblem
    principle : callable
        Function of a system for its steady state; None if there is none.
    sizes : StepSizes
    observer : Observer

    Attributes
    ----------
    system : System
        System at the last moment.
    problem : InterfaceProblem
        Interface problem at the last moment.
    steady : SteadyState or None
        Steady state at the last moment.
    largest_kept : float
        Largest wear kept in the gap so far, relative to the dimensions of the bodies.
    allowed : float
        Largest wear that may be kept now, relative to the dimensions of the bodies.
    earlier : UpdateCounts
        Counts of the updates of meshes for narrower zones.
    """

    def __init__(
        self,
        system: System,
        settings: TransientAnalysis,
        problem: InterfaceProblem,
        principle: Principle,
        sizes: StepSizes,
        observer: Observer,
    ):
        self.system, self.problem, self.steady = system, problem, principle(system)
        self.largest_kept = 0.0
        self.allowed = settings.largest_kept
        self._settings = settings
        self._principle = principle
        self._sizes = sizes
        self._observer = observer
        self._narrow = ""
        self.earlier = UpdateCounts()

    def restart_data(self) -> tuple:
        """Worn geometry, zone of the mesh [m], counts for earlier zones, limits of kept wear."""
        limits = self.largest_kept, self.allowed, self._sizes.largest
        return self.system.worn, self.system.zone, self.earlier, limits

    def restore(self, data: tuple) -> None:
        """Restore an earlier loop after its last update or wider zone, if any."""
        worn, zone, self.earlier, limits = data
        self.largest_kept, self.allowed, self._sizes.largest = limits
        unworn = self.system
        zone = unworn.zone if zone is None else zone
        if worn is None and zone == unworn.zone:
            return
        self.system = build(unworn.model, unworn.comm, unworn.phases, zone, SetupCache(), worn)
        self.problem, self.steady = interface_problem(self.system), self._principle(self.system)

    def moments(self, last: Moment | None = None) -> Iterator[Moment]:
        """Accepted moments, see `time_loop.moments`."""
        system, problem, steady = self.system, self.problem, self.steady
        settings = self._settings
        kept, fraction = self._kept_wear(system, last)
        while True:
            if last is not None and self._widens(system, last):
                system, problem, last = self._widen(system, problem, last)
                steady = self._principle(system)
                kept, fraction = self._kept_wear(system, last)
            if kept is not None and last is not None and self._is_due(kept, fraction, last):
                system, problem, last = self._update(system, problem, kept, last)
                steady = self._principle(system)
                kept, fraction = GapWear(system), 0.0
            for moment in self._told(moments(problem, settings, steady, self._sizes, last)):
                if kept is not None:
                    before, fraction = fraction, kept.fraction(kept.depth(moment.state.worn))
                    self._look_ahead(fraction, fraction - before, moment.step)
                    if system.worn is not None and is_over(settings, problem, moment):
                        assert last is not None
                        system, problem, moment = self._end(system, problem, kept, last, moment)
                        steady = self._principle(system)
                self.system, self.problem, self.steady = system, problem, steady
                yield moment
                last = moment
                if self._widens(system, last):
                    break
                if kept is not None and self._is_due(kept, fraction, last):
                    break
            else:
                return

    def summary(self) -> dict[str, float | int]:
        """Summary entries of the geometry updates; empty without updates."""
        worn = self.system.worn
        counts = self.earlier.counting(worn)
        if counts.updates == 0:
            return {}
        lost = np.zeros(2) if worn is None else worn.lost
        return {
            "geometry_updates": counts.updates,
            "geometry_largest_kept": self.largest_kept,
            "geometry_smallest_scaled_jacobian": counts.quality,
            "geometry_volume_1_m3": float(lost[0]),
            "geometry_volume_2_m3": float(lost[1]),
            "geometry_volume_error": counts.volume_error,
            "geometry_change": counts.change,
            "geometry_temperature_error": counts.heat_error,
            "geometry_meshed_anew": counts.meshed_anew,
            "geometry_remeshing_error": counts.carrying_error,
        }

    def _told(self, passing: Iterator[Moment]) -> Iterator[Moment]:
        """Pass the moments on; add to an error that the contact has outgrown the meshed zone."""
        try:
            yield from passing
        except ComputationError as reason:
            if not self._narrow:
                raise
            raise ComputationError(
                f"{reason}; the contact has grown beyond the zone that is meshed for it, which "
                f"cannot be wider: {self._narrow}"
            ) from None

    def _kept_wear(self, system: System, last: Moment | None) -> tuple[GapWear | None, float]:
        """Wear kept in the gap (None if meshes cannot be moved), and its fraction."""
        kept = GapWear(system) if self._moves else None
        if kept is None or last is None:
            return kept, 0.0
        return kept, kept.fraction(kept.depth(last.state.worn))

    def _widens(self, system: System, moment: Moment) -> bool:
        """True if a wearing contact has outgrown its zone before the end of the run."""
        settings = self._settings
        if self._narrow or not moment.state.worn.any() or is_over(settings, self.problem, moment):
            return False
        return wider_zone(system, moment.state.pressure) is not None

    def _widen(self, system: System, problem: InterfaceProblem, last: Moment):
        """System, problem and moment on a mesh for a wider zone; unchanged if there is none."""
        zone = wider_zone(system, last.state.pressure)
        assert zone is not None
        found = meshed_wider(system, problem, last.state, last.time, zone)
        if isinstance(found, str):
            self._narrow = found
            return system, problem, last
        self._observer.note(
            f"at {last.time:.4g} s the contact has grown beyond the zone that was meshed for it; "
            f"from there on the mesh is made for x = {zone[0]:.4g} to {zone[1]:.4g} m "
            "(a larger geometry.zone avoids that)"
        )
        self.earlier = self.earlier.counting(system.worn)
        return found[0], found[1], replace(last, state=found[2])

    @property
    def _moves(self) -> bool:
        """True if geometry updates are enabled."""
        return bool(np.isfinite(self.allowed))

    def _is_due(self, kept: GapWear, fraction: float, moment: Moment) -> bool:
        """True if the kept wear that the nodes can follow exceeds the allowed fraction.

        Always False at the end of the run.
        """
        if fraction <= self.allowed or is_over(self._settings, self.problem, moment):
            return False
        return kept.fraction(kept.movable(kept.depth(moment.state.worn))) > self.allowed

    def _look_ahead(self, fraction: float, grown: float, step: float) -> None:
        """Limit the next step so that the kept wear hardly exceeds the allowed fraction."""
        self.largest_kept = max(self.largest_kept, fraction)
        self._sizes.largest = np.inf
        if grown > 0.0:
            left = self.allowed - fraction
            left = self.allowed if left <= 0.0 else max(left, _OVER * self.allowed)
            self._sizes.largest = step * left / grown

    def _end(self, system, problem, kept, before: Moment, last: Moment):
        """System, problem and moment after a final update, so that the run ends with worn meshes.

        If the update disturbs the pressure, the last step is repeated to wear the disturbance off;
        not for transient temperatures, which are known at the end of the step only.
        """
        pressure, grown = last.state.pressure, last.state.worn - before.state.worn
        system, problem, last = self._update(system, problem, kept, last)
        grown, expected = (system.worn.carried(v, system.pairing) for v in (grown, pressure))
        disturbed = float(np.abs(last.state.pressure - expected).max())
        allowed = self._settings.tolerance * float(expected.max())
        if last.state.stored is not None or disturbed <= allowed:
            return system, problem, last
        start = replace(last.state, worn=last.state.worn - grown)
        again = advance_with_error(problem, start, before.time, last.step)
        return system, problem, replace(last, state=again.state)

    def _update(self, system, problem, kept, last: Moment):
        """System, problem and moment after moving the meshes; adapts the allowed fraction."""
        new = updated(system, problem, kept, last.state, last.time)
        change = new.change
        automatic = self._settings.largest_kept
        if self._settings.adapts and change > 0.0:
            wished = self.allowed * float(np.clip(_CHANGE / change, 0.2, 2.0))
            self.allowed = float(np.clip(wished, 0.01 * automatic, _ROOM * automatic))
        return new.system, new.problem, replace(last, state=new.state)
