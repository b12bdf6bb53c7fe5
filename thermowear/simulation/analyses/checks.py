"""Checks of the end of an analysis: open contact, holder moved back, inclined faces, deep wear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...contact.faces.rim import near_chosen, on_edges, rim
from ...contact.operators.pressure import dense, jumps, scaled
from ...contact.operators.rigid_motion import RigidHolder
from ...contact.search.pairing import Contacts, PairedFace
from ...contact.solvers.signorini import resisted
from ...errors import CaseError, ComputationError, percent
from ...geometry.checks.mesh_checks import length
from ...laws.motions import NOTHING_PRESSED
from ...model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
)
from ...model.model import Model
from ...results import InterfaceFields
from ...results.short_names import by_name
from ..accuracy.error_estimate import WORTH_A_WARNING
from ..geometry_update.outer_loop import GapWear
from ..geometry_update.wider_zone import reaches_open_end
from ..results.recording import Snapshot
from ..system.building import require_carried
from ..system.rigid_modes import applied
from ..system.system import System

_ANALYSES = ("initial", "transient", "fretting", "reciprocating")
"""Analyses with a defined holder position; a steady state has no history leading to one."""
_WORN_IN = ("steady", "stability")
"""Analyses whose pressure is that of wear that goes on for ever."""
_BACK = 1e-3
"""Motion, relative to the smallest face, up to which the drawn faces are those that meet."""
_PRESSING, _FEW = 1e-9, 100
"""Pressure that counts as none, relative to the largest one; number of functions next to which a
motion may be free."""
_STEEP = -0.75
"""Largest cosine between the outward normals where faces press; up to -0.5 they are paired."""
_MOLTEN = 3273.15
"""Temperature at which hardly any material is solid [K]."""
_SMALL = 0.02
"""Wear up to which the geometry of the unworn bodies is that of the worn ones, see `GapWear`."""
_CHANGED = 0.1
"""Largest change of pressure and temperatures by a geometry update that is not noted."""
_OF_BODIES = (
    "of the thickness behind the face or of its radius of curvature, or tilts elements by ten "
    "times that"
)


def require_computable(
    model: Model, analysis: Analysis, contacts: Contacts, holder: RigidHolder
) -> None:
    """Reject what an analysis cannot compute, as far as no solution is needed to tell.

    Parameters
    ----------
    model : Model
    analysis : Analysis
    contacts : Contacts
        Contact points of the unworn bodies.
    holder : RigidHolder

    Raises
    ------
    CaseError
        If it does not support faces of several materials, layers, fluids or reactions; if nothing
        presses the bodies together, or holds them.
    """
    if analysis.cyclic:
        keys = [f"{one.table}.fluid_pressure" for one in model.interfaces if one.fluid_pressure]
        keys += [f"holders.{one.name}.reaction" for one in model.holders if one.reaction]
        if keys:
            raise CaseError(f"{keys[0]}: is not supported in a {analysis.type} analysis")
        unsupported = "contact faces with layers" if model.coated else ""
        if any(jumps(pairing) for pairing in contacts.each):
            unsupported = "contact faces of several materials that wear by different laws"
        if unsupported:
            raise CaseError(f"a {analysis.type} analysis does not support {unsupported}")
    if isinstance(analysis, FrettingAnalysis):  # friction carries loads, too
        return
    require_carried(model, contacts, holder)
    loaded = any(mode.load or mode.amplitude or mode.history for mode in holder.rigid_modes)
    loaded = loaded or any(one.surface_forces for one in model.holders)
    loaded = loaded or any(one.fluid_pressure is not None for one in model.interfaces)
    loaded = loaded or model.heat is not None or bool(model.surface_pressures)
    if not loaded and not (contacts.gap < 0.0).any():
        raise CaseError(f"holders: {NOTHING_PRESSED}")


def moved_against_load(
    system: System, analysis: Analysis, end: Snapshot
) -> ComputationError | None:
    """Error for holders that have moved against their forces; None if they have not.

    Without heat, fluid, loads on surfaces and given motions, ``F·d = ∫ p g dA + ∫ p A p dA``: the
    forces do positive work on the holders unless the drawn faces overlap. Interference fits do so,
    too, but move holders by strains alone.
    """
    holders, free = system.model.holders, system.holder.rigid_modes
    if analysis.type not in _ANALYSES or system.thermal is not None or system.worn is not None:
        return None
    force = sum(holder.force or 0.0 for holder in holders)
    given = any(mode.amplitude is not None or mode.history for mode in free)
    given = given or any(holder.reaction for holder in holders)
    if not force or given or system.dead_load is not None:
        return None
    work = sum(applied(*pair) for pair in zip(holders, end.motions, strict=True))
    extent = min(pairing.extent for pairing in system.contacts.each)
    if -work <= _BACK * extent * force:
        return None
    pressing = end.contact.pressure > 0
    overlap = -float(system.contacts.gap[pressing].min(initial=0.0))
    several = len(holders) > 1
    return ComputationError(
        f"contact: the holder{'s end' if several else ' ends'} {-work / force:.3g} m behind where "
        f"{'they were' if several else 'it was'} drawn, though pressed on: the contact faces "
        f"overlap by up to {overlap:.3g} m before any load. Draw the bodies "
        "apart, so that they just touch; or name only the part of each face that is to touch"
    )


def inclined_faces(system: System, pressure: np.ndarray) -> str | None:
    """Note on contact of faces far from parallel; None if there is none."""
    cosine = -1.0
    for pairing, points in system.contacts:
        first, second = (side.face.normals(side.facet, side.t) for side in pairing.sides)
        opposed = np.einsum("ni,ni->n", first, second)[pressure[points] > 0]
        cosine = max(cosine, float(opposed.max(initial=-1.0)))
    if cosine <= _STEEP:
        return None
    angle = 180 - np.degrees(np.arccos(cosine))
    return (
        f"the contact reaches points where the unloaded faces are inclined by {angle:.0f} degrees "
        "to each other; strains are taken to be small, and from 60 degrees on faces are not paired"
    )


def free_motion(system: System, pressure: np.ndarray) -> str | None:
    """Note on a motion of a holder that no pressing function resists; None if there is none."""
    if system.model.method != "condensed":
        return None
    near = np.flatnonzero(abs(system.basis).T @ pressure)
    if not 0 < len(near) <= _FEW:  # more of them resist
        return None
    coefficients = np.linalg.lstsq(dense(system.basis[:, near]), pressure, rcond=None)[0]
    pressing = np.zeros(system.basis.shape[1], dtype=bool)
    pressing[near] = coefficients > _PRESSING * coefficients.max()
    weak = scaled(system.weights, system.basis).T @ system.holder.modes
    free = resisted(weak, pressing)[1]
    if not free.shape[1]:
        return None
    modes = [mode for mode in system.holder.rigid_modes if mode.amplitude is None]
    moved = modes[int(np.abs(free[:, 0]).argmax())].bodies
    return (
        f"{', '.join(system.model.bodies[k].name for k in moved)}: the pressure does not determine "
        "the tilt, as the contact is right below the pivot; the least tilt is given"
    )


def contact_at_an_end(system: System, pressure: np.ndarray) -> str | None:
    """Note on contact that ends only because a face does; None if there is none.

    Every rank calls. That is at an edge of one face where the surface of its body goes on, unless
    the other body ends there.
    """
    if reaches_open_end(system, pressure):
        return (
            "the contact reaches the end of the contact face, which was meshed for a smaller one; "
            "use contact.positioning = true, or a wider geometry.zone"
        )
    for pairing, points in system.contacts:
        ends = [_ends(system, side, pressure[points] > 0) for side in pairing.sides]
        for side, own, other in zip(pairing.sides, ends, ends[::-1], strict=True):
            if np.any(own[1] & ~other[0]):
                return (
                    f"the contact reaches the end of the contact face {side.face.name}, though the "
                    "surface of the body goes on; extend the face, or contact beyond it is left out"
                )
    return None


def _ends(system: System, side: PairedFace, pressing: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Masks of the pressing points near sharp edges of a face, and on those where it goes on."""
    model, face = system.model, side.face
    facet, t = side.facet[pressing], side.t[pressing]
    on_edge = on_edges(face, t)
    if not on_edge.any():
        nowhere = np.zeros(len(t), dtype=bool)
        return nowhere, nowhere
    faces = [one.faces for one in model.interfaces] + [tie.faces for tie in model.ties]
    sharp, goes_on = rim(face, system.bodies.each[face.body], [name for f in faces for name in f])
    return near_chosen(face, sharp, facet, t), np.any(on_edge & goes_on[facet], axis=1)


def singular_pressure(end: Snapshot, analysis: Analysis) -> tuple[dict[str, Any], str | None]:
    """Entries of the summary, and a note, on a pressure that is singular at sharp edges.

    Without entries where no point at such an edge presses that is not worn; a note where the
    largest pressure is at one. Every rank calls.
    """
    system, interface, p = end.system, end.interface, end.interface.pressure
    if analysis.type in _WORN_IN:
        return {}, None
    singular = system.at_singular_edges & (p > 0.0) & (interface.wear_1 + interface.wear_2 == 0.0)
    each: dict[str, dict] = {}
    largest, text = 0.0, None
    for one, (pairing, own) in zip(system.model.interfaces, system.contacts, strict=True):
        at, force = singular[own], pairing.weights * p[own]
        if not at.any():
            continue
        share, beside = float(force[at].sum() / force.sum()), float(p[own][~at].max(initial=0.0))
        each[one.name] = {
            "singular_edge_load_fraction": share,
            "max_pressure_off_singular_edges_Pa": beside,
        }
        if p[own][at].max() > max(beside, largest):
            largest = float(p[own][at].max())
            where = f" of the contact {one.name}" if one.name else ""
            text = (
                f"the largest pressure{where}, {largest / 1e6:.4g} MPa, is at a sharp edge of one "
                "body on the face of the other one, where it is singular: it grows with every "
                f"refinement. The elements at such edges carry {percent(share)} of the load"
                + (f"; the largest pressure off them is {beside / 1e6:.4g} MPa" if beside else "")
            )
    return by_name("contacts", each) if each else {}, text


def too_hot(summary: Mapping[str, Any]) -> str | None:
    """Note on a computed temperature at which no body is solid; None if there is none."""
    found = (summary.get(key) for key in ("max_temperature_K", "peak_temperature_K"))
    highest = max((temperature for temperature in found if temperature is not None), default=0.0)
    if highest < _MOLTEN:
        return None
    return (
        f"highest temperature {highest - 273.15:.4g} °C: beyond the melting point of nearly all "
        "materials; check load, speed, friction and cooling"
    )


def open_contact(system: System, interface: InterfaceFields) -> ComputationError | str | None:
    """Error or note for an analysis that ends without contact. Every rank calls.

    A constant pressing force must be carried, or the computation has failed. A given approach, a
    surface load or a load history may leave the faces apart, and wear may separate them: that is a
    valid result with a note.

    Returns
    -------
    ComputationError, str or None
        Error, note, or None with contact.
    """
    each = zip(system.model.interfaces, system.contacts.ranges, strict=True)
    apart_at = [one.name for one, own in each if not interface.pressure[own].max() > 0.0]
    if not apart_at:
        return None
    if len(apart_at) < len(system.model.interfaces):
        return f"nothing touches at the end in the contacts: {', '.join(apart_at)}"
    gap = np.nanmin(interface.gap, initial=np.inf)
    apart = f"; the faces are {1e6 * gap:.4g} µm apart at least" if np.isfinite(gap) else ""
    given = [h.force for h in system.model.holders if h.history is None and h.force is not None]
    force = max(given, default=None)
    if force is None:
        return f"nothing touches at the end{apart}"
    return ComputationError(f"nothing carries the pressing force of {force:.4g} N{apart}")


def deep_wear(system: System, analysis: Analysis, interface: InterfaceFields) -> str | None:
    """Note on an analysis without mesh motion that leaves the small-wear regime; every rank calls.

    Meshes are not moved in steady, fretting and reciprocating analyses. In reciprocating sliding
    the depths are those at mid-stroke of body 1; in a steady state they are at least those that
    close the gaps of the unworn faces.

    Returns
    -------
    str or None
        None if the wear is small, or declared small by ``wear.update = "never"``.
    """
    if analysis.type == "steady":
        return _deep_steady(system, interface)
    if not isinstance(analysis, FrettingAnalysis | ReciprocatingAnalysis):
        return None
    allowed = analysis.largest_kept
    fraction = GapWear(system).fraction(np.array([interface.wear_1, interface.wear_2]))
    if fraction <= allowed:
        return None
    return (
        f"the wear, which a {analysis.type} analysis keeps in the gap, comes to {fraction:.2%} "
        f"{_OF_BODIES}: pressures and shapes are those of small wear, up to {allowed:.2%}"
    )


def changed_by_updates(summary: Mapping[str, Any]) -> str | None:
    """Note on geometry updates that change the pressure much; None if there were none."""
    change = summary.get("geometry_change", 0.0)
    if change <= _CHANGED:
        return None
    return (
        f"wear.update: pressure or temperatures changed by up to {percent(change)} as meshes "
        "were moved to the worn faces, whose shape the elements do not follow; wear evens that "
        "out, but the states behind it are less accurate: use finer elements where faces bend"
    )


def stick_edge(summary: Mapping[str, Any]) -> str | None:
    """Note on a worn volume that depends on where elements place the edge of the stick zone."""
    error = summary.get("wear_volume_error_estimate_relative") or 0.0
    if error <= WORTH_A_WARNING:
        return None
    return (
        f"wear: the worn volume is uncertain by about {percent(error)}, depths, shape and "
        "largest pressure more: the elements locate the edge of the stick zone to a part of their "
        "size; use more mesh.elements there"
    )


def _deep_steady(system: System, interface: InterfaceFields) -> str | None:
    """Note on unworn faces so far apart that wear that closes their gaps is not small.

    Gaps that motions of the holders close are left out.
    """
    presses, modes = interface.pressure > 0.0, system.holder.modes
    motion = np.linalg.lstsq(modes[presses], system.contacts.gap[presses], rcond=None)[0]
    unworn, depth = system.contacts.gap - modes @ motion, np.zeros((2, len(presses)))
    for own in (own for own in system.contacts.ranges if presses[own].any()):
        largest = unworn[own][presses[own]].max()
        depth[:, own] = np.where(presses[own], largest - unworn[own], 0.0)
    depth[[side for side in (0, 1) if side not in system.laws]] = 0.0
    fraction = GapWear(system).fraction(depth)
    if fraction <= _SMALL:
        return None
    return (
        f"the steady state touches where the unworn faces are up to {length(depth.max())} apart: "
        f"wear of this depth comes to {fraction:.2%} {_OF_BODIES}; temperatures, deflection and "
        "worn shape are those of the unworn bodies. A transient analysis moves the meshes"
    )
