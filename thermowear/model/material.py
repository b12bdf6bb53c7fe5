"""Material of a body, or of a part of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ..errors import CaseError
from ..laws.coefficients import Table1D


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic and heat-conducting material.

    Attributes
    ----------
    young_modulus : float
        [Pa]
    poisson_ratio : float
    expansion : float
        Secant coefficient of thermal expansion from the ambient temperature [1/K].
    conductivity : float or None
        Conductivity at the ambient temperature [W/(m K)].
    density : float or None
        [kg/m³]
    specific_heat : float or None
        [J/(kg K)]
    hardness : float or None
        Hardness of the softer surface layer, for a pressure-dependent contact conductance [Pa].
    expansion_factor, conductivity_factor : Table1D or None
        Temperature-dependent factors of both [-, by K]: the thermal strain is
        ``expansion factor(T) (T - ambient)``.
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
