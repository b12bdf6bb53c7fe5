"""Cycle-averaged contact and wear in reciprocating sliding, and its distance from the steady state.

The wear of one cycle is small, so that depths are constant during a cycle. The carrying body, 1,
loses W1 at its points x, the swept one, 2, loses W2 at its points ξ. At each position X_j the
contact has the gap

    g0 + W1(x) + W2(x + X_j) + C_j p_j - R d_j,

and the rates, averaged over the cycle with time shares c_j, follow from the local speeds v_j::

    W1'(x) = Σ_j c_j κ1 p_j(x)^b |v_j|^a,      W2'(ξ) = Σ_j c_j κ2 p_j(ξ - X_j)^b |v_j|^a

W1 has coefficients in the pressure basis, like fretting wear; for W2 see
`contact.wear.worn_profile`.

Steady state. Steady pressures need ``W1'(x) + W2'(x + X) = V(X)`` wherever the faces touch, V being
the approach rate of a holder that does not rotate. The derivative along x gives
``W1''(x) = -W2''(x + X)`` for all X, so that both slopes are opposite constants, which vanish for a
symmetric stroke. Both rates are then uniform for any pressures, and for ``a = b = 1`` the load
determines them: with the mean speed v, the half-width h and the thickness t of body 1, and the
amplitude A, ``W1' = κ1 F v / (2 h t)`` and ``W2' = κ2 F v / (2 (h + A) t)``.

The ends of the faces are left out of the distance from it: at the turning points the edge of the
carrying body carries half the load, which no mesh resolves.

In space the same holds on each line along the stroke, and ``W1' + W2' = V`` on all of them. With
the length l of the face on a line ``V = F v / ∫ dy / (κ1/l + κ2/(l + 2 A))``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...contact.operators.pressure import dense, function_ranges
from ...contact.search.pairing import Pairing
from ...contact.solvers.coupled_positions import CoupledSolution, solve_coupled
from ...contact.solvers.signorini import solve_contact
from ...contact.wear.implicit_step import Slope, newton_with_wear
from ...contact.wear.worn_profile import StrokeGrid, StrokeGrids, SweptSurface, swept_surface, track
from ...errors import ComputationError
from ..interface.condensed_method import ContactSolution
from ..interface.sdirk import InterfaceState, WearProblem
from ..system.system import System
from .stroke import CycleContact, Position, condensed, local_wear, stroke_distribution

_INNER = 0.9
"""Part of the faces that is compared."""

Unevenness = Callable[[np.ndarray, np.ndarray], float]
"""Largest relative deviation of wear rates from their mean, of the coefficients of the carrying
bodies (m,) and the nodal values of the swept ones (n_nodes,)."""


def unevenness(
    system: System, stroke: list[Position], track: StrokeGrids, functions: tuple[slice, ...]
) -> Unevenness:
    """Measure of the distance from the steady state of a stroke.

    In a section the rates of each face are compared with their mean; in space, where they depend on
    the length of the face along the stroke, the sums of opposite points in all positions with their
    mean, relative to the mean rate of the face that wears less.

    Parameters
    ----------
    system : System
        Bodies in the middle of the stroke.
    stroke : list of Position
    track : StrokeGrids
    functions : tuple of slice
        Range of the coefficients of each interface.
    """
    if system.contacts.in_space:
        return _by_closing(stroke, track)
    weighted = dense(system.contact.weighted)
    position = np.concatenate([pairing.carrying.position for pairing in system.contacts.each])
    places = (position @ weighted) / weighted.sum(axis=0)
    on_1 = [(own, places[own]) for own in functions]
    grids = zip(track.ranges, track.each, strict=True)
    on_2 = [(own, grid.position) for own, grid in grids if isinstance(grid, StrokeGrid)]

    def measure(rates_1: np.ndarray, rates_2: np.ndarray) -> float:
        parts = [(rates_1[own], at) for own, at in on_1]
        parts += [(rates_2[own], at) for own, at in on_2]
        return max(_deviation(rate[_within(at)]) for rate, at in parts if rate.any())

    return measure


def _by_closing(stroke: list[Position], track: StrokeGrids) -> Unevenness:
    """Measure by the closing rates at the contact points of each interface in space."""
    systems = {position.offset: position.system for position in stroke}  # one of both directions
    rows = []
    for offset, system in systems.items():
        hats = track.hats(system.contacts)
        parts = zip(track.each, system.contacts, track.strokes, strict=True)
        for index, (grid, (pairing, points), ratio) in enumerate(parts):
            assert isinstance(grid, SweptSurface)
            inner = (
                np.flatnonzero(
                    grid.inner(pairing, ratio * offset * (-1) ** pairing.carrier, _INNER)
                )
                + points.start
            )
            rows.append((index, system.basis[inner], hats[inner]))

    def measure(rates_1: np.ndarray, rates_2: np.ndarray) -> float:
        found = []
        for index in range(len(track.each)):
            own = [(on_1 @ rates_1, on_2 @ rates_2) for k, on_1, on_2 in rows if k == index]
            both = np.hstack(own)
            means = both.mean(axis=1)
            least = means[means > 0.0].min()
            found.append(float(np.abs(both.sum(axis=0) - means.sum()).max() / least))
        return max(found)

    return measure


def _within(place: np.ndarray) -> np.ndarray:
    return np.abs(place - (place[0] + place[-1]) / 2) <= _INNER * (place[-1] - place[0]) / 2


def _deviation(rates: np.ndarray) -> float:
    return float(np.abs(rates / rates.mean() - 1).max())


class ReciprocatingProblem(WearProblem):
    """Contact in all positions of the stroke, coupled by the worn depths.

    Depths form one row of N values: coefficients of the carrying bodies, then nodal values of the
    swept ones. Pressures have one row per position, shape (J, m).

    Attributes
    ----------
    track : StrokeGrids
        Grids of the depths of the swept bodies.
    areas : tuple of ndarray, shape (m,) and (n_nodes,)
        Areas of the depth values of the carrying and of the swept bodies [m²].
    functions : tuple of slice
        Range of the coefficients of each interface.
    """

    track: StrokeGrids
    areas: tuple[np.ndarray, np.ndarray]
    functions: tuple[slice, ...]

    def __init__(self, system: System, stroke: list[Position], strokes: np.ndarray):
        self._systems = [position.system for position in stroke]
        self._holder, contacts = system.holder, system.contacts
        self.functions = function_ranges(contacts, system.basis)
        speeds = np.array([[position.speed] for position in stroke])
        self._local = local_wear(system, self.functions, speeds, strokes)
        self._lengths = [_length(pairing) for pairing in contacts.each]
        self.track = StrokeGrids(
            tuple(self._grid(system, stroke, k, float(abs(s))) for k, s in enumerate(strokes)),
            tuple(map(float, strokes)),
        )
        self._contacts = condensed(stroke, self.track)
        self._shares = np.array([position.share for position in stroke])
        weighted = dense(system.contact.weighted)
        self.areas = weighted.sum(axis=0), self.track.areas
        self._unevenness = unevenness(system, stroke, self.track, self.functions)
        self._spread = stroke_distribution(self._contacts, self.track, self._shares)

    def _grid(
        self, system: System, stroke: list[Position], index: int, ratio: float
    ) -> StrokeGrid | SweptSurface:
        """Grid of an interface with a stroke relative to that given."""
        pairings = [there.contacts.each[index] for there in self._systems]
        lengths = [ratio * position.length for position in stroke]
        own = self.functions[index]
        # resolution is limited by the parts of the stroke and by the pressure basis
        part, count = float(np.mean(lengths)), own.stop - own.start
        if not system.contacts.in_space:
            spacing = max(part, self._lengths[index] / count)
            return track(pairings, lengths, spacing, system.model.thickness or 1.0)
        pairing = system.contacts.each[index]
        apart = float(np.sqrt(pairing.weights.sum() / count))
        reach = max(ratio * (abs(position.offset) + position.length / 2) for position in stroke)
        return swept_surface(pairing, reach, (max(part, apart), apart))

    def split(self, depths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of the carrying bodies, shape (m,), and nodal values of the swept ones."""
        m = self._contacts.gap.shape[1]
        return depths[0, :m], depths[0, m:]

    def start(self) -> InterfaceState:
        """Contact of the unworn faces in all positions."""
        all_of = self._contacts
        each = zip(all_of.compliance, all_of.gap, all_of.modes, all_of.force_modes, strict=True)
        found = [
            solve_contact(compliance, gap, modes, all_of.load, force_modes=force_modes)
            for compliance, gap, modes, force_modes in each
        ]
        λ, motion, active = (
            np.array([getattr(solution, name) for solution in found])
            for name in ("coefficients", "motion", "active")
        )
        zeros = np.zeros(all_of.gap_per_depth.shape[2])
        contact = self._contact(CoupledSolution(λ, motion, active, zeros))
        return InterfaceState(np.zeros_like(self.rates(contact.pressure)), contact)

    def rates(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates of all depths, averaged over the cycle, shape (1, N) [m/s].

        Parameters
        ----------
        pressure : ndarray, shape (J, m)
            Coefficients [Pa].
        """
        return np.einsum("bjnm,bjm->n", self._spread, self._local.value(pressure))[None]

    def of_cycle(self, contact: ContactSolution) -> CycleContact:
        """Pressures, areas and forces of the cycle."""
        rows = []
        for system, λ in zip(self._systems, contact.pressure, strict=True):
            p, w, own = system.basis @ λ, system.weights, system.contacts.ranges
            terms = (
                w * (p > 0),
                w * system.friction * p,
                w * system.friction * p * system.speed,
            )
            sums = [[p[k].max(), *(term[k].sum() for term in terms)] for k in own]
            rows.append(np.column_stack([sums, system.normal_forces(p)]))
        largest, *means = np.moveaxis(np.array(rows, dtype=float), 2, 0)
        area, friction, power, force = (self._shares @ mean for mean in means)
        motion = self._shares @ contact.motion
        return CycleContact(largest.max(axis=0), area, force, friction, power, motion)

    def first_step(self, state: InterfaceState) -> float:
        """Step in which wear is small compared with the elastic deflection of the bodies [s]."""
        opened = np.einsum("jmn,jn->jm", self._contacts.compliance, state.pressure)
        fastest = float(self.rates(state.pressure).max())
        return 1e-3 * float((opened / self.areas[0]).max()) / fastest if fastest > 0.0 else np.inf

    def distance(self, state: InterfaceState, steady) -> float:
        """Nonuniformity of the wear rates, see `unevenness`."""
        return self._unevenness(*self.split(self.rates(state.pressure)))

    def stage(
        self,
        before: InterfaceState,
        step: float,
        time: float,
        guess: InterfaceState,
        last: bool = True,
    ) -> InterfaceState:
        """End of an implicit Euler step of wear."""
        contact = self._solve(before.worn[0], step, guess.contact)
        return replace(
            before, worn=before.worn + step * self.rates(contact.pressure), contact=contact
        )

    def _solve(self, worn: np.ndarray, step: float, guess: ContactSolution) -> ContactSolution:
        """Contact at the end of a step.

        Parameters
        ----------
        worn : ndarray, shape (N,)
            Depths before the step [m].
        step : float
            [s]
        guess : ContactSolution

        Raises
        ------
        ComputationError
        """
        if worn.max() > min(self._lengths):
            raise ComputationError(
                "wear: the worn depth exceeds the length of the contact; to reach the steady "
                "state, use more elements or a larger analysis.steady_tolerance"
            )

        def solve(start: np.ndarray, slope: Slope, last: ContactSolution) -> ContactSolution:
            gains = step * np.einsum("bjnm,bjm->jnm", self._spread, slope.point)
            depths = worn + step * np.einsum("bjnm,bjm->n", self._spread, start)
            return self._contact(
                solve_coupled(self._contacts, depths, gains, last.warm_start.active)
            )

        return newton_with_wear(solve, self._local, guess)

    def _contact(self, solution: CoupledSolution) -> ContactSolution:
        motion = np.array([self._holder.amplitudes(d) for d in solution.motion])
        return ContactSolution(np.maximum(solution.coefficients, 0.0), motion, solution)


def _length(pairing: Pairing) -> float:
    """Length of the carrying face; in space its size [m]."""
    end = float(pairing.carrying.position.max())
    return pairing.extent if np.isnan(end) else end
