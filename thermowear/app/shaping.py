"""Steady worn shape as the design of a contact face: ``thermowear shape``."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .. import load
from ..case import AnyCase, as_plain
from ..errors import CaseError
from ..geometry.cad.design import CARRIERS, Design, add_table, write_table
from ..geometry.cad.step import write_faceted, write_prism, write_section
from ..geometry.cad.worn_body import moved_body, only_body, write_design_mesh
from ..geometry.mesh.mixed import block_of
from ..model.body import Body
from ..model.model import Model

_FORMATS = (".csv", *CARRIERS)
_IN_TIME = ("transient", "initial")
"""Keys of heat that do not apply to a steady state."""
_DRAWN = ("initial_shape",)
"""Key of geometry and contacts; a design refers to the faces as drawn."""


@dataclass(frozen=True)
class Shaped:
    """Design of a contact face with the case that it was computed from.

    Attributes
    ----------
    case : Case or AssemblyCase
        Steady analysis of the design.
    model : Model
    body : Body
        Body with the face.
    face : str
        Surface that takes the shape.
    design : Design
    """

    case: AnyCase
    model: Model
    body: Body
    face: str
    design: Design


def check_format(path: Path) -> None:
    """Raise a `CaseError` if the file extension is not that of a format for designs."""
    if path.suffix not in _FORMATS:
        raise CaseError(f"-o {path}: unknown ending; one of: {', '.join(_FORMATS)}")


def steady_case(source: AnyCase | str | Path, overrides: tuple[str, ...] = ()) -> AnyCase:
    """Steady analysis of a case with nominal faces, for any type of analysis in the case.

    Raises
    ------
    CaseError
        If the case is invalid, or has no steady state.
    """
    case = source if isinstance(source, AnyCase) else load(source, overrides)
    tables: dict[str, Any] = as_plain(case) | {"analysis": {"type": "steady"}}
    tables["geometry"] = _without(tables["geometry"], _DRAWN)
    if "heat" in tables:
        tables["heat"] = _without(tables["heat"], _IN_TIME)
    if "contacts" in tables:
        contacts = tables["contacts"].items()
        tables["contacts"] = {name: _without(contact, _DRAWN) for name, contact in contacts}
    return load(tables)


def _without(table: dict[str, Any], keys: tuple[str, ...]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key not in keys}


def shape(
    source: AnyCase | str | Path,
    body: str | None = None,
    overrides: tuple[str, ...] = (),
    face: str | None = None,
) -> Shaped:
    """Initial shape of one contact face with which there is no running-in.

    Of several contacts, all get a shape of their own, computed together.

    Parameters
    ----------
    source : Case, AssemblyCase, str or Path
        Case, or path of a case file.
    body : str, optional
        Body whose face is shaped, of two bodies body 1 by default; it need not be the wearing body.
    overrides : tuple of str
        Changes of keys, ``KEY=VALUE`` each.
    face : str, optional
        Surface that is shaped, of a body with several contact faces.

    Raises
    ------
    CaseError
        If the case is invalid, or no shape of this face persists.
    ComputationError
        If there is no steady state.
    """
    from mpi4py import MPI

    from ..simulation.analyses.positioning import prepare
    from ..simulation.analyses.static import steady_design
    from ..simulation.from_case import model_of, with_accurate_mesh
    from ..timer import Phases

    case = with_accurate_mesh(steady_case(source, overrides), MPI.COMM_SELF)
    model = model_of(case)
    number, side = _place(model, body, face)
    interface = model.interfaces[number]
    shaped = model.bodies[interface.bodies[side]]
    if side == 1 and model.kinematics != "axisymmetric" and not interface.motion.across:
        first = model.bodies[interface.bodies[0]].name
        raise CaseError(
            f"{_option(body, face)}: slides past under {first}, so that its shape does not stay in "
            f"the contact; use --body {first}"
        )
    system = prepare(model, MPI.COMM_SELF, Phases(lambda _: None))
    return Shaped(case, model, shaped, interface.faces[side], steady_design(system, number, side))


def _option(body: str | None, face: str | None) -> str:
    return f"--body {body}" if face is None else f"--face {face}"


def _place(model: Model, body: str | None, face: str | None) -> tuple[int, int]:
    """Numbers of the interface and of its side to which a face belongs."""
    places = {
        surface: (number, side, model.bodies[interface.bodies[side]].name)
        for number, interface in enumerate(model.interfaces)
        for side, surface in enumerate(interface.faces)
    }
    if face is not None and face not in places:
        raise CaseError(f"--face {face}: no contact face; one of: {', '.join(places)}")
    owners = dict.fromkeys(name for *_, name in places.values())
    if body is None and len(model.interfaces) == 1:
        body = next(iter(owners))
    if face is None and body is not None and body not in owners:
        raise CaseError(f"--body {body}: no body with a contact face; one of: {', '.join(owners)}")
    found = [surface for surface in places if face in (surface, None)]
    if face is None:
        found = [surface for surface in found if body in (places[surface][2], None)]
    if len(found) > 1:
        raise CaseError(f"shape: there are several contact faces; add --face {' | '.join(found)}")
    number, side, _ = places[found[0]]
    return number, side


def write_shape(shaped: Shaped, path: Path) -> None:
    """Write a design in the format given by the file extension.

    Raises
    ------
    CaseError
        If the extension is not known, or the file cannot be written.
    """
    check_format(path)
    case, model, design, face = shaped.case, shaped.model, shaped.design, shaped.face
    if path.suffix == ".csv":
        write_table(design, path)
        return
    geometry: Any = case.geometry
    parts = geometry.parts_of(shaped.body.name)
    mesh = only_body(block_of(case.tagged_mesh(), *parts), parts)
    from ..bulk.mesh_motion import serial_extension

    if path.suffix != ".step":
        write_design_mesh(mesh, design, face, path, serial_extension)
    elif mesh.cell_type == "tetrahedron":
        points = moved_body(mesh, design, face, serial_extension)
        write_faceted(replace(mesh, points=points), face, path)
    elif model.kinematics == "3d":
        write_prism(mesh, design, face, path)
    elif model.kinematics == "axisymmetric":
        turn = 2 * math.pi * model.sector * shaped.body.ring
        write_section(mesh, design, face, path, turn=turn)
    else:
        half = not set(model.symmetry).isdisjoint(shaped.body.surfaces)
        write_section(mesh, design, face, path, thick=geometry.thickness, half=half)
    add_table(design, path)
