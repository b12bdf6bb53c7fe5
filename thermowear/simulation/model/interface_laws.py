"""Friction, conductance and partition of friction heat at the interface of a case."""

from __future__ import annotations

import numpy as np

from ...case.tables.conductance import PressureConductanceTable, TabulatedConductanceTable
from ...case.tables.facing import Facing
from ...case.tables.law_values import law_of
from ...case.tables.schema import Case
from ...laws.coefficients import conductance as laws
from ...laws.coefficients.multipliers import Multiplied
from ...laws.interfaces import InterfaceLaw


def friction_law(case: Case) -> InterfaceLaw:
    """Friction law with its tabulated factors, without its history in time."""
    contact = case.contact
    factors = contact.friction_factor.multipliers
    return Multiplied(contact.friction_law, factors) if factors.variables else contact.friction_law


def conductance_law(case: Case, facing: Facing) -> InterfaceLaw | None:
    """Contact conductance at the points [W/(m² K)]; None: perfect contact.

    Parameters
    ----------
    case : Case
        A case with heat.
    facing : Facing
        Parts in contact at the points.
    """
    assert case.heat is not None
    given = case.heat.conductance
    if isinstance(given, TabulatedConductanceTable):
        return laws.TabulatedConductance(given.table)
    if isinstance(given, PressureConductanceTable):
        k, hardness = (
            laws.harmonic_mean(*facing.of(case.located_material, key))
            for key in ("conductivity", "hardness")
        )
        return laws.PressureConductance(given.coefficient, k, hardness)
    return None if given is None else law_of(given, "heat.conductance", 0.0)


def partition(case: Case, facing: Facing) -> float | np.ndarray:
    """Fraction of the friction heat released into body 1, shape (n,) or uniform."""
    assert case.heat is not None
    share = case.heat.partition
    if isinstance(share, float):
        return share
    e1, e2 = facing.of(case.located_material, "effusivity")
    return e1 / (e1 + e2)
