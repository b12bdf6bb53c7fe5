"""Frictional contact of a system by its contact method."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...contact.friction.condensed_friction import condense_tangential
from ...contact.friction.frictional_contact import FrictionalContact
from ...contact.full.full_friction import full_friction
from ...contact.operators.tangential import HeldMotion
from ...errors import CaseError
from ..interface.full_method import contact_stiffness
from ..system.system import System


def frictional_contact_of(
    system: System,
    held: Sequence[HeldMotion],
    frame: np.ndarray,
    note: Callable[[str], None] | None = None,
) -> FrictionalContact:
    """Frictional contact of a system. Every rank calls.

    Parameters
    ----------
    system : System
    held : sequence of HeldMotion
        Motions of the holders.
    frame : ndarray, shape (t, n, gdim)
        Tangential directions, see `tangential_frame`.
    note : callable, optional
        Receives a warning about parameters of the method out of range.

    Raises
    ------
    CaseError
        If the method knows no stick and slip.
    """
    method = system.model.method
    if method == "pointwise":
        raise CaseError('contact.method: "pointwise" does not support a fretting analysis')
    operators = system.elastic, system.contacts, system.basis, held, frame
    if method == "condensed":
        with system.phases("condense elasticity"):
            return condense_tangential(*operators)
    theta = system.model.interface.method.theta if method == "nitsche" else None
    stiffness = contact_stiffness(system, note)
    return full_friction(*operators, stiffness, theta)
