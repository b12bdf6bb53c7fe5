"""Search for a mesh with few unknowns that reaches a given accuracy.

Each trial changes one parameter of the mesh. The search tries all of them, takes two steps along
the one that reduces the error fastest per unknown,

    rate = ln(e_0 / e_1) / ln(N_1 / N_0),

and so on. From the mesh that reaches the accuracy it goes back, parameter by parameter, as long as
meshes with fewer unknowns reach it, too. The error e that steers decreases steadily with the mesh:
it excludes the largest pressure, whose error may vanish by chance on a coarse mesh.

Errors are those estimated, with a factor of safety. Without an estimate, and in analyses of a
history, which carry errors of earlier states along, a value f has the error that follows from a
coarser mesh (index c) if it is proportional to e,

    |f - f_c| e / (e_c - e).

Where that of the largest pressure does not become small although the mean error does, the
pressure is singular: it has no largest value.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np

Mesh = TypeVar("Mesh")
Steps = Mapping[str, Callable[[Mesh], Mesh | None]]

_MOST = 60
"""Largest number of trials."""
_STARTS = 8
"""Number of meshes that are tried for a first result."""
_FINER = 1.3
"""Least ratio of unknowns of a finer mesh where no single step reduces the error."""
_COARSER = 2.0
"""Least ratio of the errors e of two meshes whose values are compared."""
_COMPARED = 2
"""Number of coarser meshes whose values are compared."""
_SAME = 0.1
"""Least logarithm of a ratio of unknowns, for changes that add few or none."""
_SLOWEST = 0.05
"""Rate below which a change of the mesh is of no use."""
_STRAIGHT = 2
"""Number of steps along one parameter before the others are tried again."""
_PART_OF_MEAN = 0.5
"""Least error of the largest pressure, relative to the mean error: its estimate may vanish."""
_SAFETY = 2.5
"""Factor on estimates of shape and temperature: true errors are up to three times the estimate."""
_LEAST = 1e-12
"""Error of which less is rounding."""


@dataclass(frozen=True)
class MeshTrial(Generic[Mesh]):
    """Result on one mesh.

    Attributes
    ----------
    mesh : Mesh
    unknowns : int
    history : bool
        True if it is the result of a history.
    estimates : mapping of str to float
        Estimated relative errors: pressure (in the mean), max_pressure, shape, temperature, as far
        as there are any.
    values : mapping of str to (float or ndarray, float)
        Values of quantities whose change between meshes measures their error, and their scale:
        max_pressure, and shape and temperature where estimates do not tell.
    """

    mesh: Mesh
    unknowns: int
    history: bool
    estimates: Mapping[str, float]
    values: Mapping[str, tuple[float | np.ndarray, float]]

    @property
    def steering(self) -> float:
        """Error that decreases steadily with the mesh."""
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
    accuracy : float
        Relative error that is asked for.
    trials : list of MeshTrial
        All results so far.
    """

    evaluate: Callable[[Mesh], MeshTrial[Mesh] | None]
    steps: Steps
    back: Steps
    accuracy: float
    trials: list[MeshTrial[Mesh]] = field(default_factory=list)

    def best(self, start: Mesh) -> MeshTrial[Mesh] | None:
        """Trial with few unknowns that reaches the accuracy, or the last one if none does.

        None if there is no result on any mesh.
        """
        current = self._first(start)
        while current and not self.reached(current) and len(self.trials) < _MOST:
            name = self._fastest(current)
            after = self._refined(current) if name is None else self._straight(current, name)
            if after is None:
                break
            current = after
        while current and self.reached(current) and len(self.trials) < _MOST:
            after = self._coarser(current)
            if after is None:
                break
            current = after
        return current

    def _fastest(self, trial: MeshTrial[Mesh]) -> str | None:
        """Step that reaches the accuracy, or that reduces the error fastest; None if none does."""
        found = self._around(trial, self.steps)
        good = {name: after.unknowns for name, after in found.items() if self.reached(after)}
        if good:
            return min(good, key=lambda name: good[name])
        rates = {name: rate(trial, after) for name, after in found.items()}
        name = max(rates, key=lambda name: rates[name], default=None)
        return name if name and rates[name] > _SLOWEST else None

    def _straight(self, trial: MeshTrial[Mesh], name: str) -> MeshTrial[Mesh]:
        """Trial after some steps of one kind, as long as they reduce the error."""
        for _ in range(_STRAIGHT):
            after = self._around(trial, {name: self.steps[name]}).get(name)
            if after is None or not (self.reached(after) or rate(trial, after) > _SLOWEST):
                break
            trial = after
            if self.reached(trial):
                break
        return trial

    def _refined(self, trial: MeshTrial[Mesh]) -> MeshTrial[Mesh] | None:
        """Trial with most unknowns one step away, where no step reduces the error by itself."""
        around = self._around(trial, self.steps).values()
        finer = [each for each in around if each.unknowns > _FINER * trial.unknowns]
        return max(finer, key=_unknowns) if finer else None

    def _coarser(self, trial: MeshTrial[Mesh]) -> MeshTrial[Mesh] | None:
        """Trial with fewest unknowns one step back that reaches the accuracy, too; None if none."""
        around = self._around(trial, self.back).values()
        good = [each for each in around if each.unknowns < trial.unknowns and self.reached(each)]
        return min(good, key=_unknowns) if good else None

    def _around(self, trial: MeshTrial[Mesh], steps: Steps) -> dict[str, MeshTrial[Mesh]]:
        """Trials one step away, as far as there are results."""
        meshes = {name: step(trial.mesh) for name, step in steps.items()}
        tried = {name: self._try(mesh) for name, mesh in meshes.items() if mesh is not None}
        return {name: found for name, found in tried.items() if found is not None}

    def reached(self, trial: MeshTrial[Mesh]) -> bool:
        """Test whether all errors of a trial are within the accuracy."""
        return self.error(trial) <= self.accuracy

    def error(self, trial: MeshTrial[Mesh]) -> float:
        """Largest error; of the largest pressure only where the pressure is not singular."""
        measured = trial.values.keys() - {"max_pressure"}
        errors = [self._change(trial, name) for name in measured]
        estimated = {"shape", "temperature"} - measured
        errors += [_SAFETY * trial.estimates.get(name, 0.0) for name in estimated]
        if not self.singular(trial):
            errors.append(self._peak_error(trial))
        return max(errors)

    def singular(self, trial: MeshTrial[Mesh]) -> bool:
        """Test whether the pressure becomes accurate in the mean only."""
        mean, largest = _of_pressure(trial)
        if mean > self.accuracy / 2 or self._peak_error(trial) <= self.accuracy:
            return False
        before = map(_of_pressure, self.trials)
        return any(m >= _COARSER**2 * mean and p <= _COARSER * largest for m, p in before)

    def _peak_error(self, trial: MeshTrial[Mesh]) -> float:
        if trial.history:
            return self._change(trial, "max_pressure")
        mean, largest = _of_pressure(trial)
        return max(_PART_OF_MEAN * mean, largest)

    def _change(self, trial: MeshTrial[Mesh], quantity: str) -> float:
        """Error of a quantity from its change since the next coarser meshes, see the module."""
        error = trial.steering
        coarser = [each for each in self.trials if each.steering >= _COARSER * error]
        coarser.sort(key=lambda each: each.unknowns)
        if len(coarser) < _COMPARED:
            return math.inf
        value, scale = trial.values[quantity]
        return _SAFETY * max(
            float(np.abs(value - each.values[quantity][0]).max())
            / scale
            * error
            / (each.steering - error)
            for each in coarser[-_COMPARED:]
        )

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


def _unknowns(trial: MeshTrial) -> int:
    return trial.unknowns


def _of_pressure(trial: MeshTrial) -> tuple[float, float]:
    """Estimated errors of the pressure in the mean, and of its largest value."""
    mean, largest = (trial.estimates.get(key, math.inf) for key in ("pressure", "max_pressure"))
    return mean, largest


def rate(before: MeshTrial, after: MeshTrial) -> float:
    """Rate at which a change of the mesh reduces the error, see the module."""
    grown = max(math.log(after.unknowns / before.unknowns), _SAME)
    return math.log(before.steering / after.steering) / grown
