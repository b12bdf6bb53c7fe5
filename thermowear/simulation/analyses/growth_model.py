"""Reduced-order model of the growth of thermoelastic perturbations in time.

The temperature response to interface heat that grows at a rate s is ``(K + s M)⁻¹`` times it. A
small space of responses at some rates (rational Krylov space; A. Ruhe, Linear Algebra Appl. 58
(1984) 391) also approximates the responses at rates between them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np

from ...contact.operators.heat_exchange import HeatExchange, at_faces
from ...laws.stability import LoadFree, PerturbationMatrices, Rate
from ...parallel import sum_over_ranks
from ..heat.heat_steps import HeatOperators, HeatSteps
from ..system.conditions import InterfaceConditions
from ..system.system import System

_NEW = 1e-12
"""Smallest squared norm of the new part of a unit field that extends the space."""
_SPREAD = np.geomspace(1.0, 3e4, 12)
"""Initial rates of a model, relative to that of diffusion across the contact.

Critical speeds agree to 1e-10 with responses at the complex rates themselves; with a third of the
rates to 1e-6.
"""
_SAME, _TOLERANCE, _ITERATIONS = 1e-3, 1e-6, 6


@dataclass(frozen=True)
class PerturbationMode:
    """Perturbation mode of the pressure.

    Attributes
    ----------
    factor : float
        Factor of the given speed at which it is found.
    rate : Rate
        Growth rate, and coefficients of the pressure.
    """

    factor: float
    rate: Rate

    def near(self, other: PerturbationMode) -> bool:
        """True if both agree within the accuracy of the reduced model."""
        change = abs(self.rate.value - other.rate.value) <= _TOLERANCE * abs(other.rate.value)
        return change and abs(self.factor - other.factor) <= _TOLERANCE * other.factor


class GrowthModel:
    """Heat conduction projected on responses to perturbations over a wide range of growth rates.

    Every rank constructs it.

    Parameters
    ----------
    system : System
        System with a thermal model and known heat capacity.
    conditions : InterfaceConditions
        Conditions of the perturbed state.
    elastic : ndarray, shape (m, m)
        A, see `laws.stability`.
    space : LoadFree
        Basis of the perturbations, coefficients in the whole pressure space.
    """

    def __init__(
        self,
        system: System,
        conditions: InterfaceConditions,
        elastic: np.ndarray,
        space: LoadFree,
    ):
        assert system.thermal is not None
        self._system, self._thermal = system, system.thermal
        self._conditions, self._elastic, self._space = conditions, elastic, space
        pressures = system.basis @ space.pressures
        self._friction = conditions.heating[:, None] * pressures
        # without friction anywhere disturbances of the temperature decay, by conduction alone
        self._heat = self._friction if conditions.heating.any() else pressures
        self._steps = HeatSteps(system, system.thermal, 0)
        self._fields = np.zeros((len(system.thermal.conduction.fixed), 0))
        self._excess = np.zeros((system.basis.shape[1], 0))
        self._rates: list[float] = []
        extent = min(part.extent for part in system.contacts.each)
        self._diffusion_rate = system.thermal.diffusivity / extent**2
        for rate in (0.0, *(self._diffusion_rate * _SPREAD)):
            self.add(rate)

    def refined(
        self, find: Callable[[PerturbationMatrices], PerturbationMode | None]
    ) -> PerturbationMode | None:
        """Result of a search in the model, refined at the rate found; every rank calls.

        The response at the rate found is added until the result no longer changes.
        """
        found = find(self.matrices())
        for _ in range(_ITERATIONS):
            if found is None or self._has_response(abs(found.rate.value)):
                break
            self.add(abs(found.rate.value))
            before, found = found, find(self.matrices())
            if found is not None and found.near(before):
                break
        return found

    def _has_response(self, rate: float) -> bool:
        return any(abs(rate - known) <= _SAME * rate for known in self._rates)

    def add(self, rate: float) -> None:
        """Add the thermal response to friction heat that grows at a rate; every rank calls.

        Parameters
        ----------
        rate : float
            Growth rate, zero for steady state [1/s].
        """
        steps = self._steps
        bodies = steps.operators if rate == 0.0 else steps.operators_within(1 / rate)
        self._extend(*self._responses(bodies, self._exchange(bodies).loads(self._heat)))
        self._rates.append(rate)

    def _exchange(self, bodies: HeatOperators) -> HeatExchange:
        exchange = bodies.known(self._conditions.conductance).exchange
        assert isinstance(exchange, HeatExchange)
        return exchange

    def _responses(self, bodies: HeatOperators, loads) -> tuple[np.ndarray, np.ndarray]:
        """Fields (n_owned, q) and their excess heat (m, q) by loads of the exchange."""
        exchange = self._exchange(bodies)
        unknowns = exchange.response(loads)
        heat = loads + exchange.coupling @ unknowns  # bath included
        fields = bodies.conduction.respond(exchange.face.on_nodes(heat))
        return fields, exchange.excess(unknowns)

    def matrices(self) -> PerturbationMatrices:
        """Matrices of the present model; every rank calls."""
        system, space, thermal = self._system, self._space, self._thermal
        conduction, X = thermal.conduction, self._fields
        assert conduction.capacity is not None
        T1, T2 = at_faces(X, thermal.face.traces, system.comm)
        weights = system.weights[:, None]
        f = np.reshape(thermal.face.partition, (-1, 1))
        direct, _, resistance = thermal.face.divided(self._conditions.conductance)
        jump, excess = T2 - T1, system.basis @ self._excess
        # the jump that the excess does not pass is its resistance times it: no product of both,
        # which vanishes in perfect contact but for rounding times large heat of rough fields
        kept = self._product(conduction.conductivity, X)
        kept += jump.T @ (weights * direct[:, None] * jump)
        kept += excess.T @ (weights * resistance[:, None] * excess)
        kept += conduction.joints.passed(conduction.spaces, X)
        carried = np.zeros((X.shape[1],) * 2)
        if conduction.advection is not None:
            carried = self._product(conduction.advection.carried, X)
        return PerturbationMatrices(
            elastic=space(self._elastic),
            opening=space.gaps.T @ system.thermal_opening.of([X]),
            heated=(f * T1 + (1 - f) * T2).T @ (weights * self._friction),
            conducted=kept - carried,
            carried=carried,
            stored=self._product(conduction.capacity, X),
            diffusion_rate=self._diffusion_rate,
        )

    def _extend(self, fields: np.ndarray, excess: np.ndarray) -> None:
        """Extend the orthonormal space by fields (n_owned, q) with their excess heat (m, q)."""
        new = self._closed(*self._orthonormal(fields, excess, _NEW))
        # again, as the rest of a small difference is not orthogonal, and what closes it neither
        fields, excess = self._orthonormal(*new, 0.0)
        self._fields = np.hstack([self._fields, fields])
        self._excess = np.hstack([self._excess, excess])

    def _orthonormal(
        self, fields: np.ndarray, excess: np.ndarray, least: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Parts of fields that are new, those of a squared norm above the least."""
        sizes = np.diag(self._gram(fields, fields))
        fields, excess = fields[:, sizes > 0.0], excess[:, sizes > 0.0]  # no friction: no heat
        scale = 1 / np.sqrt(sizes[sizes > 0.0])
        known = self._gram(self._fields, fields * scale)
        fields = fields * scale - self._fields @ known
        excess = excess * scale - self._excess @ known
        sizes, mixing = np.linalg.eigh(self._gram(fields, fields))
        combined = mixing[:, sizes > least] / np.sqrt(sizes[sizes > least])
        return fields @ combined, excess @ combined

    def _closed(self, fields: np.ndarray, excess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Fields with the jumps of their excess heat, which small differences miss by rounding.

        That, times the large heat of rough fields, would change critical speeds in perfect contact
        by 5e-4.
        """
        bodies = self._steps.operators
        T1, T2 = at_faces(fields, self._thermal.face.traces, self._system.comm)
        missing = self._exchange(bodies).closing(T1 - T2, excess)
        if not missing.any():
            return fields, excess
        changes, more = self._responses(bodies, missing)
        return fields + changes, excess + more

    def _gram(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        return sum_over_ranks(self._system.comm, left.T @ right)

    def _product(self, matrix: PETSc.Mat, fields: np.ndarray) -> np.ndarray:
        """``Xᵀ matrix X``, shape (r, r)."""
        rows, _ = matrix.getSizes()
        right = PETSc.Mat().createDense(
            (rows, fields.shape[1]), array=np.asfortranarray(fields), comm=matrix.comm
        )
        right.assemble()
        image = matrix.matMult(right)
        return self._gram(fields, image.getDenseArray())
