"""Implicit step of wear (SDIRK) with an error estimate."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...contact.operators.exchange_matrix import ThermalState
from ...contact.wear.implicit_step import LayeredStep, WearRates
from ...laws.wear import layers_of
from ...serialise import serialisable
from ..heat.heat_steps import StoredHeat
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .condensed_method import ContactSolution

_γ = 1 - 1 / np.sqrt(2)
_ROUNDING = 1e-13  # of the largest pressure so far: no step makes smaller errors
_LEAST_RISE = 10.0  # K; least scale of temperature errors


@serialisable
@dataclass(frozen=True)
class InterfaceState:
    """State of the interface in a running-in.

    Attributes
    ----------
    worn : ndarray, shape (n_wearing, n)
        Wear depths [m].
    contact : ContactSolution
    peak : float
        Largest pressure of the earlier states [Pa].
    faces : ThermalState or None
        Temperatures and fluxes of the faces; None without heat.
    stored : StoredHeat or None
        Stored heat in transient conduction; None if conduction is quasi-steady.
    pointwise : ndarray of bool or None, shape (n,)
        Points at the edge of the wear with pointwise contact, see `contact.wear.wear_edge`.
    removed : ndarray or None, shape (n_wearing, n_interfaces)
        Volume worn off according to the rates at the contacts [m³]; None where nothing wears, and
        in checkpoints of earlier versions.
    touching : ndarray or None, shape (n,)
        Parts of the area that exchange heat in imperfect contact, see `fixed_point`; None if each
        point that presses exchanges it wholly.
    """

    worn: np.ndarray
    contact: ContactSolution
    peak: float = 0.0
    faces: ThermalState | None = None
    stored: StoredHeat | None = None
    pointwise: np.ndarray | None = None
    removed: np.ndarray | None = None
    touching: np.ndarray | None = None

    @property
    def exchanging(self) -> np.ndarray:
        """Points that exchange heat by contact, wholly or in part, shape (n,)."""
        return self.pressure > 0 if self.touching is None else self.touching

    @property
    def pressure(self) -> np.ndarray:
        """Pressure at the points, shape (n,) [Pa]."""
        return self.contact.pressure

    @property
    def largest(self) -> float:
        """Largest pressure so far [Pa]."""
        return max(self.peak, float(self.pressure.max()))

    def range_of_depth(self, interfaces: Sequence[slice]) -> float:
        """Largest range of the depth of both faces [m] over the pressing points of an interface."""
        depth, pressing = self.worn.sum(axis=0), self.pressure > 0.0
        each = (depth[own][pressing[own]] for own in interfaces if pressing[own].any())
        return max((float(np.ptp(own)) for own in each), default=0.0)

    def by_body(self, wearing: Iterable[int]) -> np.ndarray:
        """Wear depths of both bodies, given the indices of the wearing ones, shape (2, n) [m]."""
        both = np.zeros((2, self.worn.shape[1]))
        both[list(wearing)] = self.worn
        return both

    def towards(self, other: InterfaceState, part: float) -> InterfaceState:
        """Interpolate wear and stored heat linearly (or extrapolate) to another state."""
        stored, removed = self.stored, self.removed
        if stored is not None and other.stored is not None:
            stored = stored.towards(other.stored, part)
        if removed is not None and other.removed is not None:
            removed = removed + part * (other.removed - removed)
        worn = self.worn + part * (other.worn - self.worn)
        of_other = other.contact, self.largest, other.faces
        return InterfaceState(worn, *of_other, stored, self.pointwise, removed)


class WearProblem(ABC):
    """Contact of wearing bodies, as time integration sees it; in place or averaged over a cycle.

    Wear depths have shape (n_rows, n), and add up to the gap. The defaults are those of isothermal
    contact without pointwise conditions.
    """

    @abstractmethod
    def start(self) -> InterfaceState:
        """State of the unworn faces at time 0."""

    def begin(self, state: InterfaceState) -> InterfaceState:
        """Choose the settings of a step, common to all its stages and substeps."""
        return state

    @abstractmethod
    def stage(
        self,
        before: InterfaceState,
        step: float,
        time: float,
        guess: InterfaceState,
        last: bool = True,
    ) -> InterfaceState:
        """Implicit Euler step.

        Parameters
        ----------
        before : InterfaceState
            Accumulated wear and heat before the step.
        step, time : float
            Size and end of the step [s].
        guess : InterfaceState
        last : bool, optional
            False if the step goes on from the result, without face temperatures that nothing needs.

        Raises
        ------
        ComputationError
        """

    def prolonged(self, before: InterfaceState, after: InterfaceState, part, step, time):
        """State after the rates at the end of a stage have acted for another time.

        Parameters
        ----------
        before, after : InterfaceState
            States at the beginning and at the end of the stage.
        part : float
            Duration relative to the stage.
        step, time : float
            Size and end of the stage [s].
        """
        return before.towards(after, part)

    def difference(
        self, before: InterfaceState, one: InterfaceState, other: InterfaceState
    ) -> float:
        """Difference of two pressures, the maximum norm where they are continuous in time [Pa].

        Returns the largest pressure if the settings of the step, see `begin`, are not valid for it.

        Parameters
        ----------
        before, one, other : InterfaceState
            States at the beginning, and two at the end of the step.
        """
        return float(np.abs(one.pressure - other.pressure).max())

    def edge_steps(
        self,
        states: tuple[InterfaceState, InterfaceState, InterfaceState],
        step: float,
        time: float,
    ) -> tuple[float, float]:
        """Step sizes that end right behind a time at which the edge of the wear reaches a point.

        Parameters
        ----------
        states : tuple of InterfaceState
            States at the beginning, in the middle and at the end of a step.
        step, time : float
            Size and end of the step [s].

        Returns
        -------
        reached : float
            Size that replaces this step, up to the first point reached in it; 0 without any [s].
        following : float
            Upper bound of the next step; may be infinite [s].
        """
        return 0.0, np.inf

    def difference_inside(self, one: InterfaceState, other: InterfaceState) -> float:
        """Largest temperature difference inside the bodies; 0 without heat beside friction [K]."""
        return 0.0

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end that steps must hit exactly [s]."""
        return ()

    @abstractmethod
    def first_step(self, state: InterfaceState) -> float:
        """Initial step [s]; may be infinite."""

    @abstractmethod
    def distance(self, state: InterfaceState, steady) -> float:
        """Relative distance from the steady state; NaN where that is not known."""


def advance(
    problem: WearProblem, state: InterfaceState, time: float, step: float, last: bool = True
) -> InterfaceState:
    """Step of the two-stage, second-order, L-stable SDIRK method.

    It is stiffly accurate, so the contact conditions hold at the end of the step, and its weights
    are positive, so wear never decreases (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006). Both
    stages are implicit Euler steps of size γ times the step; `last` as in `WearProblem.stage`.

    The rates of the first stage act for a part 1 - γ of the step, then those of the second for a
    part γ. With layers, both are exact in the depth (see `laws.wear`), and the order is the
    same. Where a point passes a border, the pressure has a kink in one of two half steps, which
    makes a quarter of the error of the whole one: the estimate of `advance_with_error` holds.
    """
    first = problem.stage(state, _γ * step, time + _γ * step, state, last=False)
    before = problem.prolonged(state, first, (1 - _γ) / _γ, _γ * step, time + _γ * step)
    second = problem.stage(before, _γ * step, time + step, first, last)
    return replace(second, peak=state.largest)


@dataclass(frozen=True)
class TrialStep:
    """Result of a trial step.

    Attributes
    ----------
    state : InterfaceState
        State at the end of the step.
    error : float
        Relative error estimate.
    reached, following : float
        Step sizes of `WearProblem.edge_steps` [s].
    """

    state: InterfaceState
    error: float
    reached: float = 0.0
    following: float = np.inf


def advance_with_error(
    problem: WearProblem, state: InterfaceState, time: float, step: float
) -> TrialStep:
    """Two half steps, with their error by Richardson extrapolation from one whole step.

    Returns
    -------
    TrialStep
        The state after the two half steps. Its error is the largest of those of pressure (see
        `WearProblem.difference`), of wear, and of transient temperatures: relative to the largest
        pressure, to the largest wear depth and to the largest rise so far, 10 K at least.
        Temperatures are those of the faces, and those inside the bodies where friction is not the
        only heat source. Differences at rounding level do not count where the pressure vanishes.
    """
    # the same points for the whole step and its halves: a change of points is no time error
    state = problem.begin(state)
    whole = advance(problem, state, time, step, last=False)
    middle, halves = _advance_halves(problem, state, time, step)
    rounding = _ROUNDING * halves.largest
    scale = max(float(halves.pressure.max()), rounding)
    errors = [
        _relative(problem.difference(state, halves, whole), scale, rounding),
        _relative(halves.worn - whole.worn, float(halves.worn.max(initial=0.0))),
    ]
    if halves.stored is not None and halves.faces is not None and whole.faces is not None:
        largest = max(halves.stored.largest, _LEAST_RISE)
        errors += [
            _relative(ours - theirs, largest)
            for ours, theirs in zip(halves.faces.rise, whole.faces.rise, strict=True)
        ]
        errors.append(problem.difference_inside(halves, whole) / largest)
    edge = problem.edge_steps((state, middle, halves), step, time + step)
    return TrialStep(halves, max(errors) / 3.0, *edge)


def advance_without_error(
    problem: WearProblem, state: InterfaceState, time: float, step: float
) -> InterfaceState:
    """State after the two half steps of `advance_with_error`, without the whole step."""
    return _advance_halves(problem, problem.begin(state), time, step)[1]


def _advance_halves(
    problem: WearProblem, state: InterfaceState, time: float, step: float
) -> tuple[InterfaceState, InterfaceState]:
    """States after the first and after both half steps."""
    middle = advance(problem, state, time, step / 2, last=False)
    return middle, advance(problem, middle, time + step / 2, step / 2)


def _relative(errors: np.ndarray | float, scale: float, allowed: float = 0.0) -> float:
    """Excess of the largest error over an allowed one, relative to a scale; at least 0."""
    largest = float(np.abs(errors).max(initial=0.0)) - allowed
    return largest / scale if largest > 0.0 else 0.0


_LEVEL = 1e-3
"""Largest variation of the depth, relative to it, of points that pass a border at once."""


class InterfaceWear:
    """Wear of the faces of an interface.

    Attributes
    ----------
    laws : list of Law
        Wear laws of the wearing bodies.
    spreads : list of Distribution
        Distributions of the wear of these bodies.
    layered : bool
        True if a face has layers.
    nothing : ndarray or None, shape (n_wearing, n_interfaces)
        Volumes worn off at the start; None where nothing wears.
    """

    def __init__(self, system: System):
        self.laws, self.spreads = list(system.laws.values()), list(system.spreads.values())
        self._layers = [layers_of(law) for law in self.laws]
        self._ranges = system.contacts.ranges
        self.layered = any(layers.thickness for layers in self._layers)
        self.nothing: np.ndarray | None = None
        if self.laws:
            self.nothing = np.zeros((len(self.laws), len(self._ranges)))
            self._areas, self._weights = system.worn_areas[list(system.laws)], system.weights

    def in_step(self, worn: np.ndarray, rates: WearRates) -> WearRates | LayeredStep:
        """Wear in the time step of some rates, from given depths (n_wearing, n)."""
        return LayeredStep(rates, worn) if self.layered else rates

    def after(
        self, before: InterfaceState, rates: WearRates, pressure: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Depths, and volumes worn off, after the time step of some rates at a pressure (n,)."""
        grown = self.in_step(before.worn, rates).depths(pressure)
        removed = before.removed
        if removed is not None:
            removed = removed + self._removed(rates, grown, pressure)
        return before.worn + grown, removed

    def _removed(self, rates: WearRates, grown: np.ndarray, pressure: np.ndarray) -> np.ndarray:
        """Volumes worn off by the rates where the faces touch, (n_wearing, n_interfaces) [m³].

        Layers under a track wear by the depth of the whole track: their volume is that of the
        depths ``grown`` (n_wearing, n).
        """
        if self.layered:
            volumes = self._areas * grown
        else:
            local = [rates.local(law, row, pressure) for row, law in enumerate(self.laws)]
            volumes = rates.step * self._weights * np.array(local)
        return np.column_stack([volumes[:, own].sum(axis=1) for own in self._ranges])

    def final_rates(self, conditions: InterfaceConditions) -> WearRates:
        """Wear rates of faces that have lost all their layers."""
        substrates = [layers.substrate for layers in self._layers]
        return WearRates(substrates, self.spreads, conditions.wear, conditions.states)

    def below_layers(self, worn: np.ndarray) -> list[np.ndarray]:
        """Points of an interface below the lower border of each layer, shape (n,) each.

        A border that all its points pass nearly at once is left out.
        """
        found = []
        for layers, depth in zip(self._layers, worn, strict=True):
            borders = np.broadcast_to(layers.borders, (len(layers.borders), len(depth)))
            for border in borders[:-1]:
                for own in self._ranges:
                    if depth[own].min() < (1 - _LEVEL) * border[own][0]:
                        below = np.zeros(len(depth), dtype=bool)
                        below[own] = depth[own] >= border[own]
                        found.append(below)
        return found

    def are_left(self, worn: np.ndarray, points: np.ndarray) -> bool:
        """True if the faces have any of their layers left at points selected by a mask (n,)."""
        pairs = zip(self._layers, worn, strict=True)
        return any(bool(np.any((depth < layers.total)[points])) for layers, depth in pairs)
