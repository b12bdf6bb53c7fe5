"""The interface: contact points, traces, condensation, contact and heat exchange."""

from .complementarity import ContactSolution, solve_contact
from .condensation import CondensedContact, condense
from .face import Face, gather_face
from .full_system import FullContact, FullSolution
from .heat import InterfaceHeat, ThermalState
from .heat_condensation import condense_distortion, condense_heat
from .holder import Drive, Holder, hold
from .loads import Loads
from .pairing import Pairing, pair
from .pressure import pressure_basis
from .sliding import Sliding, sliding
from .stick_slip import advance, follow
from .stick_slip_state import StickSlipState
from .surface import Surface
from .tangential import FrictionalContact, condense_tangential
from .traces import gap_trace, value_trace, vector_trace
from .traction import normal_traction
from .zones import contact_zones

__all__ = [
    "CondensedContact",
    "ContactSolution",
    "Drive",
    "Face",
    "FrictionalContact",
    "FullContact",
    "FullSolution",
    "Holder",
    "InterfaceHeat",
    "Loads",
    "Pairing",
    "Sliding",
    "StickSlipState",
    "Surface",
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
    "sliding",
    "solve_contact",
    "value_trace",
    "vector_trace",
]
