"""Heat exchange of faces condensed to their nodes: conductance and perfect contact.

With the values P of the shape functions at the contact points, the rise of a face is
``T = T⁰ + P θ`` and the heat into its nodes ``Q = Pᵀ w q``; conduction condensed to the nodes of
the face is ``θ = Φ Q``. Heat crosses where faces differ in temperature, so that Q depends on θ of
both faces by a sparse matrix. The points themselves only carry values.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import dgetrf, dgetrs

from ...errors import ComputationError
from .face_nodes import FaceNodes
from .heat import NO_HEAT_SINK, BaselineResponse, FaceHeat, ThermalState

Division: TypeAlias = "tuple[np.ndarray, np.ndarray, np.ndarray]"
"""Parts of a conductance at the points, see `FaceHeat.divided`."""


@dataclass(frozen=True)
class InterfaceHeat(FaceHeat):
    """Heat conduction in both bodies, condensed to the nodes of their faces.

    Attributes
    ----------
    nodes : tuple of FaceNodes
    response : tuple of ndarray, shape (n_f, n_f)
        Φ: nodal rise per nodal heat on each face, the bath included [K/W].
    symmetric : bool
        True if these are symmetric.
    """

    nodes: tuple[FaceNodes, FaceNodes]
    response: tuple[np.ndarray, np.ndarray]
    symmetric: bool

    def exchange(self, conductance: np.ndarray) -> HeatExchange:
        """Couple the faces by a conductance, see `divided`.

        Parameters
        ----------
        conductance : ndarray, shape (n,)
            Conductance of the contact or the gap at each point [W/(m² K)]; infinite in perfect
            contact.

        Raises
        ------
        ComputationError
            If a heated body has no heat sink.
        """
        return HeatExchange(self, conductance)

    def own_response(self) -> np.ndarray:
        """Rise of each point of both faces per flux at the same point, shape (2, n) [m² K/W]."""
        return np.array(
            [
                self.weights * nodes.values.multiply(nodes.values @ response).sum(axis=1)
                for nodes, response in zip(self.nodes, self.response, strict=True)
            ]
        )

    @cached_property
    def released(self) -> sp.csr_array:
        """Nodal heat into both faces per friction heat at the points, (n_f1 + n_f2, n) [m²]."""
        f = self.partition * np.ones(len(self.weights))
        shares = zip(self.nodes, (f, 1 - f), strict=True)
        parts = [nodes.values.T @ sp.diags_array(self.weights * share) for nodes, share in shares]
        return sp.vstack(parts).tocsr()

    def on_nodes(self, heat: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Owned nodal heat of the bodies, shape (n_owned, k), from that on both faces (n_f, k)."""
        n_owned = self.traces[0].shape[0]
        first, second = (
            nodes.spread(values, n_owned) for nodes, values in zip(self.nodes, heat, strict=True)
        )
        return first + second


class HeatExchange:
    """Faces coupled by a conductance.

    The unknowns are the nodal rises of both faces by the heat at the contact, and the coefficients
    of the heat that crosses beyond that of the point by point conductance, see `FaceHeat.divided`::

        x = (θ1, θ2, z),   Q = b + N x,   θ = Φ Q,   0 = b_z + (N x)_z,   x = G b

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
        self._splits = np.cumsum([nodes.count for nodes in face.nodes])
        self._set_up()

    def _set_up(self) -> None:
        """Scale the functions of crossing heat, and factorise."""
        self.scale = jump_scale(self.face, self.division)
        self.coupling = coupling_matrix(self.face, self.division, self.scale, self.face.shift)
        self._factor = _factorised(self._matrix())

    @cached_property
    def _crossing(self) -> sp.csr_array:
        """Scaled functions ``η Ψ`` of the heat that crosses beyond the direct part, (n, n_z)."""
        basis = scaled_functions(self.face, self.scale)
        return (sp.diags_array(self.division[1]) @ basis).tocsr()

    def state(self, friction_heat: np.ndarray, baseline: BaselineResponse) -> ThermalState:
        """Temperatures and fluxes due to friction heat [W/m²] at the points, shape (n,)."""
        changes, crossing = self._solved(friction_heat, baseline)
        (T1, T2), f = baseline.rise, self.face.partition
        return ThermalState(
            (T1 + changes[0], T2 + changes[1]),
            (f * friction_heat + crossing, (1 - f) * friction_heat - crossing),
        )

    def crossing(self, friction_heat: np.ndarray) -> np.ndarray:
        """Heat per area from body 2 to body 1 by friction heat, columns of shape (n, k)."""
        return self._solved(friction_heat, None)[1]

    def nodal_heat(self, friction_heat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Heat into the nodes of both faces by friction heat (n, k), bath included [W]."""
        heat = self.loads(friction_heat)
        first, second, _ = self._parts(heat + self.coupling @ self.response(heat))
        return first, second

    def opened(self, per_heat: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Functionals of the coupled faces per load, from those per nodal heat of each face.

        Parameters
        ----------
        per_heat : tuple of ndarray, shape (k, n_f)
            Functionals (weak gaps, say) per nodal heat into each body.

        Returns
        -------
        ndarray, shape (k, n_f1 + n_f2 + n_z)
            Functionals per load of `loads`.
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
        w, s, across = face.weights, face.shift, self.division[0] * (T2 - T1)
        one, two = (nodes.values.T for nodes in face.nodes)
        heat = one @ (w * (s * T1 + across)), two @ (w * (s * T2 - across))
        return loads + np.concatenate([*heat, self._crossing.T @ (w * (T1 - T2))])

    def _solved(self, friction_heat: np.ndarray, baseline: BaselineResponse | None):
        """Changes of the rises of both faces at the points, and heat from body 2 to body 1."""
        θ1, θ2, z = self._parts(self.response(self.loads(friction_heat, baseline)))
        one, two = (nodes.values for nodes in self.face.nodes)
        changes = one @ θ1, two @ θ2
        difference = changes[1] - changes[0]
        if baseline is not None:
            difference = difference + baseline.rise[1] - baseline.rise[0]
        return changes, (self.division[0] * difference.T).T + self._crossing @ z

    def response(self, loads: np.ndarray) -> np.ndarray:
        """Unknowns ``x = G b`` by loads b, by columns."""
        (first, second, jump), (Φ1, Φ2) = self._parts(loads), self.face.response
        found, _ = dgetrs(*self._factor, np.concatenate([Φ1 @ first, Φ2 @ second, jump]))
        return found.reshape(loads.shape)

    def transposed_response(self, values: np.ndarray) -> np.ndarray:
        """Products ``Gᵀ values``, by columns."""
        if self.face.symmetric:
            return self.response(values)
        first, second, jump = self._parts(dgetrs(*self._factor, values, trans=1)[0])
        Φ1, Φ2 = self.face.response
        return np.concatenate([Φ1.T @ first, Φ2.T @ second, jump])

    def _parts(self, values):
        """Rows of both faces and of the jumps."""
        start, end = self._splits
        return values[:start], values[start:end], values[end:]

    def _matrix(self) -> np.ndarray:
        """Matrix of the unknowns: ``I - Φ N``, and ``-N`` in the rows of the jumps."""
        first, second, jump = self._parts(self.coupling)
        matrix = np.empty(self.coupling.shape, order="F")
        start, end = self._splits
        Φ1, Φ2 = self.face.response
        matrix[:start], matrix[start:end] = -(Φ1 @ first), -(Φ2 @ second)
        matrix[end:] = -jump.toarray()
        matrix[np.arange(end), np.arange(end)] += 1.0
        return matrix


def jump_scale(face: InterfaceHeat, division: Division) -> np.ndarray:
    """Scale of the functions of heat that crosses beyond the direct part, shape (m,).

    By the temperature jump that they cause; zero where no such heat crosses.
    """
    _, passing_fraction, resistance = division
    crossing = (sp.diags_array(face.weights * passing_fraction) @ sp.csr_array(face.basis)).tocsc()
    used = np.unique(crossing.nonzero()[1])
    basis, crossing = sp.csr_array(face.basis).tocsc()[:, used], crossing[:, used]
    jumps = (basis.T @ sp.diags_array(face.weights * resistance) @ basis).diagonal()
    for nodes, response in zip(face.nodes, face.response, strict=True):
        heat = nodes.values.T @ crossing
        jumps = jumps + heat.multiply(response @ heat).sum(axis=0)
    result = np.zeros(face.basis.shape[1])
    result[used] = 1 / np.sqrt(jumps)
    return result


def scaled_functions(face: InterfaceHeat, scale: np.ndarray) -> sp.csr_array:
    """Functions Ψ with a scale other than zero, times it, shape (n, n_z)."""
    used = np.flatnonzero(scale)
    basis = sp.csr_array(face.basis).tocsc()[:, used]
    return (basis @ sp.diags_array(scale[used])).tocsr()


def coupling_matrix(
    face: InterfaceHeat,
    division: Division,
    scale: np.ndarray,
    shift: float,
    points: np.ndarray | slice = slice(None),
) -> sp.csr_array:
    """Matrix N: heat into the nodes of both faces, and weak temperature jumps.

    The contribution of some contact points; linear in the division of their conductances and in
    the heat transfer `shift` to the bath [W/(m² K)].
    """
    w = face.weights[points]
    direct, passing_fraction, resistance = (part[points] for part in division)
    bath, across = sp.diags_array(w * (shift - direct)), sp.diags_array(w * direct)
    P1, P2 = (nodes.values[points] for nodes in face.nodes)
    basis = scaled_functions(face, scale)[points]
    C1, C2 = (P.T @ sp.diags_array(w * passing_fraction) @ basis for P in (P1, P2))
    resisted = basis.T @ sp.diags_array(w * resistance) @ basis
    return sp.block_array(
        [
            [P1.T @ bath @ P1, P1.T @ across @ P2, C1],
            [P2.T @ across @ P1, P2.T @ bath @ P2, -C2],
            [C1.T, -C2.T, resisted],
        ],
        format="csr",
    )


def _factorised(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangular factors of a matrix (overwritten) with pivots."""
    factor, pivots, singular = dgetrf(matrix, overwrite_a=1)
    if singular:
        raise ComputationError(NO_HEAT_SINK)
    return factor, pivots
