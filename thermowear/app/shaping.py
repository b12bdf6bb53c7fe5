"""The steady worn shape as a design: ``thermowear shape``."""

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
from ..geometry.cad.design_mesh import write_design_mesh
from ..geometry.cad.outline import only_body
from ..geometry.cad.step_prism import write_prism
from ..geometry.cad.step_section import write_section

_FORMATS = (".csv", *CARRIERS)
_IN_TIME = ("transient", "initial")
"""Keys of heat that a steady state has no use for."""


@dataclass(frozen=True)
class Shaped:
    """A design of a body.

    Attributes
    ----------
    case : Case
        The steady analysis that it comes from.
    body : str
    design : Design
    """

    case: Case
    body: str
    design: Design


def check_format(path: Path) -> None:
    """Raise a `CaseError` if the ending of a file names no format of designs."""
    if path.suffix not in _FORMATS:
        raise CaseError(f"-o {path}: unknown ending; one of: {', '.join(_FORMATS)}")


def steady_case(source: Case | str | Path, overrides: tuple[str, ...] = ()) -> Case:
    """The steady analysis of a case, of faces as they are drawn, whatever analysis it names.

    Raises
    ------
    CaseError
        If it is wrong, or there can be no steady state.
    """
    case = source if isinstance(source, Case) else load(source, overrides)
    tables: dict[str, Any] = as_plain(case) | {"analysis": {"type": "steady"}}
    tables["geometry"] = {k: v for k, v in tables["geometry"].items() if k != "initial_shape"}
    if "heat" in tables:
        tables["heat"] = {k: v for k, v in tables["heat"].items() if k not in _IN_TIME}
    return load(tables)


def shape(
    source: Case | str | Path, body: str | None = None, overrides: tuple[str, ...] = ()
) -> Shaped:
    """The shape that one contact face needs so that there is no running-in.

    Parameters
    ----------
    source : Case, str or Path
        Or the path of a case file.
    body : str, optional
        Whose face takes the shape, body 1 by default; it need not be the one that wears.
    overrides : tuple of str
        ``KEY=VALUE`` each.

    Raises
    ------
    CaseError
        If the case is wrong, or no shape of this body lasts.
    ComputationError
        If there is no steady state.
    """
    case = steady_case(source, overrides)
    bodies = case.geometry.bodies
    body = bodies[0] if body is None else body
    if body not in bodies:
        raise CaseError(f"--body {body}: not a body of this case; one of: {', '.join(bodies)}")
    if body == bodies[1] and _passes(case):
        raise CaseError(
            f"--body {body}: it slides past under {bodies[0]}, so that no shape of it stays in the "
            f"contact; give the shape to {bodies[0]}"
        )
    from mpi4py import MPI

    from ..simulation.analyses.design import steady_design
    from ..simulation.analyses.positioning import prepare
    from ..timer import Phases

    system = prepare(case, MPI.COMM_SELF, Phases(lambda _: None))
    return Shaped(case, body, steady_design(system, bodies.index(body) + 1))


def write_shape(shaped: Shaped, path: Path) -> None:
    """Write a design; the ending of the file tells the format.

    Raises
    ------
    CaseError
        If the ending is not known, or the file cannot be written.
    """
    check_format(path)
    case, design = shaped.case, shaped.design
    if path.suffix == ".csv":
        write_table(design, path)
        return
    geometry = case.geometry
    face = geometry.contact[design.body - 1]
    mesh = only_body(case.tagged_mesh(), geometry.parts_of(shaped.body))
    if path.suffix != ".step":
        write_design_mesh(mesh, design, face, path)
    elif case.model == "3d":
        write_prism(mesh, design, face, path)
    elif case.model == "axisymmetric":
        turn = 2 * math.pi * (geometry.sector if design.body == 1 else 1.0)
        write_section(mesh, design, face, path, turn=turn)
    else:
        assert isinstance(geometry, PlaneGeometry)  # the case has been checked
        half = bool(geometry.symmetry)
        write_section(mesh, design, face, path, thick=geometry.thickness, half=half)
    add_table(design, path)


def _passes(case: Case) -> bool:
    """Whether body 2 moves on under body 1; about its own axis it stays in the contact."""
    geometry = case.geometry
    return case.model != "axisymmetric" and not geometry.slides_across
