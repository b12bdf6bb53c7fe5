"""Contact on the full system: Newton's method on all nodal displacements.

Solves the equations of `equations` without condensation: an independent check of the condensed
solution, and a basis for nonlinear bulk behaviour.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy
import scipy.sparse as sp

from ...errors import ComputationError
from ...serialise import serialisable
from ..operators.pressure import Basis, PressureSpace, scaled
from ..search.pairing import Pairing
from ..solvers.signorini import solve_contact
from .edge_deflection import EdgeDeflection
from .equations import ContactEquations, Loading

_TOLERANCE = 1e-10
_STAGNATION_TOLERANCE = 1e-8
"""Relative residual accepted when rounding prevents a further reduction."""
_MAX_ITERATIONS = 25
_MIN_LOAD_STEP = 1 / 16
_COARSE_FUNCTIONS = {1: (24, 5), 2: (8, 3)}
"""Number of pressure functions along each direction of the coarse problem that gives the initial
guess, and number of them across the contact that suffices, by the dimension of the face."""
_MAX_REFINEMENTS = 3
"""Largest number of coarse refinements."""
_ACTIVE_PRESSURE_RATIO = 0.15
"""Fraction of the coarse peak pressure above which points are active at first: too small a contact
gains all penetrating points at once, while too large a contact loses only its outermost points in
each iteration."""
_ONE_DIRECTION = 1e-9
"""Relative size of the components at rounding level of directions that are all the same."""
_MAX_WORK_RATIO = 0.9
"""Largest ratio of the residual work at the end of a full step to that at its start."""


@serialisable
@dataclass(frozen=True)
class FullSolution:
    """Contact solution of the full system.

    Attributes
    ----------
    displacement : ndarray, shape (n_owned,) [m]
    motion : ndarray, shape (k,)
        Motion d of the holder.
    pressure : ndarray, shape (n,) [Pa]
    iterations : int
        Newton iterations over all load steps.
    """

    displacement: np.ndarray
    motion: np.ndarray
    pressure: np.ndarray
    iterations: int

    @property
    def active(self) -> np.ndarray:
        """Points with positive pressure, shape (n,)."""
        return self.pressure > 0.0


def resolved_pressure(
    basis: Basis, weights: np.ndarray, pressure: np.ndarray, directions: np.ndarray
) -> np.ndarray:
    """Pressure without tension in the pressure space nearest to one of single points, (n,) [Pa].

    Of equal resultant force. Without a pressure space, pressures scatter in cells that the edge of
    contact crosses, and follow what is singular as far as the points do; this is what converges.

    Parameters
    ----------
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ.
    weights, pressure : ndarray, shape (n,)
    directions : ndarray, shape (n, gdim)
        Traction per pressure.
    """
    space = PressureSpace(basis, scaled(weights, basis))
    # on a plane face with friction all are one direction: one condition, not one for each component
    _, sizes, axes = np.linalg.svd(directions, full_matrices=False)
    directions = directions @ axes[sizes > _ONE_DIRECTION * sizes[0]].T
    areas, force = space.weak(directions), directions.T @ (weights * pressure)
    return basis @ solve_contact(space.mass, -space.weak(pressure), areas, force).coefficients


class FullContact(ContactEquations):
    """Contact of two elastic bodies; parameters as in `ContactEquations`.

    All methods are collective: every rank calls them.
    """

    def solve(
        self,
        gap: np.ndarray,
        load: np.ndarray,
        compliance: np.ndarray | None = None,
        nodal_loads: np.ndarray | None = None,
        thermal_traction: np.ndarray | None = None,
        start: FullSolution | None = None,
        deflection: EdgeDeflection | None = None,
    ) -> FullSolution:
        """Solve contact; parameters as in `Loading`, and a neighbouring solution as initial guess.

        If Newton's method does not converge, the load is applied in steps.

        Raises
        ------
        ComputationError
            If there is no solution, or none is found.
        """
        nothing = np.zeros(len(gap))
        loading = Loading(
            gap,
            load,
            nothing if compliance is None else compliance,
            np.zeros(len(self.elastic.fixed)) if nodal_loads is None else nodal_loads,
            nothing if thermal_traction is None or not self.nitsche else thermal_traction,
            deflection,
        )
        self._check(loading)
        # relative to the start: a far approach would lose the digits of the deformation
        origin = start.motion if start else self._held(loading, np.zeros(len(loading.nodal_loads)))
        near = replace(loading, gap=gap - self.modes @ origin)
        start = replace(start, motion=0 * origin) if start else self._guess(near)
        found = self._newton(near, start)[0] or self._in_steps(near)
        return replace(found, motion=origin + found.motion)

    def _check(self, loading: Loading) -> None:
        """Raise for values that are not finite, and for loads that no pressure can carry."""
        given = loading.gap, loading.load, loading.compliance, loading.thermal_traction
        wrong = sum(np.sum(~np.isfinite(values)) for values in (*given, loading.nodal_loads))
        if self._sum(wrong):
            raise ComputationError("contact: gap, loads or temperatures are not finite")
        if np.any(loading.load != 0.0):
            scale = np.abs(self.weighted_force_modes).sum(axis=0)
            scale[scale == 0.0] = 1.0
            forces, target = self.weighted_force_modes / scale, loading.load / scale
            # nnls treats small columns as zero: only their directions matter
            size = np.linalg.norm(forces, axis=1, keepdims=True)
            directions = forces[size[:, 0] > 0] / size[size[:, 0] > 0]
            if (
                scipy.optimize.nnls(directions.T, target / np.linalg.norm(target))[1]
                > _STAGNATION_TOLERANCE
            ):
                raise ComputationError("contact: the load cannot be carried by the contact zone")

    def _guess(self, loading: Loading) -> FullSolution:
        """Initial guess: contact with a coarse pressure space on the contact zone."""
        own = self.elastic.solve(loading.nodal_loads)
        s = _coordinates(self.pairing)
        count, enough = _COARSE_FUNCTIONS[s.shape[1]]
        start, end = s.min(axis=0), s.max(axis=0)
        for _ in range(_MAX_REFINEMENTS):
            found = self._coarse(loading, own, _hats(s, start, end))
            pressing = s[found.active]
            width = (end - start) / count
            if np.all(np.ptp(pressing, axis=0) > enough * width):
                break
            start, end = pressing.min(axis=0) - width, pressing.max(axis=0) + width
        return found

    def _coarse(self, loading: Loading, own: np.ndarray, hats: np.ndarray) -> FullSolution:
        """Contact with hat functions (n, m) as pressures.

        Costs one elastic solution per function, and no factorisation.
        """
        weighted = self.pairing.weights[:, None] * hats
        fields = self.elastic.solve(self._traction @ sp.csr_matrix(weighted))
        softness = loading.compliance + (0.0 if self.nitsche else 1 / self.stiffness)
        opened = self._opening(fields) + softness[:, None] * hats
        everywhere = np.ones(len(loading.gap))
        try:
            coarse = solve_contact(
                weighted.T @ opened,
                weighted.T @ self.gap(loading, own),
                weighted.T @ self.modes,
                loading.load,
                force_modes=hats.T @ self.weighted_force_modes,
            )
        except ComputationError:  # Newton's method reports the cause, if any
            return FullSolution(own, np.zeros(len(loading.load)), everywhere, 0)
        pressure = hats @ coarse.coefficients
        if not pressure.any():
            return FullSolution(own, coarse.motion, everywhere, 0)
        inner = np.maximum(pressure - _ACTIVE_PRESSURE_RATIO * pressure.max(), 0.0)
        return FullSolution(own + fields @ coarse.coefficients, coarse.motion, inner, 0)

    def _held(self, loading: Loading, displacement: np.ndarray) -> np.ndarray:
        """Motion of the holder that carries the load on springs γ, for fixed bodies.

        Newton's method from all springs closed: with one motion each step ends at or beyond the
        solution, so convergence is monotonic.
        """
        gap = self.gap(loading, displacement)
        springs = self.weighted_force_modes * self.stiffness[:, None]
        closed: np.ndarray = np.ones(len(gap), dtype=bool)
        motion = np.zeros(len(loading.load))
        for _ in range(_MAX_ITERATIONS):
            matrix, right = springs[closed].T @ self.modes[closed], springs[closed].T @ gap[closed]
            motion = np.linalg.lstsq(matrix, loading.load + right, rcond=None)[0]
            pressing = self.modes @ motion > gap
            if np.array_equal(pressing, closed) or not pressing.any():
                break
            closed = pressing
        return motion

    def _newton(self, loading: Loading, start: FullSolution) -> tuple[FullSolution | None, int]:
        """Newton's method: solution, None if it does not converge, and number of iterations."""
        own = 0 if loading.deflection is None else loading.deflection.modes.shape[1]
        u, d = start.displacement, np.append(start.motion, np.zeros(own))
        before, active, last = np.inf, np.zeros(0, dtype=bool), False
        for iteration in range(_MAX_ITERATIONS):
            residual = self.residual(loading, u, d)
            stuck = iteration > 0 and residual.relative > 0.1 * before
            small = residual.relative <= (_STAGNATION_TOLERANCE if stuck else _TOLERANCE)
            kept = not residual.active.any() or np.array_equal(active, residual.active)
            if small and (kept or last):
                pressure = np.maximum(residual.pressure, 0.0)
                held = d[: len(loading.load)]
                return FullSolution(u, held, pressure, iteration), iteration
            if not np.isfinite(residual.relative):
                return None, iteration
            # pressures are off by up to thirty times the residual; a step that keeps the active set
            # is exact but for rounding, others are followed by a last one (mostly the same factor)
            before, last = residual.relative, small
            guessed = iteration == 0 and not small and bool(start.active.any())
            active = (start if guessed else residual).active
            step = self.newton_step(loading, residual, active)
            if step is None:  # too few active points to constrain the holder: restore equilibrium
                d = np.append(self._held(loading, u), np.zeros(own))
                continue
            length = step_length(*self.along(loading, residual, *step))
            u, d = u + length * step[0], d + length * step[1]
        return None, _MAX_ITERATIONS

    def _in_steps(self, loading: Loading) -> FullSolution:
        """Apply the load in steps, halved where Newton's method fails."""
        share, step, spent = 0.0, 0.5, _MAX_ITERATIONS
        solution = None
        while share < 1.0:
            part = loading.part(min(1.0, share + step))
            found, iterations = self._newton(part, solution or self._guess(part))
            spent += iterations
            if found is not None:
                solution, share, step = found, min(1.0, share + step), 2 * step
            elif step < _MIN_LOAD_STEP:
                raise ComputationError(self._advice())
            else:
                step /= 2
        assert solution is not None
        return replace(solution, iterations=spent)

    def _advice(self) -> str:
        change = "make contact.penalty smaller"
        if self.nitsche:
            change = "leave contact.gamma at its default, set contact.theta = -1"
        return (
            "contact: Newton's method found no equilibrium, however small the load; "
            f'{change}, or use contact.method = "condensed"'
        )


def _coordinates(pairing: Pairing) -> np.ndarray:
    """Coordinates of the contact points: position along a face, principal axes of a surface."""
    if pairing.points.shape[1] == 2:
        return pairing.carrying.position[:, None]
    centred = pairing.points - pairing.points.mean(axis=0)
    return centred @ np.linalg.svd(centred.T @ centred)[2][:2].T


def _hats(s: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Piecewise linear functions of equal width on part of the face, shape (n, m).

    Products of those along each coordinate (n, dim), between a start and an end (dim,).
    """
    count = int(np.sum(np.all((s >= start) & (s <= end), axis=1)))
    most = min(_COARSE_FUNCTIONS[s.shape[1]][0], int((count // 3) ** (1 / s.shape[1])))
    hats = np.ones((len(s), 1))
    for along, first, last in zip(s.T, start, end, strict=True):
        knots = np.linspace(first, last, max(2, most))
        distance = np.abs(along[:, None] - knots) / (knots[1] - knots[0])
        part = np.maximum(1.0 - distance, 0.0)
        hats = (hats[:, :, None] * part[:, None]).reshape(len(s), -1)
    return hats[:, hats.sum(axis=0) > 0.5]  # some may contain too few points


def step_length(
    constant: float, slope: float, factors: np.ndarray, pressure: np.ndarray, change: np.ndarray
) -> float:
    """Exact line search: fraction of the Newton step, from the work of the residual along it.

    The work ``constant + slope a + factors · max(0, pressure + a change)`` is the derivative of the
    energy, if one exists: continuous, piecewise linear, and increasing, so that its zero is the
    minimum along the step. Full steps are kept unless harmful, since they end exactly at the
    solution once the active set no longer changes.
    """

    def work(a):
        pressing = np.maximum(pressure + np.multiply.outer(a, change), 0.0)
        return constant + slope * a + pressing @ factors

    start, whole = work(np.array([0.0, 1.0]))
    if start >= 0.0 or whole <= _MAX_WORK_RATIO * abs(start):
        return 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        kinks = -pressure / change
    kinks = np.unique(np.concatenate([[0.0, 1.0], kinks[(kinks > 0.0) & (kinks < 1.0)]]))
    values = work(kinks)
    after = int(np.argmax(values > 0.0))
    a, b = kinks[after - 1], kinks[after]
    fa, fb = values[after - 1], values[after]
    return float(a + (b - a) * fa / (fa - fb))
