"""The interface: contact points, traces, condensation, contact and heat exchange."""

from .complementarity import ContactSolution, solve_contact
from .condensation import CondensedContact, condense
from .face import Face, gather_face
from .heat import InterfaceHeat, ThermalState, condense_distortion, condense_heat
from .pairing import Pairing, pair
from .pressure import pressure_basis
from .traces import gap_trace, value_trace

__all__ = [
    "CondensedContact",
    "ContactSolution",
    "Face",
    "InterfaceHeat",
    "Pairing",
    "ThermalState",
    "condense",
    "condense_distortion",
    "condense_heat",
    "gap_trace",
    "gather_face",
    "pair",
    "pressure_basis",
    "solve_contact",
    "value_trace",
]
