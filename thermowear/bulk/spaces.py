"""Finite element spaces of the bodies, and the layout of their fields as plain arrays.

A field of all bodies is one array on each rank: the values that the rank owns, body by body. A
matrix of all bodies has the same layout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from .bodies import Bodies
from .compiled import nodal_loads
from .field import as_function, lagrange_space, owned


@dataclass(frozen=True)
class Spaces:
    """Function spaces of equal degree, one for each body.

    Attributes
    ----------
    each : tuple of dolfinx.fem.FunctionSpace
    """

    each: tuple[fem.FunctionSpace, ...]

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

    def body_of(self, rows: np.ndarray) -> int:
        """Index of the body that owned rows belong to, all to the same. Every rank calls."""
        own = int(np.searchsorted(self.starts, rows[0], side="right")) - 1 if len(rows) else -1
        return max(self.comm.allgather(own))

    def placed(self, index: int, rows: np.ndarray | sp.csr_matrix):
        """Rows of one body as rows of all, the others zero."""
        if isinstance(rows, np.ndarray):
            result = np.zeros((self.owned, *rows.shape[1:]), order="F")
            self.split(result)[index][...] = rows
            return result
        before, after = self.starts[index], self.owned - self.starts[index + 1]
        none = (sp.csr_matrix((count, rows.shape[1])) for count in (before, after))
        return sp.vstack([next(none), rows, next(none)], format="csr")

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
    """Continuous Lagrange spaces of all bodies, see `field.lagrange_space`."""
    return Spaces(tuple(lagrange_space(body.mesh, degree, components) for body in bodies.each))


def block_diagonal(blocks: Sequence[PETSc.Mat]) -> PETSc.Mat:
    """Matrix of all bodies from those of each, in the layout of `Spaces`. Every rank calls."""
    if len(blocks) == 1:
        return blocks[0]
    rows = [[b if i == k else None for i in range(len(blocks))] for k, b in enumerate(blocks)]
    return PETSc.Mat().createNest(rows, comm=blocks[0].comm).convert(PETSc.Mat.Type.AIJ)
