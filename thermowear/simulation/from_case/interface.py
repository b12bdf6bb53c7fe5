"""Interface of a case: laws of friction, conductance and wear."""

from __future__ import annotations

from ...case.tables.analyses import Fretting
from ...case.tables.laws import PressureConductanceTable, TabulatedConductanceTable, law_of
from ...case.tables.schema import Case
from ...case.tables.wear import BodyWearTable
from ...laws.coefficients import Multipliers
from ...laws.distribution import Distribution, InPlace
from ...laws.interfaces import Law
from ...laws.power_wear import PowerWear
from ...model.interface import ContactMethod, HardnessConductance, Interface
from ...model.wear import CircularTrack, EvenTrack, FaceWear


def interface(case: Case) -> Interface:
    """Interface of a case."""
    contact, heat = case.contact, case.heat
    history = contact.friction_history
    return Interface(
        faces=case.geometry.contact,
        friction=contact.friction_law,
        friction_factors=contact.friction_factor.multipliers,
        friction_history=None if history is None else history.function,
        transverse_friction=contact.transverse_friction,
        conductance=conductance(case),
        gap_conductance=0.0 if heat is None else heat.gap_conductance or 0.0,
        partition=0.5 if heat is None else heat.partition,
        wear=_wear(case),
        closes_by_wear=not isinstance(case.analysis, Fretting),
        compliance=contact.compliance or 0.0,
        initial_shape=case.geometry.initial_shape,
        pressure_degree=contact.pressure_degree,
        method=ContactMethod(
            contact.method,
            contact.penalty,
            1 if contact.theta is None else contact.theta,
            contact.gamma,
        ),
    )


def conductance(case: Case) -> Law | HardnessConductance | None:
    """Contact conductance of a case; None: perfect contact, or no heat."""
    given = None if case.heat is None else case.heat.conductance
    if isinstance(given, TabulatedConductanceTable):
        return Multipliers({"p": given.table})
    if isinstance(given, PressureConductanceTable):
        return HardnessConductance(given.coefficient)
    return None if given is None else law_of(given, "heat.conductance", 0.0)


def _wear(case: Case) -> dict[int, FaceWear]:
    """Wear of the faces by index; bodies without a wear table do not wear."""
    return {
        index: _face_wear(case, case.wear[name])
        for index, name in enumerate(case.geometry.bodies)
        if name in case.wear
    }


def _face_wear(case: Case, wear: BodyWearTable) -> FaceWear:
    factors, track = wear.factor.multipliers, _track(case, wear)
    if wear.law is not None:
        return FaceWear(wear.law, factors, track=track)
    κ, b, a = wear.coefficient_si(), wear.pressure_exponent, wear.velocity_exponent
    if wear.per == "pressure":
        return FaceWear(PowerWear(κ, b, a), factors, track=track, per=wear.per)
    law = PowerWear.per_friction_stress(κ, case.contact.nominal_friction, b, a)
    return FaceWear(law, factors, b, track, wear.per)


def _track(case: Case, wear: BodyWearTable) -> Distribution | EvenTrack | CircularTrack:
    geometry = case.geometry
    if wear.spread == "in-place":
        return InPlace()
    if geometry.duty is not None and geometry.rotation_center is not None:
        return CircularTrack(geometry.rotation_center, geometry.duty)
    return Distribution(geometry.sector) if geometry.track is None else EvenTrack(geometry.track)
