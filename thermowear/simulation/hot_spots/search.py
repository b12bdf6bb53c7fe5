"""Search for the first waves to grow, number by number, on all ranks side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TypeVar

import numpy as np

from ...laws.waves import WaveEquations, WaveMode, at_speed, first_critical, lowest, with_wear
from .bodies import Symmetry
from .wave_model import WaveModel

Found = TypeVar("Found")
_SPEEDS = np.geomspace(0.7, 1.6, 10)
"""Speeds at which growth is tabulated, relative to the critical speed."""


@dataclass(frozen=True)
class CriticalWaves:
    """First wave of a number and symmetry to grow with the speed.

    Attributes
    ----------
    number : float
        See `WaveModel.at`.
    symmetry : str
    without_wear, with_wear : WaveMode or None
        Modes at the critical speeds; None where none grows.
    complete : bool
        False if waves grow at lower speeds that were not found.
    """

    number: float
    symmetry: Symmetry
    without_wear: WaveMode | None
    with_wear: WaveMode | None
    complete: bool

    @property
    def worn_factor(self) -> float:
        """Critical speed factor with wear; infinite without one."""
        return np.inf if self.with_wear is None else self.with_wear.factor

    @property
    def factor(self) -> float:
        """Critical speed factor without wear; infinite without one."""
        return np.inf if self.without_wear is None else self.without_wear.factor


def search(
    model: WaveModel, numbers: Sequence[float], symmetries: Sequence[Symmetry]
) -> list[CriticalWaves]:
    """Critical speeds of all numbers and symmetries, each number of one rank; every rank calls.

    Raises
    ------
    ComputationError
        If a matrix is singular.
    """
    jobs = [(number, symmetry) for symmetry in symmetries for number in numbers]
    comm, found = model.system.comm, list[CriticalWaves]()
    for start in range(0, len(jobs), comm.size):
        batch = jobs[start : start + comm.size]
        equations = [model.at(*job).equations for job in batch]
        guess = next((one.factor for one in reversed(found) if one.factor < np.inf), 1.0)

        def own(
            batch: Sequence = batch, equations: Sequence = equations, guess: float = guess
        ) -> CriticalWaves | None:
            if comm.rank >= len(batch):
                return None
            number, symmetry = batch[comm.rank]
            return CriticalWaves(number, symmetry, *_critical(equations[comm.rank], guess))

        found += [one for one in _of_ranks(comm, own) if one is not None]
    return found


def _critical(
    equations: WaveEquations, guess: float
) -> tuple[WaveMode | None, WaveMode | None, bool]:
    """First modes without and with wear, and whether they are known to be the first."""
    first, complete = lowest(equations, first_critical(equations, guess), guess)
    return first, None if first is None else with_wear(equations, first), complete


def growth(
    model: WaveModel, waves: CriticalWaves
) -> list[tuple[float, WaveMode | None, WaveMode | None]]:
    """Modes without and with wear at speed factors about the critical one; every rank calls.

    The given speed, factor 1, is among them if it lies near.
    """
    equations, comm = model.at(waves.number, waves.symmetry).equations, model.system.comm
    factors = waves.factor * _SPEEDS
    if factors[0] < 1.0 < factors[-1]:
        factors = np.sort(np.append(factors, 1.0))
    plain = equations.without_wear

    def at(one: WaveEquations, mode: WaveMode | None, factor: float) -> WaveMode | None:
        return None if mode is None else at_speed(one, mode, factor)

    def own() -> list:
        found = []
        for factor in map(float, factors[comm.rank :: comm.size]):
            mode = at(plain, waves.without_wear, factor)
            worn = at(equations, waves.with_wear, factor) if equations.worn else None
            found.append((factor, mode, worn))
        return found

    return sorted(chain.from_iterable(_of_ranks(comm, own)), key=lambda row: row[0])


def refined(model: WaveModel, waves: CriticalWaves) -> float | None:
    """Critical speed factor on another discretisation, near a known one; every rank calls."""
    equations, comm = model.at(waves.number, waves.symmetry).equations, model.system.comm

    def own() -> WaveMode | None:
        return first_critical(equations, waves.factor) if comm.rank == 0 else None

    found = _of_ranks(comm, own)[0]
    return None if found is None else found.factor


def _of_ranks(comm, compute: Callable[[], Found]) -> list[Found]:
    """Results of all ranks, on every rank; errors of one are raised on all."""
    result, error = None, None
    try:
        result = compute()
    except (Exception, KeyboardInterrupt) as caught:
        error = caught
    found = comm.allgather((result, error))
    for _, raised in found:
        if raised is not None:
            raise raised
    return [one for one, _ in found]
