"""Temperature-dependent conductivity and thermal expansion.

The flux ``k(T) grad T`` is ``k0 grad Θ`` with Kirchhoff's integral ``Θ(T) = ∫ k dT/k0``. Θ is
interpolated between the nodes like the temperature itself, so that conduction is ``K Θ(T)`` with
the matrix of a constant conductivity, and its tangent ``K diag(k/k0)``: exact for one-dimensional
heat flow, and of the order of the elements (the product approximation of Christie, Griffiths,
Mitchell and Sanz-Serna, IMA J. Numer. Anal. 1 (1981) 253). Thermal strain is interpolated likewise.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Protocol

from petsc4py import PETSc

import numpy as np
import ufl

from ..bodies import Bodies
from ..compiled import assembled_matrix
from ..elasticity.elasticity import Elasticity, ThermalForces
from ..kinematics import Kinematics, section_measure
from ..solvers.direct import multiply
from ..spaces import Spaces, block_diagonal
from .conduction import Conduction
from .heat_equation import ThermalMaterial, conducting

_NEWTON = 1e3
"""Size of the flows that Newton's method leaves, relative to rounding errors."""
_SAME_PATTERN = PETSc.Mat.Structure.SAME_NONZERO_PATTERN


class PropertyMultiplier(Protocol):
    """Property as a function of temperature [K], relative to its value at ambient."""

    def value(self, x: np.ndarray) -> np.ndarray: ...

    def slope(self, x: np.ndarray) -> np.ndarray: ...

    def integral(self, start: float, x: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class VaryingProperty:
    """Temperature-dependent property of one part of a body.

    Attributes
    ----------
    part : str
    factor : PropertyMultiplier
    ambient : float
        Ambient temperature [K].
    """

    part: str
    factor: PropertyMultiplier
    ambient: float


@dataclass(frozen=True)
class VaryingConductivity(VaryingProperty):
    """Temperature-dependent conductivity of one part of a body.

    Attributes
    ----------
    matrix : petsc4py.PETSc.Mat
        Conductivity matrix of the part at its constant property [W/K].
    """

    matrix: PETSc.Mat

    def excess(self, rise: np.ndarray) -> np.ndarray:
        """``Θ - T`` at the nodes, for their rise (n_owned,) [K]."""
        return self.factor.integral(self.ambient, self.ambient + rise) - rise

    def slope(self, rise: np.ndarray) -> np.ndarray:
        """Derivative of `excess` with respect to the rise."""
        return self.factor.value(self.ambient + rise) - 1


@dataclass(frozen=True)
class VaryingExpansion(VaryingProperty):
    """Temperature-dependent thermal expansion of one part of a body.

    Attributes
    ----------
    matrix : ThermalForces
        Nodal forces of its thermal expansion at its constant property [N/K].
    """

    matrix: ThermalForces

    def excess(self, rise: np.ndarray) -> np.ndarray:
        """Additional rise at the nodes that causes the same strain at constant expansion [K]."""
        return (self.factor.value(self.ambient + rise) - 1) * rise

    def slope(self, rise: np.ndarray) -> np.ndarray:
        """Derivative of `excess` with respect to the rise."""
        T = self.ambient + rise
        return self.factor.value(T) - 1 + self.factor.slope(T) * rise


@dataclass(frozen=True)
class VaryingConduction(Conduction):
    """Conduction with temperature-dependent conductivity; the base class describes it at ambient.

    Attributes
    ----------
    parts : tuple of VaryingConductivity
    """

    parts: tuple[VaryingConductivity, ...]

    def tangent(self, rise: np.ndarray, step: float | None = None) -> Conduction:
        change = self.conductivity.duplicate()
        change.zeroEntries()
        for part in self.parts:
            change.axpy(1.0, _columns(part.matrix, part.slope(rise)), _SAME_PATTERN)
        if step is not None:
            assert self.capacity is not None
            change.axpy(1 / step, self.capacity, _SAME_PATTERN)
        return self.with_added(change, 1.0, symmetric=not self.parts and self.symmetric)

    def linearisation_error(self, rise: np.ndarray, reference: np.ndarray) -> np.ndarray:
        tangents = ((p.matrix, p.slope(reference) * rise - p.excess(rise)) for p in self.parts)
        return _products(len(rise), tangents)

    def balance_scale(self, rise: np.ndarray) -> float:
        return _NEWTON * super().balance_scale(rise)

    def conducted(self, rise: np.ndarray) -> np.ndarray:
        excess = ((part.matrix, part.excess(rise)) for part in self.parts)
        return super().conducted(rise) + _products(len(rise), excess)


def varying_conduction(
    linear: Conduction,
    bodies: Bodies,
    kinematics: Kinematics,
    materials: dict[str, ThermalMaterial],
    factors: Mapping[str, PropertyMultiplier],
    ambient: float,
) -> VaryingConduction:
    """Add temperature-dependent conductivities; parameters as in `conduction`, factors by part."""
    spaces, parts = linear.spaces, []
    for name, factor in factors.items():
        alone = {part: (part == name) * m.conductivity for part, m in materials.items()}
        blocks = []
        for body, space in zip(bodies.each, spaces.each, strict=True):
            measure = section_measure(body.mesh, spaces.degree)
            form = conducting(body, kinematics, alone, measure)
            terms = form(ufl.TrialFunction(space), ufl.TestFunction(space))
            blocks.append(assembled_matrix(terms))
        parts.append(VaryingConductivity(name, factor, ambient, block_diagonal(blocks)))
    constant = {field.name: getattr(linear, field.name) for field in fields(Conduction)}
    return VaryingConduction(**constant, parts=tuple(parts))


def varying_expansion(
    elastic: Elasticity,
    temperatures: Spaces,
    factors: Mapping[str, PropertyMultiplier],
    ambient: float,
) -> tuple[VaryingExpansion, ...]:
    """Temperature-dependent expansions from factors by part."""
    return tuple(
        VaryingExpansion(name, factor, ambient, elastic.thermal_load(temperatures, only=name))
        for name, factor in factors.items()
    )


def straining_rises(
    spaces: Spaces, rise: np.ndarray, bodies: Bodies, parts: tuple[VaryingExpansion, ...]
) -> list[ufl.core.expr.Expr]:
    """Rise that causes the same strain at constant expansion, from the true rise (n_owned,) [K].

    One expression for each body.
    """
    result = spaces.functions(rise, "rise")
    for part in parts:
        more = spaces.functions(part.excess(rise), "more")
        result = [
            known + body.per_part({part.part: 1.0}) * added
            for known, body, added in zip(result, bodies.each, more, strict=True)
        ]
    return result


def thermal_forces(
    load: ThermalForces, parts: tuple[VaryingExpansion, ...], rise: np.ndarray
) -> np.ndarray:
    """Nodal forces of a temperature rise (n_owned,), owned rows [N]."""
    excess = (part.matrix.multiply(part.excess(rise)) for part in parts)
    return sum(excess, load.multiply(rise))


def _columns(matrix: PETSc.Mat, scales: np.ndarray) -> PETSc.Mat:
    """Scale the columns of a matrix: ``matrix diag(scales)``. Every rank calls."""
    scaled, right = matrix.copy(), matrix.createVecRight()
    right.setArray(scales)
    scaled.diagonalScale(R=right)
    return scaled


def _products(rows: int, pairs: Iterable[tuple[PETSc.Mat, np.ndarray]]) -> np.ndarray:
    """Sum of matrix-vector products, owned rows."""
    result = np.zeros(rows)
    for matrix, values in pairs:
        result += multiply(matrix, values)
    return result
