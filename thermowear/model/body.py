"""Body: its materials and supports; materials of two bodies at the contact points."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ..errors import CaseError
from ..laws.interfaces import Table1D

WHY = "the material lies on a contact face"


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic and heat-conducting material.

    Attributes
    ----------
    young_modulus : float
        Young's modulus [Pa].
    poisson_ratio : float
        Poisson's ratio.
    expansion : float
        Secant coefficient of thermal expansion from the ambient temperature [1/K].
    conductivity : float or None
        Conductivity at the ambient temperature [W/(m K)].
    density : float or None
        Density, for transient temperatures and advection [kg/m³].
    specific_heat : float or None
        Specific heat capacity, for transient temperatures and advection [J/(kg K)].
    hardness : float or None
        Hardness of the softer surface layer, for a pressure-dependent contact conductance [Pa].
    yield_strength : float or None
        Yield strength [Pa]; bodies are elastic, a note says where the von Mises stress passes it.
    expansion_factor : Table1D or None
        Temperature-dependent factor of the expansion [-, by K]: the thermal strain is ``expansion
        factor(T) (T - ambient)``.
    conductivity_factor : Table1D or None
        Temperature-dependent factor of the conductivity [-, by K].
    label : str
        Name of the material in messages.
    """

    young_modulus: float
    poisson_ratio: float
    expansion: float = 0.0
    conductivity: float | None = None
    density: float | None = None
    specific_heat: float | None = None
    hardness: float | None = None
    yield_strength: float | None = None
    expansion_factor: Table1D | None = None
    conductivity_factor: Table1D | None = None
    label: str = field(default="material", compare=False)

    def known(self, name: str, why: str) -> float:
        """Property that a computation needs.

        Parameters
        ----------
        name : str
        why : str
            Reason, for the message.

        Raises
        ------
        CaseError
            If the material does not define it.
        """
        value = getattr(self, name)
        if value is None:
            raise CaseError(f"{self.label}.{name}: missing; {why}")
        return value

    @property
    def compliance(self) -> float:
        """Plane-strain compliance ``(1 - ν²) / E`` [1/Pa]."""
        return (1 - self.poisson_ratio**2) / self.young_modulus

    @property
    def capacity(self) -> float | None:
        """Heat capacity per volume [J/(m³ K)]; None if it is not known."""
        if self.density is None or self.specific_heat is None:
            return None
        return self.density * self.specific_heat

    def effusivity(self, why: str) -> float:
        """Thermal effusivity ``sqrt(k rho c)`` [W sqrt(s)/(m² K)].

        Raises
        ------
        CaseError
            If the material does not define all three.
        """
        return math.sqrt(
            math.prod(self.known(key, why) for key in ("conductivity", "density", "specific_heat"))
        )


@dataclass(frozen=True)
class Body:
    """Elastic and heat-conducting body.

    Attributes
    ----------
    name : str
    materials : mapping of str to Material
        Materials by part of the mesh; the first part has the name of the body.
    fixed : tuple of str
        Clamped surfaces, also the one on the rigid holder.
    rollers : tuple of str
        Surfaces that cannot move along y, but freely along x.
    mid_plane : tuple of str
        Surfaces in space that cannot move along z, but freely in their plane z = const: on a plane
        of symmetry of the body, or on a smooth support.
    surfaces : tuple of str
        Named surfaces.
    ring : float
        Volume of the body relative to that in the model: a rotating body whose whole ring passes
        under another one that covers a sector conducts, stores and cools as a whole.
    """

    name: str
    materials: Mapping[str, Material]
    fixed: tuple[str, ...] = ()
    rollers: tuple[str, ...] = ()
    mid_plane: tuple[str, ...] = ()
    surfaces: tuple[str, ...] = ()
    ring: float = 1.0

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of the parts of the mesh."""
        return tuple(self.materials)

    @property
    def compliance(self) -> float:
        """Plane-strain compliance of the body's own material [1/Pa]."""
        return self.materials[self.name].compliance


@dataclass(frozen=True)
class Facing:
    """Parts of the bodies that face each other at the contact points.

    Attributes
    ----------
    parts : tuple of str
        Names of the parts.
    at : tuple of ndarray of int, shape (n,)
        Index of the part that bears the face of body 1 and of body 2 at each point.
    """

    parts: tuple[str, ...]
    at: tuple[np.ndarray, np.ndarray]

    def of(
        self, materials: Mapping[str, Material], value: Callable[[Material], float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Material property at the points of both faces, shape (n,) each.

        Parameters
        ----------
        materials : mapping of str to Material
            Materials by part.
        value : callable
            Property of a material.
        """

        def on_face(at: np.ndarray) -> np.ndarray:
            indices, which = np.unique(at, return_inverse=True)
            return np.array([value(materials[self.parts[index]]) for index in indices])[which]

        return on_face(self.at[0]), on_face(self.at[1])

    def effusivities(self, materials: Mapping[str, Material]) -> tuple[np.ndarray, np.ndarray]:
        """Thermal effusivities at the points of both faces [W sqrt(s)/(m² K)].

        Raises
        ------
        CaseError
            If a material on a contact face does not define what it follows from.
        """
        return self.of(materials, lambda material: material.effusivity(WHY))
