"""Faces that an analysis supports: of several materials, and with layers."""

from __future__ import annotations

from ...contact.operators.pressure import jumps
from ...errors import CaseError
from ...model.analyses import Analysis
from ..runtime.observer import Observer
from ..system.system import System

_FOR_EVER = "steady", "stability"


def wearing_faces(system: System, analysis: Analysis, observer: Observer) -> System:
    """System with the faces that an analysis computes with.

    The steady state is that of wear that goes on for ever, in which all layers are worn through.

    Raises
    ------
    CaseError
        If the analysis does not support the faces.
    """
    coated = system.model.coated
    if analysis.cyclic:
        unsupported = ""
        if any(jumps(pairing) for pairing in system.contacts.each):
            unsupported = "contact faces of several materials that wear by different laws"
        elif coated:
            unsupported = "contact faces with layers"
        if unsupported:
            raise CaseError(f"a {analysis.type} analysis does not support {unsupported}")
    if not coated or analysis.type not in _FOR_EVER:
        return system
    observer.note(
        f"a {analysis.type} analysis describes wear that goes on for ever: all layers are worn "
        "through, and the laws of the substrates hold"
    )
    return system.worn_through()
