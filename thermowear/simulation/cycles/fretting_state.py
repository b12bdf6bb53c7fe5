"""State at the end of an increment of stick and slip, at the contact points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...contact.friction.stick_slip_state import Status
from ...contact.operators.pressure import Basis, function_ranges
from ...contact.operators.tangential import forwards, tangents
from ...laws.motions import spatial
from ...results import FrictionInterface
from ..system.system import System
from .load_path import Increment

_LOCATED = 0.3
"""Uncertainty of a stick edge that is fitted inside of coefficients of degree 1, by their width."""
_SCAR = 0.01
"""Depth of the scar at its rim, by the largest one."""
_SLIDES = 1 - 1e-6  # fraction of the friction limit from which a point slips


@dataclass(frozen=True)
class FrettingState:
    """State at the end of an increment, at the contact points of a system.

    Attributes
    ----------
    system : System
    increment : Increment
    frame : ndarray, shape (t, n, gdim)
        Tangential directions at the points.
    basis : ndarray or csr_array, shape (n, m)
        Basis of the tractions.
    """

    system: System
    increment: Increment
    frame: np.ndarray
    basis: Basis

    @cached_property
    def pressure(self) -> np.ndarray:
        """Pressure, shape (n,) [Pa]."""
        return self.basis @ self.increment.state.pressure

    @cached_property
    def shear(self) -> np.ndarray:
        """Components of the shear traction on the first bodies, shape (n, t) [Pa]."""
        return self.basis @ self.increment.state.shear

    @property
    def shear_vectors(self) -> np.ndarray:
        """Shear traction on the first bodies, shape (n, gdim) [Pa]."""
        return self.vectors(self.shear)

    def vectors(self, components: np.ndarray) -> np.ndarray:
        """Vectors (n, gdim) of tangential components (n, t)."""
        return np.einsum("nt,tni->ni", components, self.frame)

    @cached_property
    def sticking(self) -> np.ndarray:
        """Mask of points with shear below the friction limit, shape (n,).

        In space those where more coefficients have stuck than slipped in the last increment: the
        shear between coefficients that slip in different directions is below the limit, too.
        """
        if self.in_space:
            status, basis = self.increment.state.status, self.basis
            stick, slip = (basis @ (status == each) for each in (Status.STICK, Status.SLIP))
            return (stick > slip) & (self.pressure > 0)
        return np.abs(self.shear[:, 0]) < _SLIDES * self.system.friction * self.pressure

    @cached_property
    def depths(self) -> np.ndarray:
        """Worn depths of the first and of the second faces, shape (2, n) [m]."""
        system = self.system
        both = np.zeros((2, len(system.weights)))
        both[list(system.laws)] = (system.basis @ self.increment.state.worn.T).T
        return both

    @cached_property
    def sense(self) -> np.ndarray:
        """Signs of shear and slip along +x (+y on faces along y) in a plane, shape (n,)."""
        contacts = self.system.contacts
        means = np.array([each.weights @ each.normals for each in contacts.each])
        return contacts.per_point(forwards(tangents(means)[0]))

    @property
    def in_space(self) -> bool:
        return self.system.contacts.in_space

    @cached_property
    def normal_forces(self) -> np.ndarray:
        """Forces on the second bodies along the load direction at the points, shape (n,) [N]."""
        along = np.einsum("ni,ni->n", self._on_second, self.system.load_directions)
        return self.system.weights * along

    def friction_force(self, own: slice) -> float:
        """Force on the first body of a contact across its load direction [N].

        Along +x (+y where it is pressed along x); in space its magnitude.
        """
        w, along = self.system.weights[own], self.system.load_directions[own]
        if self.in_space:
            total = w @ self._on_second[own]
            return float(np.linalg.norm(total - (total @ along[0]) * along[0]))
        turned = tangents(along)[0]
        pull = np.einsum("ni,ni->n", self._on_second[own], turned)
        return float((-forwards(turned) * w * pull).sum())

    @property
    def _on_second(self) -> np.ndarray:
        """Traction on the second bodies, shape (n, gdim) [Pa]."""
        return self.pressure[:, None] * self.system.contacts.normals - self.shear_vectors

    @property
    def friction(self) -> FrictionInterface:
        """Stick and slip at the contact points."""
        system, state = self.system, self.increment.state
        points = spatial(system.contacts.on_body_1)
        nothing = np.full((len(points), 3), np.nan)
        shear, slip = self._shown(self.shear), self._shown(state.point_slip)
        vectors = (self.shear_vectors, self.vectors(state.point_slip)) if self.in_space else ()
        (tx, ty, tz), (sx, sy, sz) = (each.T for each in vectors or (nothing, nothing))
        return FrictionInterface(
            x=points[:, 0],
            y=points[:, 1],
            s=system.contacts.position,
            weight=system.weights,
            pressure=self.pressure,
            shear=shear,
            slip=slip,
            dissipated=state.dissipated,
            status=np.where(self.pressure > 0, np.where(self.sticking, 1, 2), 0),
            z=points[:, 2] if self.in_space else nothing[:, 2],
            shear_x=tx,
            shear_y=ty,
            shear_z=tz,
            slip_x=sx,
            slip_y=sy,
            slip_z=sz,
        )

    def edge_error(self) -> float | None:
        """Error of the worn volume by the position of the stick edge, relative to the volume.

        The edge is located to a part of a coefficient, see `stick_edge`. Depths grow with the root
        of the distance x from it: where it moves by δ, those of the scar, n coefficients wide,
        change by ``δ/2x`` of themselves, by that next to the edge times ``δ/√n`` in the mean. That
        counts the less, the smoother the pressure is across the edge.

        Returns
        -------
        float or None
            None without wear, and where tractions are those of points.
        """
        state, (basis, weights) = self.increment.state, (self.system.basis, self.system.weights)
        lost, worn = self.depths.sum(axis=0), state.worn
        total = float(weights @ lost)
        if total == 0.0 or worn.shape[1] != len(state.part):
            return None
        overlap = sp.csr_array(basis)
        near = overlap.T @ overlap
        stuck, depths = state.part > 0.0, worn.sum(axis=0)
        beyond = (near @ stuck.astype(float) > 0.0) & ~stuck & (depths > 0.0)
        inner = (near @ beyond.astype(float) > 0.0) & stuck
        areas, error = overlap.T @ weights, 0.0
        model, functions = self.system.model, function_ranges(self.system.contacts, basis)
        for interface, own in zip(model.interfaces, functions, strict=True):
            if not beyond[own].any():
                continue
            outside, within = (areas * beyond)[own], inner[own]
            depth = outside @ depths[own] / outside.sum()
            mean = outside @ state.pressure[own] / outside.sum()
            highest = state.pressure[own][within].max()
            scar = areas[own][depths[own] > _SCAR * depths[own].max()].sum()
            drop = max(1.0 - mean / highest, 0.0) if highest > 0.0 else 1.0
            located = 1.0
            if state.crossed[own].any():
                located = min(1.0, _LOCATED * model.pressure_degree(interface) ** 2)
            error += located * drop * depth * np.sqrt(scar * outside.sum())
        return float(error) / total

    def _shown(self, components: np.ndarray) -> np.ndarray:
        """Component along +x of a plane model, magnitude in space, shape (n,)."""
        if self.in_space:
            return np.linalg.norm(components, axis=1)
        return self.sense * components[:, 0]

    def power(self, before: FrettingState, duration: float) -> np.ndarray:
        """Friction power per area in the increment, shape (n,) [W/m²]; NaN without duration."""
        slid = self.increment.state.point_slip - before.increment.state.point_slip
        return -(self.shear * slid).sum(axis=1) / (duration or np.nan)
