"""Weak gap opened by temperatures of the bodies, and its condensation to heat at the contact.

A block of elastic solutions is reduced at once: the response of all temperatures to all pressure
functions is stored only where it is small (`condensation.influence`), else solved for again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.direct_solver import multiply
from ...bulk.heat.conduction import Conduction
from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks
from .exchange_update import ChangedExchange
from .face_nodes import FaceNodes
from .heat_exchange import CoupledDistortion, HeatExchange, opened_by
from .traces import transpose_product

_COLUMNS = {2: 32, 3: 128}
"""Right-hand sides per solution, by dimension; limited by the caches."""
_BLOCK_MEMORY, _LEAST = 3e8, 32
"""Memory of the solutions of a block [bytes], unless it has the least number of columns."""
_STORED = 0.05
"""Part of the available memory that the response of all temperatures may take."""


def blocks(count: int, dim: int, rows: int = 0) -> Iterator[slice]:
    """Ranges of columns of a number of rows that are solved for together, in a dimension `dim`."""
    fitting = int(_BLOCK_MEMORY / (8 * max(rows, 1)))
    size = min(_COLUMNS[dim], max(fitting, _LEAST))
    return (slice(start, min(start + size, count)) for start in range(0, count, size))


def elastic_columns(elastic: Elasticity, loads: sp.csc_matrix) -> Iterator[tuple]:
    """Solve for sparse nodal loads (n_owned, m): ranges of columns and displacements, (n_owned, k).

    A range may occur several times; its displacements, of one body each time, are to be added.
    """
    for solve in elastic.solvers_of_columns():
        for columns in blocks(loads.shape[1], elastic.bodies.dim, elastic.spaces.total):
            yield columns, solve(loads[:, columns].tocsr())


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
    matrices : sequence of petsc4py.PETSc.Mat
        G_k: nodal forces per nodal rise, of all bodies and of temperature-dependent expansions.
    per_rise : tuple of ndarray, shape (n_owned of the temperature, m)
        Weak gap per nodal rise, one for each matrix; empty if it is solved for [m³/K].
    """

    elastic: Elasticity
    loads: sp.csc_matrix
    matrices: Sequence[PETSc.Mat]
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

    def by_columns(self, slopes: Sequence[np.ndarray] = ()) -> Iterator[tuple[slice, np.ndarray]]:
        """Weak gap per nodal rise, shape (n_owned, width), with its range of pressure functions.

        Those of the same range are to be added, see `elastic_columns`.

        The rises of the matrices after the first are `slopes` (n_owned,) times that of the first.
        Every rank calls.
        """
        if self.per_rise:
            dim = self.elastic.bodies.dim
            for columns in blocks(self.loads.shape[1], dim):
                parts = [response[:, columns] for response in self.per_rise]
                yield columns, _combined(parts, slopes)
            return
        for columns, displacements in elastic_columns(self.elastic, self.loads):
            used = self.matrices[: 1 + len(slopes)]
            parts = [transpose_product(matrix, displacements) for matrix in used]
            yield columns, _combined(parts, slopes)

    def _forces(self, rises: Iterable[np.ndarray]) -> np.ndarray:
        pairs = zip(self.matrices, rises, strict=False)
        return np.sum([multiply(matrix, rise) for matrix, rise in pairs], axis=0)


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
    per_heat : tuple of ndarray, shape (m, n_f)
        Weak gap per nodal heat into each body at its face, bath included [m³/W].
    """

    per_heat: tuple[np.ndarray, np.ndarray]

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
    faces : tuple of FaceNodes
    count : int
        Number m of pressure functions.
    """

    def __init__(self, conduction: Conduction, faces: tuple[FaceNodes, FaceNodes], count: int):
        self._conduction, self._faces = conduction.with_factor(), faces
        first, second = (np.zeros((count, face.count)) for face in faces)
        self.distortion = ThermalDistortion((first, second))

    def add(self, columns: slice, per_rise: np.ndarray) -> None:
        """Add the rows of a block from the weak gap per nodal rise, shape (n_owned, width)."""
        adjoint = self._conduction.adjoint_response(per_rise)
        comm = self._conduction.spaces.comm
        for face, rows in zip(self._faces, self.distortion.per_heat, strict=True):
            rows[columns] += np.vstack(comm.allgather(adjoint[face.rows])).T


def condense_distortion(
    conduction: Conduction,
    opening: ThermalOpening,
    faces: tuple[FaceNodes, FaceNodes],
    slopes: Sequence[np.ndarray] = (),
) -> ThermalDistortion:
    """Condense the thermal distortion; slopes as in `ThermalOpening`. Every rank calls."""
    rows = DistortionRows(conduction, faces, opening.loads.shape[1])
    for columns, per_rise in opening.by_columns(slopes):
        rows.add(columns, per_rise)
    return rows.distortion
