"""Mesh motion: harmonic extension of displacements of the boundary into the interior."""

from __future__ import annotations

from mpi4py import MPI
from petsc4py import PETSc

import dolfinx
import numpy as np
import ufl
from dolfinx import fem

from ..compat import geometry_dofmap
from .bodies import Bodies, created_mesh, in_dolfinx_order
from .compiled import assembled_matrix
from .solvers.direct import DirectSolver, multiply
from .spaces import geometry_space, owned


class HarmonicExtension:
    """Harmonic extension of nodal displacements, ``∫ grad u·grad v = 0`` for each component u.

    Displacements are polynomials of the order of the mesh. The matrix is factorised once for all
    components and displacements.

    Parameters
    ----------
    mesh : dolfinx.mesh.Mesh
        Every rank calls. Also lines or surfaces in space.
    known : ndarray of bool, shape (n_points,), optional
        Points with prescribed displacement, numbered as when the mesh was created; by default
        those on the boundary of the mesh.
    """

    def __init__(self, mesh: dolfinx.mesh.Mesh, known: np.ndarray | None = None):
        space = geometry_space(mesh)
        self._comm, count = mesh.comm, owned(space)
        number = _numbers(space)
        fixed = _on_boundary(space) if known is None else known[number]
        self._number, self._free = number[:count], np.flatnonzero(~fixed[:count])
        matrix = _laplacian(space)
        first, _ = matrix.getOwnershipRange()
        numbers = (first + self._free).astype(PETSc.IntType)
        free = PETSc.IS().createGeneral(numbers, comm=mesh.comm)
        every = PETSc.IS().createStride(count, first, 1, comm=mesh.comm)
        self._rows, inner = matrix.createSubMatrix(free, every), matrix.createSubMatrix(free, free)
        # the ordering of plane meshes, as that of meshes in space aborts on a few unknowns
        self._solver = DirectSolver(inner, dim=2) if inner.getSize()[0] else None

    def __call__(self, given: np.ndarray) -> np.ndarray:
        """Displacement of all points from that of the known ones. Every rank calls.

        Parameters
        ----------
        given : ndarray, shape (n_points, gdim)
            The same on all ranks; values at points to be found are ignored [m].

        Returns
        -------
        ndarray, shape (n_points, gdim)
            The same on all ranks; points that are not nodes of the mesh keep what is given [m].
        """
        result = given.copy()
        if self._solver is None:
            return result
        prescribed = given[self._number]
        prescribed[self._free] = 0.0
        loads = [-multiply(self._rows, values) for values in prescribed.T]
        found = self._solver.solve(np.column_stack(loads))
        for points, values in self._comm.allgather((self._number[self._free], found)):
            result[points] = values
        return result


def extended(bodies: Bodies, given: np.ndarray) -> np.ndarray:
    """Harmonic extension of displacements of all boundaries into the bodies. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    given : ndarray, shape (n_points, gdim)
        At the points of the tagged mesh; values inside of the bodies are ignored [m].

    Returns
    -------
    ndarray, shape (n_points, gdim)
        The same on all ranks [m].
    """
    result = given.copy()
    for body in bodies.each:
        numbers = bodies.comm.bcast(body.point_numbers)
        result[numbers] = HarmonicExtension(body.mesh)(given[numbers])
    return result


def serial_extension(
    tagged, kind: str, cells: np.ndarray, known: np.ndarray | None = None
) -> HarmonicExtension:
    """Harmonic extension on this rank alone, into cells, facets or edges of a tagged mesh.

    Parameters
    ----------
    tagged : thermowear.geometry.TaggedMesh
        Supplies points and order.
    kind : str
        Cell type of the entities to extend into.
    cells : ndarray of int, shape (n, nodes)
        Their nodes in the order of the tagged mesh.
    known : ndarray of bool, shape (n_points,), optional
        Points with prescribed displacement, by default those on the boundary of the cells.
    """
    cells = in_dolfinx_order(tagged, kind, cells)
    mesh = created_mesh(MPI.COMM_SELF, kind, tagged.order, cells, tagged.points)
    return HarmonicExtension(mesh, known)


def _numbers(space: fem.FunctionSpace) -> np.ndarray:
    """Number of the point of each local node of a `spaces.geometry_space`."""
    mesh, index_map = space.mesh, space.dofmap.index_map
    points = np.asarray(mesh.geometry.input_global_indices)
    result = np.empty(index_map.size_local + index_map.num_ghosts, dtype=np.int64)
    result[space.dofmap.list] = points[geometry_dofmap(mesh)]
    return result


def _on_boundary(space: fem.FunctionSpace) -> np.ndarray:
    """Mask of the local nodes on the boundary of the mesh."""
    topology, index_map = space.mesh.topology, space.dofmap.index_map
    topology.create_connectivity(topology.dim - 1, topology.dim)
    facets = dolfinx.mesh.exterior_facet_indices(topology)
    result = np.zeros(index_map.size_local + index_map.num_ghosts, dtype=bool)
    result[fem.locate_dofs_topological(space, topology.dim - 1, facets)] = True
    return result


def _laplacian(space: fem.FunctionSpace) -> PETSc.Mat:
    """Matrix of ``∫ grad u·grad v`` with ``order + 2`` Gauss points along each side of a cell."""
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    degree = 2 * space.ufl_element().degree + 3
    measure = ufl.dx(metadata={"quadrature_degree": degree})
    return assembled_matrix(ufl.inner(ufl.grad(u), ufl.grad(v)) * measure)
