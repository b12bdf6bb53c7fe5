"""The interface: contact points, traces, condensation, contact and heat exchange."""

from .complementarity import ContactSolution, solve_contact
from .condensation import CondensedContact, condense
from .face import Face, gather_face
from .full_system import FullContact, FullSolution
from .heat import InterfaceHeat, ThermalState, condense_distortion, condense_heat
from .holder import Holder, hold
from .loads import Loads
from .pairing import Pairing, pair
from .pressure import pressure_basis
from .stick_slip import StickSlipState, advance, follow
from .tangential import FrictionalContact, condense_tangential
from .traces import gap_trace, value_trace, vector_trace
from .traction import normal_traction
from .zones import contact_zones

__all__ = [
    "CondensedContact",
    "ContactSolution",
    "Face",
    "FrictionalContact",
    "FullContact",
    "FullSolution",
    "Holder",
    "InterfaceHeat",
    "Loads",
    "Pairing",
    "StickSlipState",
    "ThermalState",
    "advance",
    "condense",
    "condense_distortion",
    "condense_heat",
    "condense_tangential",
    "contact_zones",
    "follow",
    "gap_trace",
    "gather_face",
    "hold",
    "normal_traction",
    "pair",
    "pressure_basis",
    "solve_contact",
    "value_trace",
    "vector_trace",
]
