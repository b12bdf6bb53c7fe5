"""The interface: contact points, traces, condensation, contact and heat exchange."""

from .faces.face import Face, Surface, gather_face
from .friction.frictional_contact import FrictionalContact, condense_tangential
from .friction.stick_slip import advance, follow
from .friction.stick_slip_state import Loads, StickSlipState
from .full.full_system import FullContact, FullSolution
from .full.nitsche import normal_traction
from .operators.condensation import (
    CondensedContact,
    condense,
    condense_heat,
    gap_trace,
    value_trace,
    vector_trace,
)
from .operators.exchange_matrix import ThermalState
from .operators.heat_exchange import InterfaceHeat
from .operators.pressure import contact_zones, pressure_basis
from .operators.rigid_motion import RigidHolder, RigidMode, Sliding, hold, sliding
from .operators.thermal_opening import condense_distortion
from .search.pairing import Pairing, pair
from .solvers.signorini import SignoriniSolution, solve_contact
