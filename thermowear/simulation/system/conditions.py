"""Operating conditions at the interfaces at a given time: load, fluid, speed, friction.

The fluid presses on both faces, where they touch and where they are open, besides the contact
pressure: a dead load ``Bᵀ w p_f`` of the bodies. Friction, heat and wear are those of the contact
pressure alone.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from ...contact.operators.exchange_matrix import ThermalState
from ...contact.operators.rigid_motion import RigidMode
from ...errors import ComputationError
from ...laws.histories import LoadHistory
from ...laws.interfaces import Law, LocalState
from ...laws.principle.steady import NotCarried, not_carried
from .rigid_modes import fluid_pressure
from .system import System

_NOTHING = 1e-9  # of the largest load


def fluid_forces(system: System) -> dict[int, float]:
    """Opening force of the fluid along the load direction by interface, where it is given [N]."""
    pressure = fluid_pressure(system.model, system.contacts)
    if pressure is None:
        return {}
    along = np.einsum("ni,ni->n", system.contacts.normals, system.load_directions)
    force = system.weights * along * pressure
    each = enumerate(zip(system.model.interfaces, system.contacts.ranges, strict=True))
    return {
        index: float(force[own].sum())
        for index, (one, own) in each
        if one.fluid_pressure is not None
    }


def parted_by_fluid(system: System, load: np.ndarray) -> ComputationError | None:
    """Error with the forces if the loads are carried without the fluid only; otherwise None.

    Parameters
    ----------
    system : System
    load : ndarray, shape (k,)
        Generalised forces on the free motions, with those of the fluid [N or N m].
    """
    pressure = fluid_pressure(system.model, system.contacts)
    if pressure is None:
        return None
    modes, weights, model = system.holder.modes, system.weights, system.model
    opening = modes.T @ (weights * pressure)
    closing = load + opening
    left = load - _NOTHING * opening  # what is left by rounding carries nothing
    if not_carried(weights, modes, left) is None or not_carried(weights, modes, closing):
        return None
    forces = fluid_forces(system)
    opens = [
        f"{force:.4g} N" + (f" in {name}" if (name := model.interfaces[index].name) else "")
        for index, force in forces.items()
    ]
    loads = [
        f"{force:.4g} {'N m' if mode.motion.rotation.any() else 'N'}"
        for mode, force in zip(_free(system), closing, strict=True)
        if abs(force) > _NOTHING * np.abs(closing).max()
    ]
    table = model.interfaces[max(forces, key=lambda index: forces[index])].table
    return NotCarried(
        f"{table}.fluid_pressure: the fluid parts the faces: it presses with {', '.join(opens)}, "
        f"the loads with {', '.join(loads)}; raise the loads or lower the pressure"
    )


def _free(system: System) -> list[RigidMode]:
    """Rigid modes under a given load."""
    return [mode for mode in system.holder.rigid_modes if mode.load is not None]


_SETTLED = 1e-10
_ROUNDING = 1e-9


@dataclass(frozen=True)
class InterfaceConditions:
    """Operating conditions; arrays of shape (n,) unless stated otherwise.

    Attributes
    ----------
    load : ndarray, shape (k,)
        Generalised forces on the free motions of the holders [N or N m].
    speed : ndarray
        Sliding speed [m/s].
    friction : ndarray
        Coefficient of friction.
    wear : ndarray, shape (n_wearing, n)
        Factor of the wear rate of the first and of the second faces, if any of them wear.
    conductance : ndarray
        Contact conductance; infinite in perfect contact [W/(m² K)].
    temperature, depth : ndarray, shape (n_wearing, n)
        Temperature and wear depth of the wearing faces where the wear law uses them [K, m]; else 0.
    """

    load: np.ndarray
    speed: np.ndarray
    friction: np.ndarray
    wear: np.ndarray
    conductance: np.ndarray
    temperature: np.ndarray
    depth: np.ndarray

    @cached_property
    def heating(self) -> np.ndarray:
        """Friction heat per pressure, ``mu v`` [m/s]."""
        return self.friction * self.speed

    def wear_rate(self, row: int, law: Law, pressure: np.ndarray) -> np.ndarray:
        """Local wear rate of a wearing body at pressures (n,) [m/s]."""
        return self.wear[row] * law.value(LocalState(pressure, *self.states[row]))

    def wear_slope(self, row: int, law: Law, pressure: np.ndarray) -> np.ndarray:
        """Derivative of the wear rate with respect to the pressure [m/(s Pa)]."""
        return self.wear[row] * law.slope(LocalState(pressure, *self.states[row]))

    @cached_property
    def states(self) -> list[tuple[np.ndarray, ...]]:
        """Speed, temperature, depth and friction of each wearing body, as in `LocalState`."""
        bodies = zip(self.temperature, self.depth, strict=True)
        return [(self.speed, own, depth, self.friction) for own, depth in bodies]

    @cached_property
    def released(self) -> bool:
        """True if the load has dropped to zero."""
        return self.load.size > 0 and not self.load.any()

    def same_as(self, other: InterfaceConditions) -> bool:
        """True if the conditions are equal up to rounding."""
        pairs = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return self is other or all(_difference(a, b) <= _SETTLED for a, b in pairs)


def _difference(a: np.ndarray, b: np.ndarray) -> float:
    if a.size == 0 or np.array_equal(a, b):
        return 0.0
    if not np.array_equal(np.isinf(a), np.isinf(b)):
        return np.inf
    a, b = (np.where(np.isinf(values), 0.0, values) for values in (a, b))
    return float(np.abs(a - b).max() / max(np.abs(a).max(), np.abs(b).max()))


def _of_points(state: LocalState, points: slice) -> LocalState:
    """State at a range of the contact points."""
    return LocalState(*(v[points] if isinstance(v, np.ndarray) else v for v in state))


def _part(value: float) -> float:
    """History factor of a load, speed or friction; values at rounding level count as 0."""
    return value if value > _ROUNDING else 0.0


class ConditionModel:
    """Interface conditions as functions of time, pressure and temperature.

    Parameters
    ----------
    system : System

    Attributes
    ----------
    depends_on_state : bool
        True if conditions depend on pressures, temperatures or wear depths.
    constant : bool
        True if they depend on nothing but the points that exchange heat.
    """

    def __init__(self, system: System):
        model = system.model
        self._system = system
        self._interfaces = list(zip(model.interfaces, system.contacts.ranges, strict=True))
        self.depends_on_state = any(interface.varies for interface in model.interfaces)
        self._courses = model.histories
        depths = any("depth" in law.variables for law in system.laws.values())
        self.constant = not self.depends_on_state and not self._courses and not depths

    def at(
        self,
        time: float,
        pressure: np.ndarray,
        faces: ThermalState | None,
        closed: np.ndarray,
        depth: np.ndarray | None = None,
    ) -> InterfaceConditions:
        """Evaluate the conditions at an interface state.

        Parameters
        ----------
        time : float
            [s]
        pressure : ndarray, shape (n,) [Pa]
        faces : ThermalState or None
            Surface temperatures; None: the ambient temperature.
        closed : ndarray, shape (n,)
            Points that exchange heat by contact, wholly or in part: from 0 to 1.
        depth : ndarray, shape (n_wearing, n), optional
            Wear depths of the wearing bodies, by default 0 [m].
        """
        holder = self._system.holder

        def pressed(given: LoadHistory | None) -> float:
            return 1.0 if given is None else _part(given.factor_at(time))

        speed, temperatures = self._speed(time), self._temperatures(faces)
        at = LocalState(pressure, speed, (temperatures[0] + temperatures[1]) / 2)
        friction = self._friction(time, at)
        wear, temperature, worn = self._wear(temperatures, depth, pressure, speed, friction)
        return InterfaceConditions(
            load=holder.load_by(pressed) + holder.dead,
            speed=speed,
            friction=friction,
            wear=wear,
            conductance=self._conductance(at, closed),
            temperature=temperature,
            depth=worn,
        )

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end at which a history has a corner [s]."""
        return tuple(t for course in self._courses for t in course.corners(end))

    def _speed(self, time: float) -> np.ndarray:
        """Sliding speed at the points, shape (n,) [m/s]."""
        histories = [interface.motion.history for interface, _ in self._interfaces]
        parts = [1.0 if given is None else _part(given.at(time)) for given in histories]
        return self._system.contacts.per_point(parts) * self._system.speed

    def _temperatures(self, faces: ThermalState | None) -> np.ndarray:
        """Temperatures of both faces, shape (2, n) [K]; 0 and unused without heat."""
        rise, thermal = np.zeros((2, len(self._system.weights))), self._system.thermal
        if thermal is None:
            return rise
        return thermal.ambient + (rise if faces is None else np.asarray(faces.rise))

    def _friction(self, time: float, at: LocalState) -> np.ndarray:
        """Coefficient of friction, at least 0; `require_friction` checks the converged state."""
        result = np.empty(len(self._system.weights))
        for interface, points in self._interfaces:
            history = interface.friction_history
            factor = 1.0 if history is None else _part(history.at(time))
            value = interface.friction_law.value(_of_points(at, points))
            result[points] = factor * np.maximum(value, 0.0)
        return result

    def require_friction(
        self, time: float, pressure: np.ndarray, faces: ThermalState | None
    ) -> None:
        """Reject a state in which the friction law is negative at a point in contact.

        Raises
        ------
        ComputationError
        """
        mean, speed = self._temperatures(faces).mean(axis=0), self._speed(time)
        for interface, points in self._interfaces:
            if not interface.friction_law.variables:
                continue
            at = _of_points(LocalState(pressure, speed, mean), points)
            value, presses = interface.friction_law.value(at), pressure[points] > 0
            lowest = int(np.argmin(np.where(presses, value, np.inf)))
            if presses[lowest] and value[lowest] < 0:
                p, v, T = (given[points][lowest] for given in (pressure, speed, mean))
                raise ComputationError(
                    f"{interface.table}.friction: {value[lowest]:.4g} at p = {p:.4g} Pa, "
                    f"v = {v:.4g} m/s, T = {T:.4g} K; must not be negative: "
                    "bound the law, max(0.05, …), or reduce load or speed"
                )

    def _wear(self, temperatures, depth, pressure, speed, friction) -> np.ndarray:
        """Factors of the wear rates by tables and friction; temperatures and depths for the laws.

        Each of shape (n_wearing, n), stacked. A state variable that a law does not use is 0.
        """
        laws, pairings = self._system.laws, self._system.contacts.each
        factors, used, depths = result = np.zeros((3, len(laws), len(pressure)))
        for row, (side, law) in enumerate(laws.items()):
            for (interface, points), pairing in zip(self._interfaces, pairings, strict=True):
                if side not in interface.wear:
                    continue
                at = _of_points(LocalState(pressure, speed, temperatures[side]), points)
                varies = interface.friction_varies
                relative = friction[points] / interface.nominal_friction if varies else None
                for group, each in enumerate(interface.wear[side].each):
                    own = pairing.groups[side] == group
                    np.copyto(factors[row, points], each.factor(at, relative), where=own)
            if "T" in law.variables:
                used[row] = temperatures[side]
            if "depth" in law.variables and depth is not None:
                depths[row] = depth[row]
        return result

    @cached_property
    def _conductance_laws(self) -> list[Law | None]:
        materials, facing = self._system.model.materials, self._system.facing
        each = zip(self._interfaces, facing, strict=True)
        return [interface.conductance_law(parts, materials) for (interface, _), parts in each]

    def _conductance(self, at: LocalState, touching: np.ndarray) -> np.ndarray:
        """Conductance of touching points and of the gap at the others, shape (n,) [W/(m² K)].

        In between it is that of a part of the area, perfect contact included.
        """
        result, system = np.zeros(len(touching)), self._system
        if system.thermal is None:
            return result
        for (interface, points), law in zip(self._interfaces, self._conductance_laws, strict=True):
            closed = np.inf if law is None else law.value(_of_points(at, points))
            part, open_ = touching[points].astype(float), interface.gap_conductance
            some = (part > 0.0) & (part < 1.0)
            perfect = self._conducted / np.where(some, 1 - part, 1.0)
            inside = np.where(np.isinf(closed), perfect, closed)
            partly = open_ + part * (inside - open_)
            result[points] = np.where(some, partly, np.where(part > 0.0, closed, open_))
        return result

    @cached_property
    def _conducted(self) -> float:
        """Conductance of the size of that of the bodies behind a point [W/(m² K)]."""
        materials = self._system.model.materials.values()
        largest = max(one.conductivity or 0.0 for one in materials)
        return largest / max(pairing.extent for pairing in self._system.contacts.each)
