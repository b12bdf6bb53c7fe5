"""Search for a mesh with few unknowns that reaches a given accuracy.

From coarse to fine, each trial changes one parameter of the mesh. The search tries all of them,
takes two steps along the one that reduces the estimated error e fastest per unknown,

    rate = ln(e_0 / e_1) / ln(N_1 / N_0),

and so on. Estimates only steer: the change by the next degree is a part of the error that depends
on the mesh, as a singular corner makes higher degrees converge slowly. A mesh that the estimate
finds good is therefore compared with one that is finer in every respect (index f): a value v has
the error

    |v - v_f| e / (e - e_f).

From the mesh that reaches the accuracy the search goes back, as long as meshes with fewer unknowns
reach it, too, compared with the same finer one.

The largest pressure counts at least a part of the mean error of the pressure, as its own error
may vanish by chance. Where it does not converge although the mean error does, the pressure is
singular: it has no largest value.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Generic, Protocol, TypeVar

import numpy as np


@dataclass(frozen=True)
class Number:
    """Single value.

    Attributes
    ----------
    value : float
    scale : float
        What its errors are relative to.
    """

    value: float
    scale: float

    def change(self, finer: Number) -> float:
        """Relative difference to the value on a finer mesh."""
        return abs(self.value - finer.value) / finer.scale


@dataclass(frozen=True, eq=False)
class WornHeights:
    """Heights of a worn face along the contact of a section.

    Attributes
    ----------
    position : ndarray, shape (n,)
        Arc length, which begins anew at each contact [m].
    height : ndarray, shape (n,) [m]
    weight : ndarray, shape (n,)
        Area, zero outside the contact [m²].
    """

    position: np.ndarray
    height: np.ndarray
    weight: np.ndarray

    def change(self, finer: WornHeights) -> float:
        """Largest difference in the contact except for its mean, relative to the range."""
        from scipy.interpolate import PchipInterpolator

        change = np.zeros_like(self.height)
        for own, other in zip(self._contacts(), finer._contacts(), strict=True):
            known = PchipInterpolator(finer.position[other], finer.height[other])
            ends = finer.position[other.start], finer.position[other.stop - 1]
            if self.weight[own].any():
                difference = self.height[own] - known(np.clip(self.position[own], *ends))
                change[own] = difference - np.average(difference, weights=self.weight[own])
        pressing = self.weight > 0
        return float(np.abs(change[pressing]).max(initial=0.0) / np.ptp(finer.height))

    def _contacts(self) -> list[slice]:
        """Points of each contact."""
        begins = np.flatnonzero(np.diff(self.position) <= 0) + 1
        ends = [0, *map(int, begins), len(self.position)]
        return [slice(*both) for both in pairwise(ends)]


Mesh = TypeVar("Mesh")
Steps = Mapping[str, Callable[[Mesh], Mesh | None]]

_MOST = 60
"""Largest number of trials."""
_STARTS = 8
"""Number of meshes that are tried for a first result."""
_FINER = 1.3
"""Least ratio of unknowns of a finer mesh where no single step reduces the error."""
_HALF = 0.5
"""Largest ratio of the errors e of a finer mesh and of the one that is compared with it."""
_MANY = 4.0
"""Ratio of their unknowns that halves any error, also where e is noisy: elements half as long."""
_CHECKS = 2
"""Number of meshes, each finer than the one before, that are tried for a comparison."""
_PROMISING = 2.0
"""Ratio of estimated error and accuracy below which a mesh is compared with a finer one."""
_SAME = 0.1
"""Least logarithm of a ratio of unknowns, for changes that add few or none."""
_SLOWEST = 0.05
"""Rate below which a change of the mesh is of no use."""
_STRAIGHT = 2
"""Number of steps along one parameter before the others are tried again."""
_PART = 0.1
"""Least error of the largest pressure, relative to the mean error."""
_SAFETY = 1.5
"""Factor on errors by comparison, as the ratio of errors e of two meshes is an estimate."""
_ALONE = 5.0
"""Factor on estimates where there is nothing to compare with."""
_LEAST = 1e-12
"""Error of which less is rounding."""


class Value(Protocol):
    """Value of a quantity on one mesh."""

    def change(self, finer) -> float:
        """Relative difference to the value on a finer mesh."""


@dataclass(frozen=True)
class MeshTrial(Generic[Mesh]):
    """Result on one mesh.

    Attributes
    ----------
    mesh : Mesh
    unknowns : int
    estimates : mapping of str to float
        Estimated relative errors: pressure (in the mean), max_pressure, shape, temperature, as far
        as there are any.
    values : mapping of str to Value
        Quantities that are compared between meshes; with max_pressure.
    """

    mesh: Mesh
    unknowns: int
    estimates: Mapping[str, float]
    values: Mapping[str, Value]

    @property
    def steering(self) -> float:
        """Error that decreases steadily with the mesh: without that of the largest pressure."""
        each = (self.estimates.get(name, 0.0) for name in ("pressure", "shape", "temperature"))
        return max(_LEAST, *each)


@dataclass
class MeshSearch(Generic[Mesh]):
    """Search from a coarse mesh on; see the module.

    Attributes
    ----------
    evaluate : callable
        MeshTrial of a mesh; None where nothing can be computed on it.
    steps : mapping of str to callable
        Changes of the mesh: the next one, or None at the limit of a parameter.
    back : mapping of str to callable
        Changes to meshes that may have fewer unknowns.
    finer : callable
        Mesh that is finer in every respect; None at the limit of all parameters.
    accuracy : float
        Relative error that is asked for.
    trials : list of MeshTrial
        All results so far.
    """

    evaluate: Callable[[Mesh], MeshTrial[Mesh] | None]
    steps: Steps
    back: Steps
    finer: Callable[[Mesh], Mesh | None]
    accuracy: float
    trials: list[MeshTrial[Mesh]] = field(default_factory=list)

    def best(self, start: Mesh) -> MeshTrial[Mesh] | None:
        """Trial with few unknowns that reaches the accuracy, or the last one if none does.

        None if there is no result on any mesh.
        """
        current = self._first(start)
        while current and not self.reached(current) and len(self.trials) < _MOST:
            after = self._next(current)
            if after is None:
                break
            current = after
        while current and self.reached(current) and len(self.trials) < _MOST:
            after = self._coarser(current)
            if after is None:
                break
            current = after
        return current

    def _next(self, trial: MeshTrial[Mesh]) -> MeshTrial[Mesh] | None:
        """Trial that reaches the accuracy, or whose error is less for few unknowns more."""
        found = self._around(trial, self.steps)
        good = self._least(found.values())
        if good is not None:
            return good
        rates = {name: rate(trial, after) for name, after in found.items()}
        name = max(rates, key=lambda name: rates[name], default=None)
        if name and rates[name] > _SLOWEST:
            return self._straight(trial, name)
        finer = [each for each in found.values() if each.unknowns > _FINER * trial.unknowns]
        return max(finer, key=_unknowns) if finer else None

    def _straight(self, trial: MeshTrial[Mesh], name: str) -> MeshTrial[Mesh]:
        """Trial after some steps of one kind, as long as they reduce the error."""
        for _ in range(_STRAIGHT):
            after = self._around(trial, {name: self.steps[name]}).get(name)
            if after is None or rate(trial, after) <= _SLOWEST:
                break
            trial = after
            if self.reached(trial):
                break
        return trial

    def _coarser(self, trial: MeshTrial[Mesh]) -> MeshTrial[Mesh] | None:
        """Trial with fewest unknowns that reaches the accuracy, too, after those one step back."""
        self._around(trial, self.back)
        fewer = [each for each in self.trials if each.unknowns < trial.unknowns]
        return self._least(each for each in fewer if self._finer_ones(each))

    def _least(self, trials: Iterable[MeshTrial[Mesh]]) -> MeshTrial[Mesh] | None:
        """Trial with fewest unknowns that reaches the accuracy; None if none does."""
        return next((t for t in sorted(trials, key=_unknowns) if self.reached(t)), None)

    def _around(self, trial: MeshTrial[Mesh], steps: Steps) -> dict[str, MeshTrial[Mesh]]:
        """Trials one step away, as far as there are results."""
        meshes = {name: step(trial.mesh) for name, step in steps.items()}
        tried = {name: self._try(mesh) for name, mesh in meshes.items() if mesh is not None}
        return {name: found for name, found in tried.items() if found is not None}

    def reached(self, trial: MeshTrial[Mesh]) -> bool:
        """Test whether all errors of a trial are within the accuracy.

        Where there is nothing to compare with, and the estimates are promising, finer meshes are
        computed.
        """
        if self._compared(trial) and not self._finer_ones(trial):
            if self._estimated(trial) > _PROMISING * self.accuracy:
                return False
            self._compare(trial)
        return self.error(trial) <= self.accuracy

    def error(self, trial: MeshTrial[Mesh]) -> float:
        """Largest error; of the largest pressure only where the pressure is not singular."""
        compared, mean = self._compared(trial), _of_pressure(trial)[0]
        finer = min(self._finer_ones(trial), key=self._worst, default=None)
        if compared and finer is None:
            return _ALONE * self._estimated(trial)
        changes = [_SAFETY * _change(trial, finer, name) for name in compared if finer]
        return max([mean if self.singular(trial) else _PART * mean, *changes])

    def _compared(self, trial: MeshTrial[Mesh]) -> set[str]:
        """Quantities that are compared with those on a finer mesh."""
        return trial.values.keys() - ({"max_pressure"} if self.singular(trial) else set())

    def _finer_ones(self, trial: MeshTrial[Mesh]) -> list[MeshTrial[Mesh]]:
        """Trials with at most half of the error, whose largest pressure is accurate, too."""
        least = max(_HALF * trial.steering, _LEAST)
        return [
            each
            for each in self.trials
            if each.unknowns > trial.unknowns
            and (each.steering <= least or each.unknowns >= _MANY * trial.unknowns)
            and self._of_largest(each) <= self.accuracy
        ]

    def _compare(self, trial: MeshTrial[Mesh]) -> None:
        """Compute finer meshes until there is one to compare with."""
        mesh = trial.mesh
        for _ in range(_CHECKS):
            if self._finer_ones(trial):
                return
            after = self.finer(mesh)
            if after is None or self._try(after) is None:
                return
            mesh = after

    def _estimated(self, trial: MeshTrial[Mesh]) -> float:
        """Largest estimate of what the accuracy is asked for."""
        errors = [trial.estimates.get(name, 0.0) for name in ("shape", "temperature")]
        return max(self._of_largest(trial), *errors)

    def _worst(self, trial: MeshTrial[Mesh]) -> float:
        """Largest estimate, including that of the pressure in the mean."""
        return max(trial.steering, self._estimated(trial))

    def _of_largest(self, trial: MeshTrial[Mesh]) -> float:
        """Estimated error of the largest pressure; of a singular one that in the mean."""
        mean, largest = _of_pressure(trial)
        return mean if self.singular(trial) else max(_PART * mean, largest)

    def singular(self, trial: MeshTrial[Mesh]) -> bool:
        """Test whether the pressure becomes accurate in the mean only."""
        mean, largest = _of_pressure(trial)
        if mean > self.accuracy / 2 or largest <= self.accuracy:
            return False
        before = map(_of_pressure, self.trials)
        return any(_HALF**2 * m >= mean and _HALF * p <= largest for m, p in before)

    def _first(self, start: Mesh) -> MeshTrial[Mesh] | None:
        """Trial of the first mesh, or of the next finer one on which there is a result."""
        meshes = [start]
        for mesh in meshes:
            trial = self._try(mesh)
            if trial is not None or len(meshes) > _STARTS:
                return trial
            around = (step(mesh) for step in self.steps.values())
            meshes += [finer for finer in around if finer is not None and finer not in meshes]
        return None

    def _try(self, mesh: Mesh) -> MeshTrial[Mesh] | None:
        for known in self.trials:
            if known.mesh == mesh:
                return known
        found = self.evaluate(mesh)
        if found is not None:
            self.trials.append(found)
        return found


def rate(before: MeshTrial, after: MeshTrial) -> float:
    """Rate at which a change of the mesh reduces the error, see the module."""
    grown = max(math.log(after.unknowns / before.unknowns), _SAME)
    return math.log(before.steering / after.steering) / grown


def _change(trial: MeshTrial, finer: MeshTrial, quantity: str) -> float:
    """Error of a quantity from its change to a finer mesh, see the module."""
    left = min(_HALF, finer.steering / trial.steering) if trial.steering > _LEAST else 0.0
    return trial.values[quantity].change(finer.values[quantity]) / (1.0 - left)


def _unknowns(trial: MeshTrial) -> int:
    return trial.unknowns


def _of_pressure(trial: MeshTrial) -> tuple[float, float]:
    """Estimated errors of the pressure in the mean, and of its largest value."""
    mean = trial.estimates.get("pressure", math.inf)
    return mean, trial.estimates.get("max_pressure", _PART * mean)
