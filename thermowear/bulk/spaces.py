"""Finite element spaces of the bodies, and their fields as plain arrays.

A field of all bodies is one array on each rank: the values that the rank owns, body by body. A
matrix of all bodies has the same layout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from petsc4py import PETSc

import basix
import basix.ufl
import numpy as np
import scipy.sparse as sp
from dolfinx import fem
from scipy.sparse.csgraph import connected_components

from ..compat import coordinate_element
from .bodies import Bodies
from .compiled import nodal_loads


def lagrange_space(mesh, degree: int, components: int = 0) -> fem.FunctionSpace:
    """Continuous Lagrange space (Gauss-Lobatto-Legendre warped nodes), scalar or vector-valued."""
    shape = (components,) if components else None
    element = basix.ufl.element("Lagrange", mesh.basix_cell(), degree, shape=shape)
    return fem.functionspace(mesh, element)


def geometry_space(mesh) -> fem.FunctionSpace:
    """Continuous scalar space whose nodes are the points of the mesh."""
    element = basix.ufl.element(
        "Lagrange",
        mesh.basix_cell(),
        coordinate_element(mesh).degree,
        lagrange_variant=basix.LagrangeVariant.equispaced,
    )
    return fem.functionspace(mesh, element)


def reference_element(mesh, degree: int):
    """Scalar basix element of `lagrange_space`, for tabulation."""
    cell = mesh.basix_cell()
    cell = basix.CellType[cell] if isinstance(cell, str) else cell
    return basix.create_element(
        basix.ElementFamily.P, cell, degree, basix.LagrangeVariant.gll_warped
    )


def basis_element(space: fem.FunctionSpace):
    """Scalar basix element of a scalar or vector-valued space, for tabulation."""
    element = space.ufl_element()
    return (element.sub_elements[0] if space.dofmap.index_map_bs > 1 else element).basix_element


def owned(space: fem.FunctionSpace) -> int:
    """Number of values owned by this rank."""
    return space.dofmap.index_map.size_local * space.dofmap.index_map_bs


def as_function(space: fem.FunctionSpace, values: np.ndarray, name: str) -> fem.Function:
    """Create a dolfinx function from owned values. Every rank calls."""
    function = fem.Function(space, name=name)
    function.x.array[: len(values)] = values
    function.x.scatter_forward()
    return function


def without_fixed(loads, fixed: np.ndarray):
    """Copy of dense or sparse loads, (n_owned,) or (n_owned, m), with zeros in the fixed rows."""
    if sp.issparse(loads):
        return (sp.diags(~fixed, dtype=float) @ loads).tocsr()
    result = np.array(loads, dtype=float)
    result[fixed] = 0.0
    return result


Rows: TypeAlias = "slice | np.ndarray"
"""Owned rows of a group of bodies, in ascending order."""


@dataclass(frozen=True)
class Spaces:
    """Function spaces of equal degree, one for each body.

    Attributes
    ----------
    each : tuple of dolfinx.fem.FunctionSpace
    glued : tuple of tuple of int
        Pairs of bodies that are glued to each other.
    """

    each: tuple[fem.FunctionSpace, ...]
    glued: tuple[tuple[int, int], ...] = ()

    @cached_property
    def comm(self):
        return self.each[0].mesh.comm

    @cached_property
    def components(self) -> int:
        """Number of components of the fields."""
        return self.each[0].dofmap.index_map_bs

    @cached_property
    def degree(self) -> int:
        return self.each[0].ufl_element().degree

    @cached_property
    def dim(self) -> int:
        """Dimension of the cells."""
        return self.each[0].mesh.topology.dim

    @cached_property
    def starts(self) -> np.ndarray:
        """First value of each body in an array of owned values, and their number at the end."""
        return np.cumsum([0, *map(owned, self.each)])

    @property
    def owned(self) -> int:
        """Number of values owned by this rank."""
        return int(self.starts[-1])

    @property
    def total(self) -> int:
        """Number of values on all ranks."""
        return sum(s.dofmap.index_map.size_global * s.dofmap.index_map_bs for s in self.each)

    def split(self, values: np.ndarray) -> list[np.ndarray]:
        """Parts of an array of owned values, or of its rows, body by body."""
        return [values[a:b] for a, b in zip(self.starts[:-1], self.starts[1:], strict=True)]

    def functions(self, values: np.ndarray, name: str) -> list[fem.Function]:
        """Create the functions of owned values. Every rank calls."""
        parts = zip(self.each, self.split(values), strict=True)
        return [as_function(space, part, name) for space, part in parts]

    @cached_property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Indices of the bodies of each group: of one body, or of those glued to each other."""
        return groups_of(len(self.each), self.glued)

    def rows(self, *bodies: int) -> Rows:
        """Owned rows of bodies, given in ascending order."""
        if len(bodies) == 1:
            return slice(*map(int, self.starts[bodies[0] : bodies[0] + 2]))
        return np.concatenate([np.arange(*self.starts[k : k + 2]) for k in bodies])

    def of_bodies(self, *bodies: int) -> Spaces:
        """Spaces of some bodies alone."""
        return Spaces(tuple(self.each[k] for k in bodies))

    def group_of(self, rows: np.ndarray) -> int:
        """Index of the group that owned rows belong to, all to the same. Every rank calls."""
        own = int(np.searchsorted(self.starts, rows[0], side="right")) - 1 if len(rows) else -1
        body = max(self.comm.allgather(own))
        return next(k for k, bodies in enumerate(self.groups) if body in bodies)

    def within(self, group: int, rows: np.ndarray) -> np.ndarray:
        """Positions of some owned rows among those of their group."""
        every = self.rows(*self.groups[group])
        return rows - every.start if isinstance(every, slice) else np.searchsorted(every, rows)

    def placed(self, at: Rows, rows: np.ndarray | sp.csr_matrix):
        """Values of given owned rows (of a body or a group) as rows of all, the others zero."""
        if isinstance(rows, np.ndarray):
            result = np.zeros((self.owned, *rows.shape[1:]), order="F")
            result[at] = rows
            return result
        counts = np.zeros(self.owned + 1, dtype=rows.indptr.dtype)
        counts[1:][at] = np.diff(rows.indptr)
        entries = rows.data, rows.indices, np.cumsum(counts, dtype=rows.indptr.dtype)
        return sp.csr_matrix(entries, shape=(self.owned, rows.shape[1]))

    def loads(self, works: Iterable[Callable]) -> np.ndarray:
        """Load vector of linear forms, one for each body, as functions of the test function."""
        parts = zip(self.each, works, strict=True)
        return np.concatenate([nodal_loads(space, work) for space, work in parts])

    def nodes(self) -> np.ndarray:
        """Coordinates of the owned nodes, shape (n_nodes, gdim) [m]."""
        gdim = self.each[0].mesh.geometry.dim
        return np.vstack(
            [
                space.tabulate_dof_coordinates()[: space.dofmap.index_map.size_local, :gdim]
                for space in self.each
            ]
        )

    def nodes_of(self, bodies: Bodies, *parts: str) -> np.ndarray:
        """Mask of the owned nodes that belong to parts of bodies, shape (n_nodes,)."""
        belongs = []
        for body, space in zip(bodies.each, self.each, strict=True):
            nodes = np.unique(space.dofmap.list[body.cells(*parts)])
            mask = np.zeros(space.dofmap.index_map.size_local, dtype=bool)
            mask[nodes[nodes < len(mask)]] = True
            belongs.append(mask)
        return np.concatenate(belongs)


def lagrange_spaces(bodies: Bodies, degree: int, components: int = 0) -> Spaces:
    """Continuous Lagrange spaces of all bodies, see `lagrange_space`."""
    return Spaces(tuple(lagrange_space(body.mesh, degree, components) for body in bodies.each))


def groups_of(count: int, glued: Sequence[tuple[int, int]]) -> tuple[tuple[int, ...], ...]:
    """Groups of bodies, by their indices, from their number and pairs of those glued together."""
    pairs = np.array(glued, dtype=int).reshape(-1, 2).T
    links = sp.coo_matrix((np.ones(pairs.shape[1]), pairs), shape=(count, count))
    number, group = connected_components(links, directed=False)
    return tuple(tuple(map(int, np.flatnonzero(group == k))) for k in range(number))


def distributed(spaces: Spaces, columns: sp.csr_matrix) -> PETSc.Mat:
    """Matrix of owned rows (n_owned, n) in PETSc, its columns distributed over the ranks too."""
    return in_petsc(columns, (spaces.owned, spaces.total), spaces.comm)


def in_petsc(columns: sp.csr_matrix, rows: tuple[int, int], comm) -> PETSc.Mat:
    """Matrix in PETSc with given numbers of owned and of all rows; columns are distributed."""
    csr = columns.indptr.astype(PETSc.IntType), columns.indices.astype(PETSc.IntType), columns.data
    sizes = rows, (PETSc.DECIDE, columns.shape[1])
    return PETSc.Mat().createAIJ(sizes, csr=csr, comm=comm)


def block_diagonal(blocks: Sequence[PETSc.Mat]) -> PETSc.Mat:
    """Matrix of all bodies from those of each, in the layout of `Spaces`. Every rank calls."""
    if len(blocks) == 1:
        return blocks[0]
    rows = [[b if i == k else None for i in range(len(blocks))] for k, b in enumerate(blocks)]
    return PETSc.Mat().createNest(rows, comm=blocks[0].comm).convert(PETSc.Mat.Type.AIJ)


def gathered(matrix: PETSc.Mat) -> sp.csr_matrix:
    """Copy of a distributed matrix on every rank. Every rank calls."""
    indptr, indices, data = matrix.getValuesCSR()
    own = sp.csr_matrix((data, indices, indptr), shape=(len(indptr) - 1, matrix.getSize()[1]))
    return gathered_rows(own, matrix.comm.tompi4py())


def gathered_rows(own: np.ndarray | sp.csr_matrix, comm):
    """Rows of all ranks, dense or sparse, in the order of the ranks. Every rank calls."""
    if comm.size == 1:
        return own
    parts = comm.allgather(own)
    return sp.vstack(parts, format="csr") if sp.issparse(own) else np.concatenate(parts)
