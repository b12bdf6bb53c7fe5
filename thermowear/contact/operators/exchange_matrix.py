"""Matrices of the heat exchange of faces: division of conductances, coupling of the nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import dgetrf, dgetrs
from scipy.sparse.linalg import splu

from ...errors import ComputationError
from .heat import NO_HEAT_SINK

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
