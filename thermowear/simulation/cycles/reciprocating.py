"""Reciprocating sliding wear in time, to an end time or to the steady state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...contact.search.pairing import Pairing
from ...contact.wear.worn_profile import StrokeGrid, SweptSurface
from ...model.analyses import ReciprocatingAnalysis
from ...results import ContactRow, HistoryRow, WornTrack
from ...results.short_names import by_name
from ..interface.body_state import contact_state
from ..interface.interface_problem import interface_problem
from ..interface.sdirk import InterfaceState
from ..results.recording import Snapshot, snapshot
from ..runtime.history import AnalysisHistory
from ..runtime.observer import Observer
from ..system.system import System
from ..time_loop import AnySize, Moment, moments
from .reciprocating_problem import ReciprocatingProblem
from .stroke import positions, strokes


class ReciprocatingHistory(AnalysisHistory[Moment]):
    """History of cycle-averaged wear in reciprocating sliding."""

    def __init__(self, system: System, settings: ReciprocatingAnalysis, observer: Observer):
        super().__init__(system, settings, observer)
        self._timed = settings
        stroke = positions(system, settings)
        self._problem = ReciprocatingProblem(system, stroke, strokes(system.model, settings))

    def states(self, last: Moment | None) -> Iterator[Moment]:
        sizes = AnySize(self._timed.max_jump / self._timed.frequency)
        return moments(self._problem, self._timed, None, sizes, last)

    def rows_of(self, moment: Moment) -> list[HistoryRow | ContactRow]:
        system, state = self._system, moment.state
        volumes, deepest = self._volumes(state.worn[0]), self._deepest(state.worn)
        mean_speed = float(np.average(system.speed, weights=system.weights))
        cycle = self._problem.of_cycle(state.contact)
        row = HistoryRow(
            time=moment.time,
            sliding_distance=mean_speed * moment.time,
            max_pressure=float(cycle.largest.max()),
            contact_area=float(cycle.area.sum()),
            wear_volume_1=float(volumes[0].sum()),
            wear_volume_2=float(volumes[1].sum()),
            max_temperature=float("nan"),
            approach=float(system.approaches @ cycle.motion),
            step=moment.step,
            error=moment.error,
            max_wear_1=deepest[0],
            max_wear_2=deepest[1],
            friction_power=float(cycle.power.sum()),
            friction_force=float(cycle.friction[0]) if len(cycle.friction) == 1 else float("nan"),
            friction_torque=float("nan"),
        )
        return [row, *self._contact_rows(moment)]

    def _contact_rows(self, moment: Moment) -> list[ContactRow]:
        """Rows of the contacts with names: forces and areas are means of the cycle."""
        cycle, nothing = self._problem.of_cycle(moment.state.contact), float("nan")
        volumes = self._volumes(moment.state.worn[0])
        return [
            ContactRow(
                time=moment.time,
                contact=k + 1,
                normal_force=float(cycle.force[k]),
                friction_power=float(cycle.power[k]),
                max_pressure=float(cycle.largest[k]),
                contact_area=float(cycle.area[k]),
                wear_volume_1=float(volumes[0, k]),
                wear_volume_2=float(volumes[1, k]),
                max_temperature_1=nothing,
                max_temperature_2=nothing,
            )
            for k, interface in enumerate(self._system.model.interfaces)
            if interface.name
        ]

    def snapshot(self, moment: Moment) -> Snapshot:
        """Contact and bodies at mid-stroke, and the worn track; every rank calls."""
        system, state = self._system, moment.state
        worn, rates = (
            self._at_points(v) for v in (state.worn, self._problem.rates(state.pressure))
        )
        solution = interface_problem(system).worn(worn.sum(axis=0))
        contact = contact_state(system, solution.pressure)
        found = snapshot(system, contact, system.motions(solution.motion), worn, rates)
        return replace(found, track=self._worn_track(state))

    def _worn_track(self, state: InterfaceState) -> WornTrack:
        """Worn depths and wear rates along the faces of the swept bodies."""
        grids, rates = self._problem.track.each, self._problem.rates(state.pressure)
        pairs = zip(self._system.contacts.each, grids, strict=True)
        x, y, z, area = np.concatenate([_places(pairing, grid) for pairing, grid in pairs]).T
        counts = tuple(len(grid.areas) for grid in grids)
        first = np.repeat(self._system.contacts.carriers == 1, counts)
        both = np.array([self._problem.split(of)[1] for of in (state.worn, rates)])
        (wear_1, rate_1), (wear_2, rate_2) = (np.where(k, both, np.nan) for k in (first, ~first))
        return WornTrack(x, y, z, area, wear_1, wear_2, rate_1, rate_2, counts)

    def summary(self) -> dict:
        rows, pressure = self.table(HistoryRow), self.last.state.pressure
        row, rates = rows[-1], self._problem.rates(pressure)[0]
        lengths, worn = self._volumes(np.ones_like(rates)), self._volumes(rates)
        means = worn.sum(axis=1) / lengths.sum(axis=1)
        return {
            "steps": len(rows) - 1,
            "time_s": row.time,
            "cycles": row.time * self._timed.frequency,
            "sliding_distance_m": row.sliding_distance,
            "distance_from_steady": self.last.distance,
            "max_pressure_of_cycle_Pa": row.max_pressure,
            "wear_volume_1_m3": row.wear_volume_1,
            "wear_volume_2_m3": row.wear_volume_2,
            "mean_wear_rate_1_m_per_s": float(means[0]),
            "mean_wear_rate_2_m_per_s": float(means[1]),
            **self._of_parts(worn / lengths, self._volumes(self.last.state.worn[0])),
        }

    def _of_parts(self, means: np.ndarray, volumes: np.ndarray) -> dict:
        """Numbers of each contact and body, from arrays (2, n_interfaces)."""
        model = self._system.model
        contacts, bodies = {}, dict.fromkeys((body.name for body in model.bodies), 0.0)
        for k, interface in enumerate(model.interfaces):
            contacts[interface.name] = {
                f"{name}_{side + 1}_{unit}": float(values[side, k])
                for name, unit, values in (
                    ("wear_volume", "m3", volumes),
                    ("mean_wear_rate", "m_per_s", means),
                )
                for side in (0, 1)
            }
            for side, body in enumerate(interface.bodies):
                bodies[model.bodies[body].name] += float(volumes[side, k])
        worn = {name: {"wear_volume_m3": volume} for name, volume in bodies.items()}
        return by_name("contacts", contacts) | {"bodies": worn}

    def _at_points(self, depths: np.ndarray) -> np.ndarray:
        """Depths (or rates) of both bodies at the mid-stroke points, shape (2, n)."""
        system, (carried, swept) = self._system, self._problem.split(depths)
        hats = self._problem.track.hats(system.contacts)
        return system.contacts.by_side(np.array([system.basis @ carried, hats @ swept]))

    def _deepest(self, depths: np.ndarray) -> list[float]:
        """Largest depth of the first and of the second bodies [m]."""
        contacts, (carried, swept) = self._system.contacts, self._problem.split(depths)
        parts = zip(contacts.ranges, self._problem.track.ranges, strict=True)
        found = [[(self._system.basis[k] @ carried).max(), swept[j].max()] for k, j in parts]
        return [float(of) for of in contacts.by_side(np.array(found).T).max(axis=1)]

    def _volumes(self, depths: np.ndarray) -> np.ndarray:
        """Integrals of depths (N,) over the faces, shape (2, n_interfaces) [m³]."""
        problem = self._problem
        ranges = problem.functions, problem.track.ranges
        sides = zip(problem.split(depths[None]), problem.areas, ranges, strict=True)
        found = [[v[k] @ area[k] for k in own] for v, area, own in sides]
        return self._system.contacts.by_side(np.array(found))


def _places(pairing: Pairing, grid: StrokeGrid | SweptSurface) -> np.ndarray:
    """Coordinates and areas of the nodes of a grid, (n_nodes, 4); of a section only x [m, m²]."""
    if isinstance(grid, SweptSurface):
        return np.column_stack([grid.nodes, grid.areas])
    face = pairing.opposite.face
    ends = face.position(np.arange(len(face.nodes)), np.ones(len(face.nodes)))
    x = np.interp(
        grid.position,
        np.concatenate([[0.0], ends]),
        np.concatenate([face.nodes[:1, 0, 0], face.nodes[:, -1, 0]]),
    )
    return np.column_stack([x, np.full((len(x), 3), np.nan)])
