"""Heat exchange of faces condensed to their nodes, and its change with the conductance.

With the values P of the shape functions at the contact points, the rise of a face is
``T = T⁰ + P θ`` and the heat into its nodes ``Q = Pᵀ w q``; conduction condensed to the nodes of
the faces of a body is ``θ = Φ Q``. Heat crosses where faces differ in temperature, so that Q
depends on θ of all bodies by a sparse matrix. The points themselves only carry values.

As points open or close, the matrix N of the exchange changes by Δ in the rows and columns U of the
nodes near them. With the response G of a reference (Woodbury's formula; Hager, SIAM Review 31
(1989) 221)::

    G' = G + G_U Δ (I - G_UU Δ)⁻¹ G_Uᵀ
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lu_factor, lu_solve

from ...parallel import sum_over_ranks
from .exchange_matrix import (
    BaselineResponse,
    Division,
    FaceNodes,
    NodalResponses,
    ThermalState,
    coupling_matrix,
    divided,
    factorised,
    jump_scale,
    node_ranges,
    scaled_functions,
)
from .pressure import Basis


@dataclass(frozen=True)
class FaceHeat:
    """Heat at the contact points, and its exchange between the faces.

    Attributes
    ----------
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ of the exchanged heat in perfect contact.
    traces : tuple of csr_matrix, shape (n_owned, n)
        Transposed traces Eᵀ of the first and of the second faces of the contacts.
    shifts : tuple of ndarray, shape (n,)
        Heat transfer of each face to a bath at ambient, of the order of its body, included in the
        factorised conduction and subtracted again here [W/(m² K)].
    layers : tuple of ndarray, shape (n,)
        Conductance of a layer of each body as thick as the support of a basis function
        [W/(m² K)].
    partition : float or ndarray, shape (n,)
        Fraction of the friction heat released on the first face.
    """

    weights: np.ndarray
    basis: Basis
    traces: tuple[sp.csr_matrix, sp.csr_matrix]
    shifts: tuple[np.ndarray, np.ndarray]
    layers: tuple[np.ndarray, np.ndarray]
    partition: float | np.ndarray

    def nodal_heat(self, state: ThermalState, bath: bool) -> np.ndarray:
        """Nodal heat of the contact [W], owned rows; heat of the bath included on request."""
        faces = zip(self.traces, self.shifts, state.rise, state.flux, strict=True)
        first, second = (
            trace @ (self.weights * (flux + bath * shift * rise))
            for trace, shift, rise, flux in faces
        )
        return first + second

    def state(
        self, rise: tuple[np.ndarray, np.ndarray], friction_heat: np.ndarray, crossing: np.ndarray
    ) -> ThermalState:
        """State by the rises [K], and friction heat and heat from face 2 to 1 (n,) [W/m²]."""
        into_1 = self.partition * friction_heat + crossing
        return ThermalState(rise, (into_1, friction_heat - into_1))

    def divided(self, conductance: np.ndarray) -> Division:
        """Divide conductances (n,) into parts that are finite and well scaled."""
        return divided(conductance, self.layers)


@dataclass(frozen=True)
class InterfaceHeat(FaceHeat):
    """Heat conduction in the bodies, condensed to the nodes of their contact faces.

    Attributes
    ----------
    nodes : tuple of FaceNodes
        Nodes of each body, one after the other.
    responses : NodalResponses
    """

    nodes: tuple[FaceNodes, ...]
    responses: NodalResponses

    @property
    def response(self) -> tuple[np.ndarray, ...]:
        """Φ: nodal rise per nodal heat in each body, the bath included, shape (n_b, n_b) [K/W].

        Every rank calls.
        """
        return self.responses.each

    def exchange(self, conductance: np.ndarray) -> HeatExchange:
        """Couple the faces by a conductance (n,), infinite in perfect contact."""
        return HeatExchange(self, conductance)

    @cached_property
    def values(self) -> tuple[sp.csr_array, sp.csr_array]:
        """Temperatures of both faces at the points per nodal value, shape (n, n_f)."""
        one, two = (sp.hstack(side) for side in zip(*(n.values for n in self.nodes), strict=True))
        return one.tocsr(), two.tocsr()

    @cached_property
    def functions(self) -> sp.csr_array:
        """The basis Ψ as a sparse matrix, shape (n, m)."""
        return sp.csr_array(self.basis)

    @cached_property
    def released(self) -> sp.csr_array:
        """Nodal heat per friction heat at the points, shape (n_f, n) [m²]."""
        f = self.partition * np.ones(len(self.weights))
        shares = zip(self.values, (f, 1 - f), strict=True)
        first, second = (v.T @ sp.diags_array(self.weights * share) for v, share in shares)
        return (first + second).tocsr()

    def on_nodes(self, heat: np.ndarray) -> np.ndarray:
        """Owned nodal heat (n_owned, k) of the bodies from that on the faces (n_f + …, k)."""
        n_owned, ranges = self.traces[0].shape[0], node_ranges([n.count for n in self.nodes])
        pairs = zip(self.nodes, ranges, strict=True)
        return np.sum([nodes.spread(heat[own], n_owned) for nodes, own in pairs], axis=0)


class HeatExchange:
    """Faces coupled by a conductance.

    The unknowns are the nodal rises by the heat at the contact, and coefficients of the heat that
    crosses beyond the direct part, see `exchange_matrix.divided`::

        x = (θ, z),   Q = b + N x,   θ = Φ Q,   0 = b_z + (N x)_z,   x = G b

    Parameters
    ----------
    face : InterfaceHeat
    conductance : ndarray, shape (n,)
        Infinite in perfect contact [W/(m² K)].

    Raises
    ------
    ComputationError
        If a heated body has no heat sink.
    """

    def __init__(self, face: InterfaceHeat, conductance: np.ndarray):
        self.face, self.division = face, face.divided(conductance)
        self._ranges = node_ranges([nodes.count for nodes in face.nodes])
        self._count = self._ranges[-1].stop
        self._set_up()

    def _set_up(self) -> None:
        """Scale the functions of crossing heat, and factorise."""
        face = self.face
        self.scale = jump_scale(
            face.weights, face.functions, face.values, face.response, self.division
        )
        functions = scaled_functions(face.functions, self.scale)
        self.coupling = coupling_matrix(
            face.weights, functions, face.values, self.division, face.shifts
        )
        self._solve = factorised(self.coupling, face.response)

    @cached_property
    def _crossing(self) -> sp.csr_array:
        """Scaled functions ``η Ψ`` of the heat that crosses beyond the direct part, (n, n_z)."""
        functions = scaled_functions(self.face.functions, self.scale)
        return (sp.diags_array(self.division[1]) @ functions).tocsr()

    def state(self, friction_heat: np.ndarray, baseline: BaselineResponse) -> ThermalState:
        """Temperatures and fluxes due to friction heat [W/m²] at the points, shape (n,)."""
        changes, crossing = self.solved(friction_heat, baseline)
        T1, T2 = baseline.rise
        return self.face.state((T1 + changes[0], T2 + changes[1]), friction_heat, crossing)

    def opened(self, per_heat: Sequence[np.ndarray]) -> np.ndarray:
        """Functionals (weak gaps, say) per load, from those per nodal heat of each body, (k, n_b).

        Shape (k, n_f + n_z), see `loads`.
        """
        own = np.hstack([*per_heat, np.zeros((len(per_heat[0]), self._crossing.shape[1]))])
        return own + self.transposed_response(self.coupling.T @ own.T).T

    def loads(self, friction_heat, baseline: BaselineResponse | None = None):
        """Loads of the coupled faces: nodal heat [W], then weak temperature jumps; by columns.

        Parameters
        ----------
        friction_heat : ndarray or csr_array, shape (n,) or (n, k)
            [W/m²]
        baseline : BaselineResponse, optional
            Rises without heat at the contact.
        """
        loads = self.face.released @ friction_heat
        jumps = self._crossing.shape[1], *friction_heat.shape[1:]
        if sp.issparse(loads):
            return sp.vstack([loads, sp.csr_array(jumps)]).tocsr()
        loads = np.concatenate([loads, np.zeros(jumps)])
        if baseline is None:
            return loads
        (T1, T2), face = baseline.rise, self.face
        w, (s1, s2), across = face.weights, face.shifts, self.division[0] * (T2 - T1)
        one, two = (values.T for values in face.values)
        heat = one @ (w * (s1 * T1 + across)) + two @ (w * (s2 * T2 - across))
        return loads + np.concatenate([heat, self._crossing.T @ (w * (T1 - T2))])

    def closing(self, difference: np.ndarray, excess: np.ndarray) -> np.ndarray:
        """Loads that close what jumps ``T1 - T2`` (n, k) miss of those of excess heat (m, k)."""
        face, weights = self.face, self.face.weights[:, None]
        functions = scaled_functions(face.functions, self.scale)
        resisted = self.division[2][:, None] * (face.functions @ excess)
        jumps = self._crossing.T @ (weights * difference) + functions.T @ (weights * resisted)
        return np.concatenate([np.zeros((self._count, jumps.shape[1])), jumps])

    def solved(self, friction_heat: np.ndarray, baseline: BaselineResponse | None = None):
        """Changes of the rises of both faces at the points, and heat from face 2 to face 1."""
        found = self.response(self.loads(friction_heat, baseline))
        θ, z = found[: self._count], found[self._count :]
        one, two = self.face.values
        changes = one @ θ, two @ θ
        difference = changes[1] - changes[0]
        if baseline is not None:
            difference = difference + baseline.rise[1] - baseline.rise[0]
        return changes, (self.division[0] * difference.T).T + self._crossing @ z

    def response(self, loads: np.ndarray) -> np.ndarray:
        """Unknowns ``x = G b`` by loads b, by columns."""
        found, _ = self._solve(self._risen(self.face.response, loads))
        return found.reshape(loads.shape)

    def excess(self, unknowns: np.ndarray) -> np.ndarray:
        """Coefficients z of the basis Ψ (m, k), by columns of unknowns; see `divided`."""
        coefficients = np.zeros((len(self.scale), unknowns.shape[1]))
        used = np.flatnonzero(self.scale)
        coefficients[used] = self.scale[used, None] * unknowns[self._count :]
        return coefficients

    def transposed_response(self, values: np.ndarray) -> np.ndarray:
        """Products ``Gᵀ values``, by columns."""
        if self.face.responses.symmetric:
            return self.response(values)
        adjoint, _ = self._solve(values, trans=1)
        return self._risen([Φ.T for Φ in self.face.response], adjoint)

    def _risen(self, response: Sequence[np.ndarray], loads: np.ndarray) -> np.ndarray:
        """Rises of uncoupled bodies by nodal heat; the rows of the jumps are kept."""
        ranges = zip(self._ranges, response, strict=True)
        return np.concatenate([*(Φ @ loads[rows] for rows, Φ in ranges), loads[self._count :]])


@dataclass(frozen=True)
class CoupledDistortion:
    """Thermal distortion of faces that exchange heat.

    Attributes
    ----------
    exchange : HeatExchange
    per_load : ndarray, shape (m, n_f + n_z)
        Weak gap per load of the exchange, or of its reference.
    change : tuple of ndarray or None, shape (m, k) and (k, n_f + n_z)
        Factors of the difference from the reference.
    """

    exchange: HeatExchange
    per_load: np.ndarray
    change: tuple[np.ndarray, np.ndarray] | None = None

    def by_friction(self, friction_heat) -> np.ndarray:
        """Weak gap by friction heat (n,) or columns of it, also sparse, shape (m, k) [m³]."""
        return self._weak(self.exchange.loads(friction_heat))

    def baseline_gap(self, baseline: BaselineResponse) -> np.ndarray:
        """Weak gap without friction heat, shape (m,)."""
        assert baseline.opening is not None
        still = np.zeros(len(baseline.rise[0]))
        return self._weak(self.exchange.loads(still, baseline)) + baseline.opening

    def _weak(self, loads) -> np.ndarray:
        result = self.per_load @ loads
        if self.change is None:
            return result
        first, second = self.change
        return result + first @ (second @ loads)


def at_faces(
    rise: np.ndarray, traces: tuple[sp.csr_matrix, sp.csr_matrix], comm
) -> tuple[np.ndarray, np.ndarray]:
    """Values of a nodal rise (n_owned,) at the points of both faces, shape (n,) each."""
    first, second = (sum_over_ranks(comm, trace.T @ rise) for trace in traces)
    return first, second


def baseline_response(
    rise: np.ndarray, traces: tuple[sp.csr_matrix, sp.csr_matrix], comm, opening=None
) -> BaselineResponse:
    """Response of the faces to a nodal rise (n_owned,), with the weak gap opened by it."""
    return BaselineResponse(at_faces(rise, traces, comm), opening)


def opened_by(per_rise: Sequence[np.ndarray], rises: Sequence[np.ndarray], comm) -> np.ndarray:
    """Weak gap (m,) opened by nodal rises (n_owned,), each with its gap per rise (n_owned, m)."""
    pairs = zip(per_rise, rises, strict=False)
    return sum_over_ranks(comm, sum(response.T @ rise for response, rise in pairs))


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
