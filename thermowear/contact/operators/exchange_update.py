"""Heat exchange after a change of the conductance at some contact points, without factorisation.

As points open or close, the matrix N of the exchange changes by Δ in the rows and columns U of the
nodes near them. With the response G of a reference (Woodbury's formula; Hager, SIAM Review 31
(1989) 221)::

    G' = G + G_U Δ (I - G_UU Δ)⁻¹ G_Uᵀ
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lu_factor, lu_solve

from .exchange_matrix import coupling_matrix, scaled_functions
from .heat_exchange import HeatExchange

_CHANGED = 0.2
"""Largest part of the unknowns that may change; beyond it a factorisation is as fast."""


class SingleResponses:
    """Responses to unit loads of single unknowns, each solved for when first needed.

    Parameters
    ----------
    respond : callable
        Responses (count, k) to loads, by columns.
    count : int
        Number of unknowns.
    """

    def __init__(self, respond: Callable[[np.ndarray], np.ndarray], count: int):
        self._respond, self._count = respond, count
        self._place = np.full(count, -1)
        self._known = np.empty((count, 0), order="F")

    def of(self, chosen: np.ndarray) -> np.ndarray:
        """Responses to unit loads of the chosen unknowns, shape (count, k)."""
        missing = chosen[self._place[chosen] < 0]
        if len(missing):
            units = np.zeros((self._count, len(missing)), order="F")
            units[missing, np.arange(len(missing))] = 1.0
            self._place[missing] = self._known.shape[1] + np.arange(len(missing))
            self._known = np.asfortranarray(np.hstack([self._known, self._respond(units)]))
        return self._known[:, self._place[chosen]]


class ReferenceExchange(HeatExchange):
    """Factorised exchange from which others follow by a change at some contact points."""

    def changed(self, conductance: np.ndarray) -> ChangedExchange | None:
        """Exchange for another conductance (n,); None if it differs at too many points."""
        division, before = self.face.divided(conductance), self.division
        other = [one != two for one, two in zip(division, before, strict=True)]
        points = np.flatnonzero(np.any(other, axis=0))
        beyond = self.face.functions[points[division[1][points] > 0.0]]
        if np.any(self.scale[beyond.indices] == 0.0):
            return None  # heat crosses in perfect contact where none did
        found = ChangedExchange(self, conductance, points)
        return found if len(found.near) <= _CHANGED * self.coupling.shape[0] else None

    @cached_property
    def columns(self) -> SingleResponses:
        """Columns of G."""
        return SingleResponses(self.response, self.coupling.shape[0])

    @cached_property
    def rows(self) -> SingleResponses:
        """Rows of G, as columns."""
        if self.face.responses.symmetric:
            return self.columns
        return SingleResponses(self.transposed_response, self.coupling.shape[0])


class ChangedExchange(HeatExchange):
    """Exchange that differs from a reference at some contact points.

    Parameters
    ----------
    reference : ReferenceExchange
    conductance : ndarray, shape (n,) [W/(m² K)]
    points : ndarray of int
        Points where it differs.

    Attributes
    ----------
    near : ndarray of int, shape (k,)
        Unknowns U near these points.
    """

    def __init__(self, reference: ReferenceExchange, conductance: np.ndarray, points: np.ndarray):
        self.reference, self._points = reference, points
        super().__init__(reference.face, conductance)

    def _set_up(self) -> None:
        face, reference, points = self.face, self.reference, self._points
        self.scale = reference.scale
        pairs = zip(self.division, reference.division, strict=True)
        direct, passing_fraction, resistance = (one[points] - two[points] for one, two in pairs)
        functions = scaled_functions(face.functions, self.scale)
        self._difference = coupling_matrix(
            face.weights[points],
            functions[points],
            (face.values[0][points], face.values[1][points]),
            (direct, passing_fraction, resistance),
            (np.zeros(len(points)),) * 2,
        )
        rows, columns = self._difference.nonzero()
        self.near = np.union1d(rows, columns)

    @cached_property
    def coupling(self) -> sp.csr_array:
        return (self.reference.coupling + self._difference).tocsr()

    @cached_property
    def _columns(self) -> np.ndarray:
        return self.reference.columns.of(self.near)

    @cached_property
    def _inner(self) -> tuple[np.ndarray, np.ndarray]:
        """Δ of the unknowns near the points, and factors of ``I - G_UU Δ``."""
        difference = self._difference[self.near][:, self.near].toarray()
        inner = np.eye(len(self.near)) - self._columns[self.near] @ difference
        return difference, lu_factor(inner, overwrite_a=True)

    def response(self, loads: np.ndarray) -> np.ndarray:
        difference, inner = self._inner
        before = self.reference.response(loads)
        return before + self._columns @ (difference @ lu_solve(inner, before[self.near]))

    def transposed_response(self, values: np.ndarray) -> np.ndarray:
        difference, inner = self._inner
        before = self.reference.transposed_response(values)
        change = lu_solve(inner, difference.T @ before[self.near], trans=1)
        return before + self.reference.rows.of(self.near) @ change

    def correction(self, functionals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Change of functionals per load from those with the reference, shape (q, n_loads).

        Returns
        -------
        tuple of ndarray, shape (q, k) and (k, n_loads)
            Factors of the change.
        """
        difference, inner = self._inner
        first = lu_solve(inner, difference.T @ functionals[:, self.near].T, trans=1)
        return first.T, self.reference.rows.of(self.near).T
