"""Steady worn shape as the design of a contact face: ``thermowear shape``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import load
from ..case import Case, as_plain
from ..case.tables.plane_geometry import PlaneGeometry
from ..errors import CaseError
from ..geometry.cad.design import CARRIERS, Design, add_table, write_table
from ..geometry.cad.step import write_prism, write_section
from ..geometry.cad.worn_body import only_body, write_design_mesh
from ..geometry.mesh.mixed import block_of

_FORMATS = (".csv", *CARRIERS)
_IN_TIME = ("transient", "initial")
"""Keys of heat that do not apply to a steady state."""


@dataclass(frozen=True)
class Shaped:
    """Design of a body with the case that it was computed from.

    Attributes
    ----------
    case : Case
        Steady analysis of the design.
    body : str
    design : Design
    """

    case: Case
    body: str
    design: Design


def check_format(path: Path) -> None:
    """Raise a `CaseError` if the file extension is not that of a format for designs."""
    if path.suffix not in _FORMATS:
        raise CaseError(f"-o {path}: unknown ending; one of: {', '.join(_FORMATS)}")


def steady_case(source: Case | str | Path, overrides: tuple[str, ...] = ()) -> Case:
    """Steady analysis of a case with nominal faces, for any type of analysis in the case.

    Raises
    ------
    CaseError
        If the case is invalid, or has no steady state.
    """
    case = source if isinstance(source, Case) else load(source, overrides)
    if not isinstance(case, Case):
        raise CaseError(
            "shape: is for cases of two bodies; the steady worn shapes of several are "
            "in profile_NAME.csv of a steady analysis"
        )
    tables: dict[str, Any] = as_plain(case) | {"analysis": {"type": "steady"}}
    tables["geometry"] = {k: v for k, v in tables["geometry"].items() if k != "initial_shape"}
    if "heat" in tables:
        tables["heat"] = {k: v for k, v in tables["heat"].items() if k not in _IN_TIME}
    steady = load(tables)
    assert isinstance(steady, Case)
    return steady


def shape(
    source: Case | str | Path, body: str | None = None, overrides: tuple[str, ...] = ()
) -> Shaped:
    """Initial shape of one contact face with which there is no running-in.

    Parameters
    ----------
    source : Case, str or Path
        Case, or path of a case file.
    body : str, optional
        Body whose face is shaped, body 1 by default; it need not be the wearing body.
    overrides : tuple of str
        Changes of keys, ``KEY=VALUE`` each.

    Raises
    ------
    CaseError
        If the case is invalid, or no shape of this body persists.
    ComputationError
        If there is no steady state.
    """
    case = steady_case(source, overrides)
    bodies = case.geometry.bodies
    body = bodies[0] if body is None else body
    if body not in bodies:
        raise CaseError(f"--body {body}: not a body of this case; one of: {', '.join(bodies)}")
    passes = case.model != "axisymmetric" and not case.geometry.slides_across
    if body == bodies[1] and passes:
        raise CaseError(
            f"--body {body}: slides past under {bodies[0]}, so that its shape does not stay in the "
            f"contact; use --body {bodies[0]}"
        )
    from mpi4py import MPI

    from ..simulation.analyses.design import steady_design
    from ..simulation.analyses.positioning import prepare
    from ..simulation.from_case import model_of
    from ..timer import Phases

    system = prepare(model_of(case), MPI.COMM_SELF, Phases(lambda _: None))
    return Shaped(case, body, steady_design(system, bodies.index(body) + 1))


def write_shape(shaped: Shaped, path: Path) -> None:
    """Write a design in the format given by the file extension.

    Raises
    ------
    CaseError
        If the extension is not known, or the file cannot be written.
    """
    check_format(path)
    case, design = shaped.case, shaped.design
    if path.suffix == ".csv":
        write_table(design, path)
        return
    geometry = case.geometry
    face = geometry.contact[design.body - 1]
    parts = geometry.parts_of(shaped.body)
    mesh = only_body(block_of(case.tagged_mesh(), *parts), parts)
    if path.suffix != ".step":
        from ..bulk.mesh_motion import serial_extension

        write_design_mesh(mesh, design, face, path, serial_extension)
    elif case.model == "3d":
        write_prism(mesh, design, face, path)
    elif case.model == "axisymmetric":
        turn = 2 * math.pi * (geometry.sector if design.body == 1 else 1.0)
        write_section(mesh, design, face, path, turn=turn)
    else:
        assert isinstance(geometry, PlaneGeometry)  # guaranteed by validation
        half = bool(geometry.symmetry)
        write_section(mesh, design, face, path, thick=geometry.thickness, half=half)
    add_table(design, path)
