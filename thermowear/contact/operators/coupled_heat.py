"""Heat exchange of the faces by one conduction problem of all bodies, without condensation.

For many contact points, where matrices of all points do not fit into the memory. The conductance
enters the matrix of conduction, ``K + (E1 - E2)ᵀ w h (E1 - E2)``. In perfect contact the heat that
crosses beyond it has unknowns of its own, multipliers of the condition of equal temperatures: they
are found by conjugate gradients on their Schur complement, which the conductance already in the
matrix conditions well (augmented Lagrangian method: Fortin and Glowinski, 1983, ch. I).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, cg, gmres, splu

from ...bulk.heat.conduction import Conduction
from ...errors import ComputationError
from .condensation import transfer_matrix
from .exchange_matrix import NO_HEAT_SINK, BaselineResponse, ThermalState
from .heat_exchange import FaceHeat, HeatExchange, InterfaceHeat, at_faces

_TOLERANCE = 1e-9
"""Reduction of the temperature jump in perfect contact."""
_ITERATIONS = 60
_UNCONVERGED = (
    "heat: the exchange of heat between faces in perfect contact did not converge; give "
    "heat.conductance, or mesh.solver = direct"
)


@dataclass(frozen=True)
class CoupledHeat(FaceHeat):
    """Heat conduction in the bodies, solved for each state of the contact.

    Attributes
    ----------
    conduction : Conduction
    """

    conduction: Conduction

    def exchange(self, conductance: np.ndarray) -> CoupledExchange:
        """Couple the faces by a conductance (n,), see `divided`. Every rank calls."""
        return CoupledExchange(self, conductance)


class CoupledExchange:
    """Bodies coupled by a conductance. Every rank calls.

    Parameters
    ----------
    face : CoupledHeat
    conductance : ndarray, shape (n,)
        Infinite in perfect contact [W/(m² K)].

    Raises
    ------
    ComputationError
        If a heated body has no heat sink.
    """

    def __init__(self, face: CoupledHeat, conductance: np.ndarray):
        conduction, weights = face.conduction, face.weights
        self._direct, passing_fraction, resistance = face.divided(conductance)
        between = (face.traces[0] - face.traces[1]).tocsr()
        exchange = transfer_matrix(conduction.spaces, between, weights * self._direct)
        self._face, self._comm = face, conduction.spaces.comm
        self._conduction = conduction.coupled(exchange)
        self._crossing: sp.csr_matrix | None = None
        if not passing_fraction.any():
            return
        basis = sp.csr_matrix(face.basis)
        crossing = (sp.diags(passing_fraction) @ basis).tocsc()
        used = np.flatnonzero(np.diff(crossing.indptr))
        basis, self._crossing = basis.tocsc()[:, used], crossing[:, used].tocsr()
        self._jump = (self._crossing.T @ sp.diags(weights)).tocsr()
        self._resisted = basis.T @ sp.diags(weights * resistance) @ basis
        self._load = between @ self._jump.T

    def state(self, friction_heat: np.ndarray, baseline: BaselineResponse) -> ThermalState:
        """Temperatures and fluxes due to friction heat [W/m²] at the points, shape (n,).

        The baseline is the response with the bath, which this replaces.
        """
        face, (T1, T2) = self._face, baseline.rise
        resting = face.state((T1, T2), friction_heat, self._direct * (T2 - T1))
        heat, beyond = face.nodal_heat(resting, bath=True), 0.0
        if self._crossing is not None:
            change = self._at_faces(heat)
            multipliers = self._multipliers(T2 + change[1] - T1 - change[0])
            heat, beyond = heat + self._load @ multipliers, self._crossing @ multipliers
        change = self._at_faces(heat)
        T1, T2 = T1 + change[0], T2 + change[1]
        return face.state((T1, T2), friction_heat, self._direct * (T2 - T1) + beyond)

    def _multipliers(self, difference: np.ndarray) -> np.ndarray:
        """Heat coefficients that close a temperature difference (n,) of the coupled bodies."""
        assert self._crossing is not None

        def closed(multipliers: np.ndarray) -> np.ndarray:
            T1, T2 = self._at_faces(self._load @ multipliers)
            return self._jump @ (T1 - T2) + self._resisted @ multipliers

        conductance = np.maximum(self._direct, np.maximum(*self._face.shifts))
        schur = self._jump @ sp.diags(1 / conductance) @ self._crossing + self._resisted
        shape, factor = schur.shape, splu(schur.tocsc())
        found, failed = (cg if self._conduction.symmetric else gmres)(
            LinearOperator(shape, closed),
            self._jump @ difference,
            rtol=_TOLERANCE,
            maxiter=_ITERATIONS,
            M=LinearOperator(shape, factor.solve),
        )
        if failed:
            raise ComputationError(_UNCONVERGED)
        return found

    def _at_faces(self, heat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rises at the points of both faces by nodal heat in the coupled bodies, (n,) each [K]."""
        try:
            rise = self._conduction.respond(heat)
        except ComputationError as error:
            raise ComputationError(f"{NO_HEAT_SINK} ({error})") from None
        return at_faces(rise, self._face.traces, self._comm)


AnyFace = InterfaceHeat | CoupledHeat
AnyExchange = HeatExchange | CoupledExchange
