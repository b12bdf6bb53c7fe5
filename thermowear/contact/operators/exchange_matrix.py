"""Matrices of the heat exchange of faces: nodes, responses to heat, division of conductances.

The bodies are linear and are condensed to the nodes of their contact faces once (`condensation`);
their coupling (conductance, perfect contact, separated points) is solved with dense matrices of
these nodes in `heat_exchange`, or without condensation in `coupled_heat`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import dgetrf, dgetrs
from scipy.sparse.linalg import splu

from ...bulk.heat.conduction import Conduction
from ...bulk.solvers.direct import blocks
from ...bulk.spaces import Spaces
from ...errors import ComputationError
from ...serialise import serialisable

NO_HEAT_SINK = (
    "heat: a body is heated that nothing cools and that touches nothing, so that it has no steady "
    "temperature; give it heat.cooling, heat.temperature, or heat.gap_conductance"
)


@serialisable
@dataclass(frozen=True)
class ThermalState:
    """Thermal state at the contact points, shape (n,) each; index 0 is body 1.

    Attributes
    ----------
    rise : tuple of ndarray
        Temperature rise of each face above ambient [K].
    flux : tuple of ndarray
        Heat into each body [W/m²].
    """

    rise: tuple[np.ndarray, np.ndarray]
    flux: tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class BaselineResponse:
    """Response of the bodies without heat at the contact: given temperatures, or stored heat.

    Attributes
    ----------
    rise : tuple of ndarray, shape (n,)
        Temperature rise of the faces [K].
    opening : ndarray or None, shape (m,)
        Weak gap opened by it [m³]; None if not requested.
    """

    rise: tuple[np.ndarray, np.ndarray]
    opening: np.ndarray | None = None

    @property
    def unheated(self) -> ThermalState:
        """State of the faces without any heat at the contact."""
        zeros = np.zeros(len(self.rise[0]))
        return ThermalState(self.rise, (zeros, zeros))


@dataclass(frozen=True)
class FaceNodes:
    """Nodes of the temperature on the faces of a body, or of glued ones, numbered on all ranks.

    Attributes
    ----------
    rows : ndarray of int, shape (n_mine,)
        Owned rows of the nodes of this rank.
    first : int
        Number of the first of them among the n_b nodes of the body.
    values : tuple of csr_array, shape (n, n_b)
        P: temperature of the first and of the second face at the contact points per nodal value;
        zero at the points of other bodies. On every rank.
    """

    rows: np.ndarray
    first: int
    values: tuple[sp.csr_array, sp.csr_array]

    @property
    def count(self) -> int:
        """Number n_b of the nodes."""
        return self.values[0].shape[1]

    @property
    def mine(self) -> slice:
        """Numbers of the nodes of this rank."""
        return slice(self.first, self.first + len(self.rows))

    def spread(self, values: np.ndarray, n_owned: int) -> np.ndarray:
        """Owned values of a body, shape (n_owned, k), zero off the faces, from (n_b, k) on them."""
        result = np.zeros((n_owned, *values.shape[1:]))
        result[self.rows] = values[self.mine]
        return result


def nodes_by_group(
    spaces: Spaces, traces: tuple[sp.csr_matrix, sp.csr_matrix]
) -> tuple[FaceNodes, ...]:
    """Nodes on the contact faces of each group of bodies that has any, from transposed traces.

    Every rank calls.

    Parameters
    ----------
    spaces : Spaces
        Of the temperatures.
    traces : tuple of csr_matrix, shape (n_owned, n)
        Transposed traces of the first and of the second faces.
    """
    used = np.flatnonzero(np.diff(traces[0].indptr) + np.diff(traces[1].indptr))
    found, every = [], np.arange(spaces.owned)
    for bodies in spaces.groups:
        rows = np.intersect1d(used, every[spaces.rows(*bodies)])
        parts = spaces.comm.allgather([trace[rows] for trace in traces])
        first, second = (sp.csr_array(sp.vstack(side).T) for side in zip(*parts, strict=True))
        if first.shape[1]:
            before = sum(part[0].shape[0] for part in parts[: spaces.comm.rank])
            found.append(FaceNodes(rows, before, (first, second)))
    return tuple(found)


class NodalResponses:
    """Rises of the nodes of the faces per heat into them, solved for when they are first needed.

    Until then their memory serves the factors with which elasticity is condensed.

    Parameters
    ----------
    conduction : Conduction
    nodes : tuple of FaceNodes
        Nodes of each body.
    """

    def __init__(self, conduction: Conduction, nodes: tuple[FaceNodes, ...]):
        self._conduction, self._nodes = conduction, nodes

    @property
    def symmetric(self) -> bool:
        """True if the responses are symmetric."""
        return self._conduction.symmetric

    @cached_property
    def each(self) -> tuple[np.ndarray, ...]:
        """Φ: nodal rise per nodal heat in each body, shape (n_b, n_b) [K/W]. Every rank calls."""
        conduction = self._conduction.for_columns()
        found = tuple(_nodal_response(conduction, nodes) for nodes in self._nodes)
        conduction.release()
        return found


def _nodal_response(conduction: Conduction, face: FaceNodes) -> np.ndarray:
    """Rise of the nodes of a group per heat into each of them. Every rank calls."""
    spaces, index = conduction.spaces, conduction.spaces.group_of(face.rows)
    group, rows = conduction.in_group(index), spaces.within(index, face.rows)
    nodes, n_owned = face.first + np.arange(len(rows)), len(group.fixed)
    heat = sp.csc_matrix((np.ones(len(rows)), (rows, nodes)), shape=(n_owned, face.count))
    result = np.empty((face.count, face.count), order="F")
    for columns in blocks(face.count, spaces.dim):
        rises = group.respond(heat[:, columns].tocsr())
        result[:, columns] = np.vstack(spaces.comm.allgather(rises[rows]))
    return result


_REGULARITY = 1e-12
"""Regularisation of an infinite resistance, relative to that of the bodies: keeps heat flux
functions independent that differ only where no heat crosses."""
_MAX_DIRECT_RATIO = 10.0
"""Largest conductance treated point by point, relative to that of the better conducting body."""
_MAX_DIRECT_CONTRAST = 1e4
"""Largest conductance treated point by point, relative to that of the less conducting body: the
rounding error of equal temperatures, times the conductance, is heat that enters this body."""
_PAIR = 2
"""Number of bodies up to which the matrices of the exchange are dense."""

Division: TypeAlias = "tuple[np.ndarray, np.ndarray, np.ndarray]"
"""Parts of a conductance at the points, see `divided`."""


def divided(conductance: np.ndarray, bodies: tuple[np.ndarray, np.ndarray]) -> Division:
    """Divide conductances (n,) into parts that are finite and well scaled.

    Up to a conductance ``k``, a multiple of that of the bodies, heat crosses point by point:
    ``c = h (T2 - T1)``. Nonmatching finite elements cannot represent a larger one pointwise,
    and small temperature differences times large numbers would lose digits: the excess
    ``h - k`` has a resistance ``r = 1/(h - k)``, zero in perfect contact, and an unknown of
    moderate size, ``z = Ψ μ``. With ``η = 1/(1 + k r)`` it gives both the exchanged heat
    ``η z`` and the temperature jump ``r η z = (1 - η) z / k``, which is imposed weakly with the
    test functions ``η Ψ``. The equations are symmetric and regular from zero to infinite
    conductance.

    Parameters
    ----------
    conductance : ndarray, shape (n,)
        [W/(m² K)]
    bodies : tuple of ndarray, shape (n,)
        Conductance of a layer of each body as thick as the support of a basis function.

    Returns
    -------
    direct : ndarray, shape (n,)
        Conductance point by point [W/(m² K)].
    passing_fraction : ndarray, shape (n,)
        Fraction η.
    resistance : ndarray, shape (n,)
        Resistance ``η r η`` of the unknowns [m² K/W].
    """
    better, worse = np.maximum(*bodies), np.minimum(*bodies)
    limit = np.minimum(_MAX_DIRECT_RATIO * better, _MAX_DIRECT_CONTRAST * worse)
    direct = np.minimum(conductance, limit)
    passing_fraction, blocked_fraction = _parts(limit, conductance - direct)
    resistance = blocked_fraction * (passing_fraction + _REGULARITY * blocked_fraction) / limit
    return direct, passing_fraction, resistance


def _parts(limit: np.ndarray, conductance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fractions ``h/(h + k)`` and ``k/(h + k)`` of conductances from zero to infinity."""
    inverse = np.full(len(conductance), np.inf)
    np.divide(limit, conductance, out=inverse, where=conductance > 0)
    return 1 / (1 + inverse), limit / (limit + conductance)


def jump_scale(
    weights: np.ndarray,
    basis: sp.csr_array,
    values: tuple[sp.csr_array, sp.csr_array],
    response: Sequence[np.ndarray],
    division: Division,
) -> np.ndarray:
    """Scale of the functions of heat that crosses beyond the direct part, shape (m,).

    By the temperature jump that they cause; zero where no such heat crosses.

    Parameters
    ----------
    weights : ndarray, shape (n,) [m²]
    basis : csr_array, shape (n, m)
    values : tuple of csr_array, shape (n, n_f)
        Temperature of each face at the points per nodal value, see `FaceNodes`.
    response : sequence of ndarray, shape (n_b, n_b)
        Of the nodes of each body, see `InterfaceHeat`.
    division : Division
    """
    _, passing_fraction, resistance = division
    crossing = (sp.diags_array(weights * passing_fraction) @ basis).tocsc()
    result, used = np.zeros(basis.shape[1]), np.unique(crossing.nonzero()[1])
    basis, crossing = basis.tocsc()[:, used], crossing[:, used]
    jumps = (basis.T @ sp.diags_array(weights * resistance) @ basis).diagonal()
    heat = ((values[0] - values[1]).T @ crossing).tocsr()
    for rows, Φ in zip(node_ranges([len(Φ) for Φ in response]), response, strict=True):
        jumps = jumps + heat[rows].multiply(Φ @ heat[rows]).sum(axis=0)
    result[used] = 1 / np.sqrt(jumps)
    return result


def scaled_functions(basis: sp.csr_array, scale: np.ndarray) -> sp.csr_array:
    """Functions Ψ with a scale other than zero, times it, shape (n, n_z)."""
    used = np.flatnonzero(scale)
    return (basis.tocsc()[:, used] @ sp.diags_array(scale[used])).tocsr()


def coupling_matrix(
    weights: np.ndarray,
    functions: sp.csr_array,
    values: tuple[sp.csr_array, sp.csr_array],
    division: Division,
    shifts: tuple[np.ndarray, np.ndarray],
) -> sp.csr_array:
    """Matrix N: heat into the nodes of the faces, and weak temperature jumps.

    Linear in the division of the conductances and in the heat transfer to the bath.

    Parameters
    ----------
    weights, values, division
        See `jump_scale`.
    functions : csr_array, shape (n, n_z)
        See `scaled_functions`.
    shifts : tuple of ndarray, shape (n,)
        Heat transfer of each face to the bath [W/(m² K)].
    """
    (direct, passing_fraction, resistance), w = division, weights
    between = values[0] - values[1]
    baths = (P.T @ sp.diags_array(w * s) @ P for P, s in zip(values, shifts, strict=True))
    nodal = sum(baths, -(between.T @ sp.diags_array(w * direct) @ between))
    crossing = between.T @ sp.diags_array(w * passing_fraction) @ functions
    resisted = functions.T @ sp.diags_array(w * resistance) @ functions
    return sp.block_array([[nodal, crossing], [crossing.T, resisted]], format="csr")


def node_ranges(counts: Sequence[int]) -> list[slice]:
    """Ranges of the nodes of each body among those of all faces."""
    return [slice(int(a), int(b)) for a, b in pairwise([0, *np.cumsum(counts)])]


def factorised(coupling: sp.csr_array, response: Sequence[np.ndarray]) -> Callable:
    """Solution with the factors of the unknowns: ``I - Φ N``, and ``-N`` of the jumps.

    As `dgetrs` with its first arguments given. Bodies are coupled to their neighbours only: the
    factors of several pairs are sparse.

    Parameters
    ----------
    coupling : csr_array
        See `coupling_matrix`.
    response : sequence of ndarray, shape (n_b, n_b)
        Of the nodes of each body, see `InterfaceHeat`.

    Raises
    ------
    ComputationError
        If a heated body has no heat sink.
    """
    several = len(response) > _PAIR
    return _sparse_factor(coupling, response) if several else _dense_factor(coupling, response)


def _sparse_factor(coupling: sp.csr_array, response: Sequence[np.ndarray]) -> Callable:
    end = sum(len(Φ) for Φ in response)
    coupled = sp.block_diag(response, format="csr") @ coupling[:end]
    lines = sp.eye_array(end, coupling.shape[1], format="csr") - coupled
    try:
        factor = splu(sp.csc_matrix(sp.vstack([lines, -coupling[end:]])))
    except RuntimeError:  # exactly singular
        raise ComputationError(NO_HEAT_SINK) from None
    return lambda right, trans=0: (factor.solve(right, "NT"[trans]), 0)


def _dense_factor(coupling: sp.csr_array, response: Sequence[np.ndarray]) -> Callable:
    end = sum(len(Φ) for Φ in response)
    matrix = np.empty(coupling.shape, order="F")
    for rows, Φ in zip(node_ranges([len(Φ) for Φ in response]), response, strict=True):
        matrix[rows] = Φ @ coupling[rows]
    matrix[end:] = coupling[end:].toarray()
    np.negative(matrix, out=matrix)
    matrix[np.arange(end), np.arange(end)] += 1.0
    factor, pivots, singular = dgetrf(matrix, overwrite_a=1)
    if singular:
        raise ComputationError(NO_HEAT_SINK)
    return partial(dgetrs, factor, pivots)
