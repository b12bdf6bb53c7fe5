"""Hierarchical error estimate: correction of a linear problem by the surplus of the next degree.

It consists of the polynomials of degree k + 1 that vanish at the nodes of degree k. On an edge with
Gauss-Lobatto nodes that is one function, ``(1 - s²) P'_k(s)``, so that the surplus is continuous
between cells, and in 1D orthogonal in energy to the polynomials of degree k (Szabó and Babuška,
Finite Element Analysis (1991), 6.1). On hexahedra only its products with linear functions of the
other directions are used: the others have a higher total degree and cost ten times as much.

The existing factorisation solves the problem on its own space; the surplus is nearly orthogonal to
that space in energy, and its matrix is well conditioned. One step of conjugate gradients,
preconditioned by block Gauss-Seidel (surplus, space, surplus), yields at least four fifths of the
change that a solution of the next degree would bring: an estimate of the error (Bank and Smith,
SIAM J. Numer. Anal. 30 (1993) 921: hierarchical bases).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import compress, product

from petsc4py import PETSc

import basix
import basix.ufl
import numpy as np
import ufl
from dolfinx import fem, la

from ...parallel import sum_over_ranks
from ..bodies import Bodies, BodyMesh
from ..compiled import assembled, assembled_matrix, compiled, restricted
from ..solvers.direct import DirectSolver, multiply
from ..spaces import Spaces, block_diagonal, reference_element

_LEGENDRE = basix.PolynomialType.legendre
_RANK_TOLERANCE = 1e-10


def surplus_spaces(bodies: Bodies, degree: int, components: int = 0) -> Spaces:
    """Surplus spaces over `spaces.lagrange_spaces` of a degree, scalar or vector-valued."""
    each = []
    for body in bodies.each:
        element = _element(reference_element(body.mesh, 1).cell_type, degree)
        if components:
            element = basix.ufl.blocked_element(element, shape=(components,))
        each.append(fem.functionspace(body.mesh, element))
    return Spaces(tuple(each))


@cache
def _element(cell: basix.CellType, degree: int):
    """Scalar element; its degrees of freedom are moments on edges, facets and cells."""
    geometry, topology = np.asarray(basix.geometry(cell)), basix.topology(cell)
    edges_only = cell == basix.CellType.hexahedron
    dim = len(topology) - 1
    points: list[list[np.ndarray]] = [[] for _ in range(4)]
    moments: list[list[np.ndarray]] = [[] for _ in range(4)]
    for d, (entities, kinds) in enumerate(
        zip(topology, basix.cell.subentity_types(cell), strict=True)
    ):
        for corners, kind in zip(entities, kinds, strict=True):
            at, weights = np.zeros((0, dim)), np.zeros((0, 0))
            if d == 1 or (d > 1 and not edges_only):
                local, weights = _moments(kind, degree)
                at = _mapped(kind, geometry[corners], local)
            points[d].append(np.ascontiguousarray(at))
            moments[d].append(np.ascontiguousarray(weights[:, None, :, None]))
    span = _products(cell, degree) if edges_only else _vanishing(cell, degree, inside=False)
    return basix.ufl.custom_element(
        cell,
        [],
        np.ascontiguousarray(span),
        points,
        moments,
        0,
        basix.MapType.identity,
        basix.SobolevSpace.H1,
        False,
        1,
        degree + 1,
    )


def _vanishing(cell: basix.CellType, degree: int, inside: bool) -> np.ndarray:
    """Polynomials of degree k + 1 that vanish at the nodes of degree k, in an orthonormal basis.

    If `inside`, they vanish on the boundary of the cell too.
    """
    low, high = (
        basix.create_element(basix.ElementFamily.P, cell, k, basix.LagrangeVariant.gll_warped)
        for k in (degree, degree + 1)
    )
    nodes = np.asarray(low.points)
    if inside:
        boundary = [i for entities in high.entity_dofs[:-1] for dofs in entities for i in dofs]
        nodes = np.vstack([nodes, np.asarray(high.points)[boundary]])
    values = np.asarray(basix.tabulate_polynomials(_LEGENDRE, cell, degree + 1, nodes))
    left, sizes, _ = np.linalg.svd(values)
    return left[:, np.count_nonzero(sizes > _RANK_TOLERANCE * sizes[0]) :].T


@cache
def _moments(kind: basix.CellType, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Quadrature points in an edge, facet or cell, and the weights of each moment there."""
    points, weights = _quadrature(kind, 2 * degree + 2)
    values = basix.tabulate_polynomials(_LEGENDRE, kind, degree + 1, points)
    return points, _vanishing(kind, degree, inside=True) @ values * weights


def _quadrature(cell: basix.CellType, degree: int) -> tuple[np.ndarray, np.ndarray]:
    points, weights = basix.make_quadrature(cell, degree)
    return np.asarray(points), np.asarray(weights)


def _mapped(kind: basix.CellType, corners: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Map local points of an edge or facet with given corners to the cell."""
    units = np.asarray(basix.geometry(kind))
    along = [np.flatnonzero((units == unit).all(axis=1))[0] for unit in np.eye(units.shape[1])]
    return corners[0] + local @ (corners[along] - corners[0])


def _products(cell: basix.CellType, degree: int) -> np.ndarray:
    """Surplus along each direction times linear functions of the others, orthonormalised."""
    line = basix.CellType.interval
    inner = _vanishing(line, degree, inside=True)
    points, weights = _quadrature(cell, 2 * degree + 4)
    dim = points.shape[1]
    functions = []
    for i in range(dim):
        column = np.ascontiguousarray(points[:, i : i + 1])
        along = (inner @ basix.tabulate_polynomials(_LEGENDRE, line, degree + 1, column))[0]
        others = [points[:, j] for j in range(dim) if j != i]
        for ends in product((False, True), repeat=dim - 1):
            linear = [x if end else 1 - x for x, end in zip(others, ends, strict=True)]
            functions.append(along * np.prod(linear, axis=0))
    values = basix.tabulate_polynomials(_LEGENDRE, cell, degree + 1, points)
    return np.linalg.qr(values @ (np.array(functions) * weights).T)[0].T


_TOLERANCE = 1e-2  # of iterative solutions on the surplus in 3D; a factorisation costs too much


class EnrichedProblem:
    """Positive definite problem on a space and its surplus.

    A field is an array of the owned values of the space, followed by those of the surplus.

    Parameters
    ----------
    spaces, surplus : Spaces
        See `surplus_spaces`.
    forms, regular : sequence of sequence of callable
        For each body, terms of the bilinear form as functions of trial and test functions. Terms in
        `regular` enter corrections only; they regularise bodies without supports.
    solve : callable
        Solver for corrections on the space alone, for loads (n_owned,).
    fixed : tuple of ndarray of bool
        Masks of prescribed values of the space and of the surplus, which remain unchanged.
    regular : sequence of sequence of callable, optional
    symmetric : bool
        False if a form is not, as that of advection.
    near : sequence of ndarray of int, optional
        Owned cells of each body to which the surplus is restricted, see `cells_near`.
    """

    def __init__(
        self,
        spaces: Spaces,
        surplus: Spaces,
        forms: Sequence[Sequence[Callable]],
        solve: Callable[[np.ndarray], np.ndarray],
        fixed: tuple[np.ndarray, np.ndarray],
        regular: Sequence[Sequence[Callable]] | None = None,
        symmetric: bool = True,
        near: Sequence[np.ndarray] | None = None,
    ):
        self.spaces, self.surplus, self._symmetric = spaces, surplus, symmetric
        self._comm = spaces.comm
        self._solve, self._near = solve, near
        inside = ~fixed[1] if near is None else ~fixed[1] & _inside(surplus, near)
        self._free = np.concatenate([~fixed[0], inside])
        self._values = [
            (fem.Function(space), fem.Function(more))
            for space, more in zip(spaces.each, surplus.each, strict=True)
        ]
        regular = [() for _ in forms] if regular is None else regular
        given = forms, regular
        forms, regular = ([self._present(*one) for one in enumerate(each)] for each in given)
        self._forces_of, self._regular = (
            [self._actions(terms, part) for part in (spaces, surplus)] for terms in (forms, regular)
        )
        blocks = []
        for index, (space, *terms) in enumerate(zip(surplus.each, forms, regular, strict=True)):
            trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
            every = [self._restricted(term(trial, test), index) for some in terms for term in some]
            blocks.append(assembled_matrix(*every))
        self._block = _SurplusBlock(block_diagonal(blocks), inside, spaces.dim, symmetric)

    def _actions(self, forms: Sequence[Sequence[Callable]], part: Spaces) -> list[list[fem.Form]]:
        """Compiled actions of terms on the field, tested by the space or its surplus."""
        result = []
        for index, (terms, space) in enumerate(zip(forms, part.each, strict=True)):
            field, test = sum(self._values[index]), ufl.TestFunction(space)
            result.append([compiled(self._restricted(term(field, test), index)) for term in terms])
        return result

    def _present(self, index: int, terms: Sequence[Callable]) -> list[Callable]:
        """Terms of a body without those that no cell or facet with a surplus has on any rank.

        The first one remains: it gives the matrix its pattern.
        """
        if self._near is None:
            return list(terms)
        test, counts = ufl.TestFunction(self.surplus.each[index]), []
        for term in terms[1:]:
            form = self._restricted(term(self._values[index][1], test), index)
            domains = [domain for part in form.integrals() for _, domain in part.subdomain_data()]
            counts.append(max(map(len, domains)))
        present = np.any(self._comm.allgather(counts), axis=0)
        return [*terms[:1], *compress(terms[1:], present)]

    def _restricted(self, form: ufl.Form, index: int) -> ufl.Form:
        """Form of a body, integrated over the cells with a surplus and their facets."""
        return form if self._near is None else restricted(form, self._near[index])

    def field(self, values: np.ndarray) -> np.ndarray:
        """Field with given values of the space (n_owned,) and zero surplus."""
        return np.concatenate([values, np.zeros(self.surplus.owned)])

    def functions(self, field: np.ndarray) -> list:
        """Field as a UFL expression for each body, valid until the next call."""
        count = self.spaces.owned
        parts = self.spaces.split(field[:count]), self.surplus.split(field[count:])
        for functions, *given in zip(self._values, *parts, strict=True):
            for function, values in zip(functions, given, strict=True):
                function.x.array[: len(values)] = values
                function.x.scatter_forward()
        return [values[0] + values[1] for values in self._values]

    def surplus_loads(self, forms: Sequence[Callable]) -> np.ndarray:
        """Loads on the surplus of linear forms of its test function, one for each body."""
        tests = map(ufl.TestFunction, self.surplus.each)
        each = enumerate(zip(forms, tests, strict=True))
        every = [self._restricted(form(test), index) for index, (form, test) in each]
        return np.concatenate([assembled(compiled(form)) for form in every])

    def residual(self, field: np.ndarray, loads: np.ndarray, more: np.ndarray) -> np.ndarray:
        """Residual of a solution on the space under loads, zero in fixed values.

        Parameters
        ----------
        field : ndarray
            The solution balances its loads on the space; there, only `more` is left.
        loads : ndarray
            Loads on the surplus.
        more : ndarray
            Loads on the space that the solution does not know.
        """
        self.functions(field)
        forces = _sum(self._forces_of[1])
        return np.where(self._free, np.concatenate([more, loads - forces]), 0.0)

    def correction(self, residual: np.ndarray) -> np.ndarray:
        """Change of a field by one preconditioned step for a residual. Every rank calls."""
        way, energy = self._improved(residual)
        if not self._symmetric or energy <= 0.0:
            return way
        return self._product(way, residual) / energy * way

    def approximate(self, loads: np.ndarray) -> np.ndarray:
        """Approximate solution for loads: the preconditioner, linear and symmetric."""
        return self._improved(loads)[0]

    def _improved(self, loads: np.ndarray) -> tuple[np.ndarray, float]:
        """Field of `approximate`, and its energy norm squared.

        With the blocks K of the space, S of the surplus and C between them, and loads f and g: the
        solutions ``S a = g``, ``K u = f - Cᵀ a`` and ``S d = g - C u - S a`` give the field
        u, a + d and, without assembling its forces, the energy
        ``u·f + d·C u + (a + d)·(C u + S (a + d))``.
        """
        count, block = self.spaces.owned, self._block
        loads = np.where(self._free, loads, 0.0)
        first = block.solve(loads[count:])
        field = np.concatenate([np.zeros(count), first])
        field[:count] = self._solve(loads[:count] - self._forces(field, 0))
        forces, mine = self._forces(field, 1), block.forces(first)
        change = block.solve(loads[count:] - forces)
        field[count:] += change
        energy = self._product(field[:count], loads[:count])
        energy += self._product(change, forces - mine)
        energy += self._product(field[count:], forces + block.forces(change))
        return field, energy

    def _forces(self, field: np.ndarray, part: int) -> np.ndarray:
        """Forces of a correction on the space (0) or on the surplus (1)."""
        self.functions(field)
        forces = _sum(self._forces_of[part])
        if any(self._regular[part]):
            forces = forces + _sum(self._regular[part])
        count = self.spaces.owned
        free = self._free[count:] if part else self._free[:count]
        return np.where(free, forces, 0.0)

    def _product(self, first: np.ndarray, second: np.ndarray) -> float:
        return float(sum_over_ranks(self._comm, first @ second))


def _sum(forms: Sequence[Sequence[fem.Form]]) -> np.ndarray:
    """Sum of assembled terms, body by body."""
    return np.concatenate([np.sum([assembled(t) for t in terms], axis=0) for terms in forms])


def cells_near(
    bodies: Bodies, facets: Sequence[tuple[np.ndarray, np.ndarray]], layers: int
) -> list[np.ndarray]:
    """Owned cells of each body within some layers of cells from some facets. Every rank calls.

    Facets are given for each body by local cells and their local facets, on any rank that has them.
    """
    return [_cells_near(body, *own, layers) for body, own in zip(bodies.each, facets, strict=True)]


def _cells_near(
    body: BodyMesh, cells: np.ndarray, local_facets: np.ndarray, layers: int
) -> np.ndarray:
    space = fem.functionspace(body.mesh, ("Lagrange", 1))
    nodes = space.dofmap.list
    corners = np.array(basix.topology(reference_element(body.mesh, 1).cell_type)[-2])
    marked = np.zeros(space.dofmap.index_map.size_local + space.dofmap.index_map.num_ghosts, bool)
    marked[np.take_along_axis(nodes[cells], corners[local_facets], axis=1)] = True
    for _ in range(layers):
        marked = _on_any_rank(space, marked)
        near = marked[nodes].any(axis=1)
        marked[nodes[near]] = True
    return np.flatnonzero(near[: body.n_cells]).astype(np.int32)


def _inside(surplus: Spaces, near: Sequence[np.ndarray]) -> np.ndarray:
    """Mask of owned values whose functions vanish outside some cells. Every rank calls."""
    masks = []
    for space, cells in zip(surplus.each, near, strict=True):
        index_map, mesh = space.dofmap.index_map, space.mesh
        outside = np.ones(mesh.topology.index_map(mesh.topology.dim).size_local, dtype=bool)
        outside[cells] = False
        marked = np.zeros(index_map.size_local + index_map.num_ghosts, dtype=bool)
        marked[space.dofmap.list[np.flatnonzero(outside)]] = True
        far = _on_any_rank(space, marked)[: index_map.size_local]
        masks.append(np.repeat(~far, space.dofmap.index_map_bs))
    return np.concatenate(masks)


def _on_any_rank(space: fem.FunctionSpace, marked: np.ndarray) -> np.ndarray:
    """Mask of the local nodes that any rank has marked. Every rank calls."""
    vector = la.vector(space.dofmap.index_map)
    vector.array[:] = marked
    vector.scatter_reverse(la.InsertMode.add)
    vector.scatter_forward()
    return vector.array > 0.0


class _SurplusBlock:
    """Matrix of the bilinear form on the surplus; solved directly in 2D, iteratively in 3D."""

    def __init__(self, matrix: PETSc.Mat, free: np.ndarray, dim: int, symmetric: bool):
        first, _ = matrix.getOwnershipRange()
        rows = (first + np.flatnonzero(free)).astype(PETSc.IntType)
        chosen = PETSc.IS().createGeneral(rows, comm=matrix.comm)
        self._free, self._matrix = free, matrix.createSubMatrix(chosen, chosen)
        kind = "definite" if symmetric else "none"
        self._factor = DirectSolver(self._matrix, kind, dim=dim) if dim == 2 else None
        self._iteration = None if dim == 2 else _iteration(self._matrix, symmetric)

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Solve for the surplus under loads (n_owned,). Every rank calls."""
        result = np.zeros(len(loads))
        if self._factor is not None:
            result[self._free] = self._factor.solve(loads[self._free])
            return result
        assert self._iteration is not None
        x, b = self._matrix.createVecs()
        b.setArray(loads[self._free])
        self._iteration.solve(b, x)
        result[self._free] = x.getArray()
        return result

    def forces(self, surplus: np.ndarray) -> np.ndarray:
        """Forces of a surplus that vanishes in fixed values, zero there. Every rank calls."""
        result = np.zeros(len(surplus))
        result[self._free] = multiply(self._matrix, surplus[self._free])
        return result


def _iteration(matrix: PETSc.Mat, symmetric: bool) -> PETSc.KSP:
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setType(PETSc.KSP.Type.CG if symmetric else PETSc.KSP.Type.GMRES)
    solver.getPC().setType(PETSc.PC.Type.SOR)
    solver.setTolerances(rtol=_TOLERANCE, max_it=100)
    return solver
