"""Weak gap opened by temperatures of the bodies, and its condensation to heat at the contact.

A block of elastic solutions is reduced at once: the response of all temperatures to all pressure
functions is stored only where it is small (`condensation.influence`), else solved for again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.elasticity.elasticity import Elasticity, ThermalForces
from ...bulk.heat.conduction import Conduction
from ...bulk.solvers.direct import blocks
from ...bulk.spaces import Spaces
from ...parallel import sum_over_ranks
from .exchange_matrix import FaceNodes
from .heat_exchange import ChangedExchange, CoupledDistortion, HeatExchange, opened_by

Columns: TypeAlias = "slice | np.ndarray"

_STORED = 0.05
"""Part of the available memory that the response of all temperatures may take."""


@dataclass(frozen=True)
class GroupColumns:
    """Solutions of a group of bodies for a range of pressure functions.

    Attributes
    ----------
    group : int
        Index of the group.
    columns : slice or ndarray of int
        Pressure functions.
    displacements : ndarray, shape (n_own, width)
        Displacements of the group [m per coefficient].
    per_rise : list of ndarray, shape (n_own of the temperature, width)
        Weak gap per nodal rise of the group, one for each thermal load matrix [m³/K].
    """

    group: int
    columns: Columns
    displacements: np.ndarray
    per_rise: list[np.ndarray]


def elastic_columns(
    elastic: Elasticity, loads: sp.csc_matrix, matrices: Sequence[ThermalForces] = ()
) -> Iterator[GroupColumns]:
    """Solve for sparse nodal loads (n_owned, m), group by group, where they load a group.

    Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    loads : csc_matrix, shape (n_owned, m)
    matrices : sequence of ThermalForces
        Thermal load matrices.
    """
    by_rows, bodies_of = loads.tocsr(), elastic.bodies
    for index, (group, bodies) in enumerate(
        zip(elastic.groups, elastic.spaces.groups, strict=True)
    ):
        transposed = [[m.each[k].transpose(PETSc.Mat()) for k in bodies] for m in matrices]
        by_columns = sp.csc_matrix(by_rows[elastic.spaces.rows(*bodies)])
        size = bodies_of.dim, group.spaces.total
        with group.solver_of_columns() as solve:
            for columns in _loading(by_columns, bodies_of.comm, *size):
                displacements = solve(by_columns[:, columns].tocsr())
                split = group.spaces.split(displacements)
                products = [
                    np.vstack([_product(*pair) for pair in zip(each, split, strict=True)])
                    for each in transposed
                ]
                yield GroupColumns(index, columns, displacements, products)


def _loading(loads: sp.csc_matrix, comm, dim: int, rows: int = 0) -> Iterator[Columns]:
    """Blocks of the columns that load a body, on any rank; a body has those of its own contacts.

    Every rank calls.
    """
    used = np.flatnonzero(sum_over_ranks(comm, np.diff(loads.indptr)))
    for block in blocks(len(used), dim, rows):
        own = used[block]
        first, end = int(own[0]), int(own[-1]) + 1
        yield slice(first, end) if end - first == len(own) else own


def _product(matrix: PETSc.Mat, columns: np.ndarray) -> np.ndarray:
    """Product of a matrix and dense columns, owned rows. Every rank calls."""
    sizes = (matrix.getSizes()[1], columns.shape[1])
    right = PETSc.Mat().createDense(sizes, array=columns, comm=matrix.comm)
    right.assemble()
    found = matrix.matMult(right)
    result = np.array(found.getDenseArray(), order="F")
    for each in (right, found):
        each.destroy()
    return result


@dataclass(frozen=True)
class OpeningStorage:
    """Memory of the weak gap per temperature of the bodies, and whether it is stored.

    Attributes
    ----------
    nodes, functions : int
        Nodal temperatures (on all ranks) and pressure functions.
    available : float
        Memory available on this machine; NaN in a section [bytes].
    """

    nodes: int
    functions: int
    available: float

    @property
    def size(self) -> float:
        """Memory of the whole response [bytes]."""
        return 8.0 * self.nodes * self.functions

    @property
    def kept(self) -> bool:
        """True if it is stored; always in a section."""
        return not self.size > _STORED * self.available

    def note(self) -> str | None:
        """Line for the console if it is not stored."""
        if self.kept:
            return None
        return (
            f"condensation: the gap opened by {self.nodes} temperatures at {self.functions} "
            f"pressure coefficients would take {self.size / 1e9:.2g} GB of "
            f"{self.available / 1e9:.2g} GB available; it is not stored, and solved for where "
            "needed"
        )


@dataclass(frozen=True)
class ThermalOpening:
    """Weak gap ``Ψᵀ w B K⁻¹ Σ G_k T_k`` of rises T_k at the nodes, for thermal load matrices G_k.

    Attributes
    ----------
    elastic : Elasticity
    loads : csc_matrix, shape (n_owned, m)
        Nodal loads Bᵗ w Ψ of the pressure functions.
    matrices : sequence of ThermalForces
        G_k: nodal forces per nodal rise, of all bodies and of temperature-dependent expansions.
    per_rise : tuple of ndarray, shape (n_owned of the temperature, m)
        Weak gap per nodal rise, one for each matrix; empty if it is solved for [m³/K].
    """

    elastic: Elasticity
    loads: sp.csc_matrix
    matrices: Sequence[ThermalForces]
    per_rise: tuple[np.ndarray, ...]

    def of(self, rises: Sequence[np.ndarray]) -> np.ndarray:
        """Weak gap (m,) opened by one rise (n_owned,) for each of the first matrices.

        By columns also. Costs an elastic solution if the response is not stored. Every rank calls.
        """
        comm = self.elastic.bodies.comm
        if self.per_rise:
            return opened_by(self.per_rise, rises, comm)
        columns = zip(*(rise.reshape(len(rise), -1).T for rise in rises), strict=True)
        found = [self.loads.T @ self.elastic.solve(self._forces(each)) for each in columns]
        weak = np.stack(found, axis=1) if found else np.zeros((self.loads.shape[1], 0))
        return sum_over_ranks(comm, weak).reshape(-1, *rises[0].shape[1:])

    def by_columns(
        self, spaces: Spaces, slopes: Sequence[np.ndarray] = ()
    ) -> Iterator[tuple[int, Columns, np.ndarray]]:
        """Weak gap per nodal rise of a group (n_own, width), with its pressure functions.

        The rises of the matrices after the first are `slopes` (n_owned,) times that of the first.
        Every rank calls.

        Parameters
        ----------
        spaces : Spaces
            Of the temperatures.
        slopes : sequence of ndarray
        """
        rows = [spaces.rows(*bodies) for bodies in self.elastic.spaces.groups]
        slopes_in = [[slope[own] for slope in slopes] for own in rows]
        if self.per_rise:
            loads, bodies = self.loads.tocsr(), self.elastic.bodies
            of_loads = [self.elastic.spaces.rows(*own) for own in self.elastic.spaces.groups]
            for group, own in enumerate(rows):
                by_columns = sp.csc_matrix(loads[of_loads[group]])
                for columns in _loading(by_columns, bodies.comm, bodies.dim):
                    parts = [response[own][:, columns] for response in self.per_rise]
                    yield group, columns, _combined(parts, slopes_in[group])
            return
        for found in elastic_columns(self.elastic, self.loads, self.matrices[: 1 + len(slopes)]):
            yield found.group, found.columns, _combined(found.per_rise, slopes_in[found.group])

    def _forces(self, rises: Iterable[np.ndarray]) -> np.ndarray:
        pairs = zip(self.matrices, rises, strict=False)
        return np.sum([matrix.multiply(rise) for matrix, rise in pairs], axis=0)


def _combined(parts: Sequence[np.ndarray], slopes: Sequence[np.ndarray]) -> np.ndarray:
    result, *others = parts
    for slope, part in zip(slopes, others, strict=False):
        result = result + slope[:, None] * part
    return result


@dataclass(frozen=True)
class ThermalDistortion:
    """Thermal distortion: weak gap opened by heat (negative: closed).

    Attributes
    ----------
    per_heat : tuple of ndarray, shape (m, n_b)
        Weak gap per nodal heat into each body at its faces, bath included [m³/W].
    """

    per_heat: tuple[np.ndarray, ...]

    def coupled(
        self, exchange: HeatExchange, reference: CoupledDistortion | None = None
    ) -> CoupledDistortion:
        """Distortion of faces that exchange heat, given that of the reference of a change."""
        if isinstance(exchange, ChangedExchange) and reference is not None:
            factors = exchange.correction(reference.per_load)
            return CoupledDistortion(exchange, reference.per_load, factors)
        return CoupledDistortion(exchange, exchange.opened(self.per_heat))


class DistortionRows:
    """Thermal distortion ``Ψᵀ w B K⁻¹ G K_T⁻¹ Eᵀ``, collected from blocks of pressure functions.

    Costs one (adjoint) thermal solution per pressure function. Every rank calls.

    Parameters
    ----------
    conduction : Conduction
    nodes : tuple of FaceNodes
        Nodes of each body.
    count : int
        Number m of pressure functions.
    """

    def __init__(self, conduction: Conduction, nodes: tuple[FaceNodes, ...], count: int):
        self._conduction, self._nodes = conduction.for_columns(), nodes
        self._groups = [conduction.spaces.group_of(own.rows) for own in nodes]
        self._per_heat = tuple(np.zeros((count, n.count)) for n in nodes)
        self._last = -1

    def add(self, group: int, columns: Columns, per_rise: np.ndarray) -> None:
        """Add the rows of a block from the weak gap per nodal rise of a group, (n_own, width).

        Blocks follow group by group.
        """
        if group != self._last:
            self._conduction.release()
        self._last = group
        adjoint, spaces = self._conduction.in_group(group).adjoint_response(per_rise), self._spaces
        for own, nodes, rows in zip(self._groups, self._nodes, self._per_heat, strict=True):
            if own == group:
                at_face = adjoint[spaces.within(group, nodes.rows)]
                rows[columns] += np.vstack(spaces.comm.allgather(at_face)).T

    def finish(self) -> ThermalDistortion:
        """Distortion by all blocks that have been added."""
        self._conduction.release()
        return ThermalDistortion(self._per_heat)

    @property
    def _spaces(self) -> Spaces:
        return self._conduction.spaces


def condense_distortion(
    conduction: Conduction,
    opening: ThermalOpening,
    nodes: tuple[FaceNodes, ...],
    slopes: Sequence[np.ndarray] = (),
) -> ThermalDistortion:
    """Condense the thermal distortion; slopes as in `ThermalOpening`. Every rank calls."""
    rows = DistortionRows(conduction, nodes, opening.loads.shape[1])
    for group, columns, per_rise in opening.by_columns(conduction.spaces, slopes):
        rows.add(group, columns, per_rise)
    return rows.finish()
