"""Wear of the faces of a case: laws, layers and materials."""

from __future__ import annotations

from dataclasses import replace

from ...case.assembly.geometry import AssemblyGeometry
from ...case.tables.contact import InterfaceTable
from ...case.tables.geometry import Geometry
from ...case.tables.materials import part_named
from ...case.tables.wear import BodyWearTable, RateTable
from ...laws.distribution import IN_PLACE, Distribution
from ...laws.wear import LayeredWear, PowerWear
from ...model.face_wear import CompositeWear, FaceWear, Wear
from ...model.tracks import Track


def body_wear(
    geometry: Geometry | AssemblyGeometry,
    name: str,
    wear: BodyWearTable,
    contact: InterfaceTable,
    track: Distribution | Track,
) -> Wear:
    """Wear of a body by one law, or by those of its parts; the others have the body's own.

    Parameters
    ----------
    geometry : Geometry or AssemblyGeometry
    name : str
        Name of the body.
    wear : BodyWearTable
    contact : InterfaceTable
        Contact of the face, which defines the friction stress.
    track : Distribution or Track
        Where a body with one law wears; those of parts wear in place.
    """
    if not wear.materials:
        return _layered(wear, contact, track)
    parts = geometry.parts_of(name)
    found = dict.fromkeys(parts, face_wear(wear, contact)) if wear.has_law else {}
    regions = {}
    for key, law in wear.materials.items():
        if law.where is not None:
            regions[key] = law.where, face_wear(law, contact)
        elif (part := part_named(geometry, name, key)) is not None:
            found[part] = face_wear(law, contact)
    return CompositeWear(found, regions)


def _layered(wear: BodyWearTable, contact: InterfaceTable, track: Distribution | Track) -> FaceWear:
    """Wear of a face by one law, or by those of its layers and of the substrate below them."""
    substrate = face_wear(wear, contact, track)
    if wear.layers is None:
        return substrate
    laws = (*(face_wear(layer, contact).law for layer in wear.of_layers), substrate.law)
    return replace(substrate, law=LayeredWear(wear.layers.thickness, laws))


def face_wear(
    wear: RateTable, contact: InterfaceTable, track: Distribution | Track = IN_PLACE
) -> FaceWear:
    """Wear of a face in a contact, which defines the friction stress."""
    factors = wear.factor.multipliers
    if wear.law is not None:
        return FaceWear(wear.law, factors, track=track)
    κ, b, a = wear.coefficient_si(), wear.pressure_exponent, wear.velocity_exponent
    if wear.per == "pressure":
        return FaceWear(PowerWear(κ, b, a), factors, track=track, per=wear.per)
    law = PowerWear.per_friction_stress(κ, contact.nominal_friction, b, a)
    return FaceWear(law, factors, b, track, wear.per)
