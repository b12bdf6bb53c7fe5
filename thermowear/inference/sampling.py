"""Samples of uncertain inputs: Latin hypercubes, Sobol sequences, and Saltelli's design.

Samples fill the unit cube (scipy.stats.qmc, scrambled, repeatable by their seed) and are mapped to
values by the inverse distribution functions of the inputs. An input of several dependent values,
such as calibrated parameters, has one column for each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.stats import qmc

from .distributions import UncertainInput

_NEAREST = 2.0**-33
"""Distance of quantiles from 0 and 1, where distributions may be infinite."""


@dataclass(frozen=True)
class Sample:
    """Sample of inputs.

    Attributes
    ----------
    values : ndarray, shape (n, p)
    requested : int
        Requested number of points; n is the next power of two for Sobol sequences.
    """

    values: np.ndarray
    requested: int

    @property
    def note(self) -> str:
        """Sentence on the number of points if it was rounded, else empty."""
        if len(self.values) == self.requested:
            return ""
        return (
            f"{self.requested} points rounded up to {len(self.values)}, a power of two, as Sobol "
            "sequences need"
        )


@dataclass(frozen=True)
class SaltelliDesign:
    """Points at which Sobol indices are estimated (Saltelli et al., 2010).

    Attributes
    ----------
    a, b : ndarray, shape (n, p)
        Independent samples.
    ab : ndarray, shape (d, n, p)
        Sample a with the columns of input i of d from b.
    requested : int
        Requested number n, rounded up to a power of two.
    """

    a: np.ndarray
    b: np.ndarray
    ab: np.ndarray
    requested: int

    @property
    def points(self) -> np.ndarray:
        """All points, a, b, then ab by input, shape (n (d + 2), p)."""
        return np.concatenate([self.a, self.b, *self.ab])

    def split(self, outputs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Outputs (n (d + 2), k) at `points` as those of a (n, k), b (n, k) and ab (d, n, k)."""
        inputs, n, _ = self.ab.shape
        parts = np.asarray(outputs).reshape(inputs + 2, n, -1)
        return parts[0], parts[1], parts[2:]


def latin_hypercube(inputs: Sequence[UncertainInput], n: int, seed: int = 0) -> Sample:
    """Sample with one point in each of n strata of equal probability of every input."""
    cube = qmc.LatinHypercube(_columns(inputs), rng=np.random.default_rng(seed)).random(n)
    return Sample(values_at(inputs, cube), n)


def sobol_sequence(inputs: Sequence[UncertainInput], n: int, seed: int = 0) -> Sample:
    """Scrambled Sobol sequence; its length is the next power of two."""
    return Sample(values_at(inputs, _sobol(_columns(inputs), n, seed)), n)


def saltelli(inputs: Sequence[UncertainInput], n: int, seed: int = 0) -> SaltelliDesign:
    """Saltelli's design from a scrambled Sobol sequence in twice as many dimensions."""
    width = _columns(inputs)
    cube = _sobol(2 * width, n, seed)
    a, b = values_at(inputs, cube[:, :width]), values_at(inputs, cube[:, width:])
    mixed = np.repeat(a[None], len(inputs), axis=0)
    for i, columns in enumerate(columns_of(inputs)):
        mixed[i][:, columns] = b[:, columns]
    return SaltelliDesign(a, b, mixed, n)


def columns_of(inputs: Sequence[UncertainInput]) -> list[slice]:
    """Columns of each input in a sample."""
    ends = np.cumsum([0, *(one.size for one in inputs)])
    return [slice(int(begin), int(end)) for begin, end in pairwise(ends)]


def values_at(inputs: Sequence[UncertainInput], quantiles: np.ndarray) -> np.ndarray:
    """Values of inputs at quantiles, both of shape (n, p)."""
    quantiles = np.clip(quantiles, _NEAREST, 1 - _NEAREST)
    values = np.empty(quantiles.shape)
    for one, columns in zip(inputs, columns_of(inputs), strict=True):
        part = quantiles[:, columns]
        values[:, columns] = one.ppf(part)
    return values


def _columns(inputs: Sequence[UncertainInput]) -> int:
    if not inputs:
        raise ValueError("no uncertain inputs: at least one is needed")
    return sum(one.size for one in inputs)


def _sobol(dimensions: int, n: int, seed: int) -> np.ndarray:
    power = max(int(n) - 1, 0).bit_length()
    return qmc.Sobol(dimensions, rng=np.random.default_rng(seed)).random_base2(power)
