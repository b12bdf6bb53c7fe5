"""Joints of glued bodies: weak continuity across them.

Lagrange multipliers λ impose that the weak jump of a field across a joint vanishes, or that it is
that of an interface with a resistance: with the matrix C of the weak jump

    K u + Cᵀ λ = f,      C u - R λ = 0.

``-Cᵀ λ`` are nodal loads that the joint exerts on the bodies, on both the same and opposite.

Where the first body of a joint has fixed values at it, its free ones may not resolve all functions
of the multipliers: the conditions beyond them would act on the other body alone, and hold it too
much. These functions are added to their neighbours, so that uniform multipliers remain (as at the
ends of mortar faces: Bernardi, Maday and Patera, 1994).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import dpstrf
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from ..parallel import sum_over_ranks
from .spaces import Rows, Spaces, groups_of, without_fixed


@dataclass(frozen=True)
class Joint:
    """Joint of two bodies.

    Attributes
    ----------
    bodies : tuple of int
        Indices of the bodies.
    surfaces : tuple of str
        Their glued surfaces.
    jump : csr_matrix, shape (n_owned, m)
        Cᵀ: transposed matrix of the weak jump of a field across the joint.
    own : csr_matrix, shape (n_owned, m)
        Part of it in the first body, on the facets of which the multipliers are defined.
    resistance : csr_matrix, shape (m, m)
        R: weak jump per multiplier, positive definite or, where the field is continuous, zero.
    """

    bodies: tuple[int, int]
    surfaces: tuple[str, str]
    jump: sp.csr_matrix
    own: sp.csr_matrix
    resistance: sp.csr_matrix

    @property
    def count(self) -> int:
        """Number m of multipliers."""
        return self.jump.shape[1]


@dataclass(frozen=True)
class Border:
    """Matrices that border the equations of a group of bodies, those of its joints.

    Attributes
    ----------
    jump, own : csr_matrix, shape (n_rows, m)
        Those of all joints of the group, see `Joint`.
    resistance : csr_matrix, shape (m, m)
    columns : ndarray of int, shape (m,)
        Numbers of its multipliers among those of all joints.
    closed : bool
        True if the joints form circles, so that some conditions may follow from others.
    known : dict
        Results of `conditions` by the mask of fixed values.
    """

    jump: sp.csr_matrix
    own: sp.csr_matrix
    resistance: sp.csr_matrix
    columns: np.ndarray
    closed: bool
    known: dict[bytes, sp.csr_array] = field(default_factory=dict, init=False, repr=False)

    @property
    def count(self) -> int:
        """Number m of multipliers."""
        return len(self.columns)


@dataclass(frozen=True)
class Joints:
    """Joints of all glued bodies.

    Attributes
    ----------
    each : tuple of Joint
    """

    each: tuple[Joint, ...] = ()

    @cached_property
    def starts(self) -> np.ndarray:
        """First multiplier of each joint, and their number at the end."""
        return np.cumsum([0, *(joint.count for joint in self.each)])

    @cached_property
    def count(self) -> int:
        """Number m of multipliers of all joints."""
        return int(self.starts[-1])

    @property
    def surfaces(self) -> tuple[str, ...]:
        """Glued surfaces."""
        return tuple(surface for joint in self.each for surface in joint.surfaces)

    @cached_property
    def jump(self) -> sp.csr_matrix:
        """Cᵀ of all joints, shape (n_owned, m)."""
        return sp.hstack([joint.jump for joint in self.each], format="csr")

    def jumps(self, spaces: Spaces, values: np.ndarray) -> np.ndarray:
        """Weak jumps ``C u`` of owned values (n_owned,), shape (m,). Every rank calls."""
        return sum_over_ranks(spaces.comm, self.jump.T @ values)

    def passed(self, spaces: Spaces, fields: np.ndarray) -> np.ndarray:
        """Energy ``Xᵀ Cᵀ R⁻¹ C X`` of fields X (n_owned, r) in joints with a resistance, (r, r).

        Every rank calls.
        """
        result = np.zeros((fields.shape[1],) * 2)
        for joint in self.each:
            if joint.resistance.nnz:
                jumps = sum_over_ranks(spaces.comm, joint.jump.T @ fields)
                result += jumps.T @ splu(joint.resistance.tocsc()).solve(jumps)
        return result

    def split(self, multipliers: np.ndarray) -> list[np.ndarray]:
        """Multipliers (m,) of each joint."""
        return np.split(multipliers, self.starts[1:-1])

    def joining(self, spaces: Spaces) -> Spaces:
        """Spaces in which glued bodies are solved together."""
        return Spaces(spaces.each, tuple(joint.bodies for joint in self.each))

    def border(self, bodies: Sequence[int], rows: Rows) -> Border:
        """Border of the equations of bodies, to which no other is glued, by their owned rows."""
        key = tuple(bodies)
        if key not in self._borders:
            self._borders[key] = self._border(key, rows)
        return self._borders[key]

    @cached_property
    def _borders(self) -> dict[tuple[int, ...], Border]:
        """Borders made so far, by the bodies."""
        return {}

    def _border(self, bodies: tuple[int, ...], rows: Rows) -> Border:
        own = [k for k, joint in enumerate(self.each) if joint.bodies[0] in bodies]
        columns = [np.arange(*self.starts[k : k + 2]) for k in own]
        if not own:
            none = sp.csr_matrix((0, 0))
            return Border(none, none, none, np.zeros(0, dtype=int), False)
        position = {body: k for k, body in enumerate(bodies)}
        pairs = [(position[one], position[two]) for one, two in (self.each[k].bodies for k in own)]
        return Border(
            sp.hstack([self.each[k].jump[rows] for k in own], format="csr"),
            sp.hstack([self.each[k].own[rows] for k in own], format="csr"),
            sp.block_diag([self.each[k].resistance for k in own], format="csr"),
            np.concatenate(columns),
            closed=len(own) + len(groups_of(len(bodies), pairs)) > len(bodies),
        )


NO_JOINTS = Joints()


_DEPENDENT = 1e-12
"""Part of a condition that is not a combination of others, squared, below which it is one."""


def conditions(border: Border, fixed: np.ndarray, comm) -> sp.csr_array:
    """Independent combinations of the conditions of joints, as columns, shape (m, k).

    Every rank calls.

    Parameters
    ----------
    border : Border
    fixed : ndarray of bool, shape (n_rows,)
        Mask of fixed values.
    comm : mpi4py.MPI.Comm
    """
    key = fixed.tobytes()
    if not all(comm.allgather(key in border.known)):
        joined = _resolved(border, fixed, comm)
        border.known[key] = joined[:, _independent(border, joined, fixed, comm)]
    return border.known[key]


def _resolved(border: Border, fixed: np.ndarray, comm) -> sp.csr_array:
    """Combinations of conditions that the free values of the first bodies resolve."""
    own, free = (_gram(part, comm) for part in (border.own, without_fixed(border.own, fixed)))
    whole = own.diagonal()
    scale = sp.diags_array(1 / np.sqrt(np.where(whole > 0.0, whole, 1.0)))
    own, free = ((scale @ gram @ scale).tocsr() for gram in (own, free))
    own.data[np.abs(own.data) < _DEPENDENT] = 0.0
    own.eliminate_zeros()
    count, result = len(whole), sp.eye_array(len(whole), format="lil")
    missing, dropped = _dependent(own, free, free.diagonal() < own.diagonal()), []
    kept = np.setdiff1d(np.arange(count), missing)
    for one in missing:
        neighbours = np.intersect1d(own[[one]].indices, kept)
        if len(neighbours):
            result[one, neighbours] = 1 / len(neighbours)
            dropped.append(one)
    return sp.csr_array(result)[:, np.setdiff1d(np.arange(count), dropped)]


def _independent(border: Border, joined: sp.csr_array, fixed: np.ndarray, comm) -> np.ndarray:
    """Numbers of conditions that act on free values and do not follow from others.

    Some may follow only where values are fixed, or joints form circles; with a resistance none do.
    """
    jump = border.jump @ joined
    whole, gram = (_gram(sp.csr_matrix(part), comm) for part in (jump, without_fixed(jump, fixed)))
    sizes, size = whole.diagonal(), gram.diagonal()
    acting = np.flatnonzero(size > _DEPENDENT * sizes)
    scale = sp.diags_array(1 / np.sqrt(size[acting]))
    gram = (scale @ gram[acting][:, acting] @ scale).tocsr()
    resisted = (joined.T @ border.resistance @ joined).diagonal()[acting] > 0.0
    risky = ~resisted & (border.closed | (size[acting] < sizes[acting]))
    return np.delete(acting, _dependent(gram, gram, risky))


def _gram(columns: sp.csr_matrix, comm) -> sp.csr_array:
    """Products of columns with each other, of the rows of all ranks."""
    own = sp.csr_array(columns.T @ columns)
    return own if comm.size == 1 else sum(comm.allgather(own), sp.csr_array(own.shape))


def _dependent(links: sp.csr_array, gram: sp.csr_array, risky: np.ndarray) -> np.ndarray:
    """Numbers of conditions that follow from others, by their Gram matrix.

    Cholesky's factorisation with pivots (LAPACK) of each of its blocks, connected by links, with a
    condition that may be dependent. Diagonal entries are at most one.
    """
    block = connected_components(links, directed=False)[1]
    found = [np.zeros(0, dtype=int)]
    for k in np.unique(block[risky]):
        members = np.flatnonzero(block == k)
        _, pivots, rank, _ = dpstrf(gram[members][:, members].toarray(), tol=_DEPENDENT)
        found.append(members[pivots[rank:] - 1])
    return np.concatenate(found)
