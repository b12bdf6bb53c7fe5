"""Commands on a case file: starters, checks, meshes, worn shapes."""

from __future__ import annotations

import os
from pathlib import Path

from .. import load
from ..case.tables.schema import Case
from ..errors import CaseError


def cases(_) -> int:
    """List the starter cases."""
    from ..case.starters import starters

    for name, title in starters().items():
        print(f"{name:32} {title}")
    return 0


def init(chosen) -> int:
    """Write a starter case with the files it needs."""
    from ..case.starters import command_for, starter_files, starter_text

    path = chosen.output or Path(f"{chosen.name}.toml")
    files = {path: starter_text(chosen.name).encode()}
    files |= {path.parent / name: data for name, data in starter_files(chosen.name).items()}
    for file in files:
        check_absent(file, chosen.overwrite)
    for file, data in files.items():
        try:
            file.write_bytes(data)
        except OSError as error:
            raise CaseError(f"{file}: cannot be written: {error.strerror}") from None
    made_for = command_for(starter_text(chosen.name))
    print(f"wrote {' and '.join(map(str, files))}; next: python3 -m thermowear {made_for} {path}")
    return 0


def validate(chosen) -> int:
    """Check a case without computing it."""
    case = load(chosen.case, tuple(chosen.overrides))
    properties = [f"{case.analysis.type} analysis", case.geometry.type, case.model]
    simple, read = isinstance(case, Case), case.geometry.from_file
    if read or (case.model != "3d" and case.mesh.accuracy is None):
        mesh = case.tagged_mesh()
        if read:
            from ..geometry.checks.mesh_checks import described, whole_bodies
            from ..geometry.checks.pair_checks import has_plane_faces

            whole = whole_bodies(mesh, case.geometry)
            properties += described(whole)
            simple = isinstance(case, Case) and has_plane_faces(whole, case)
    carries = case.heat is not None and case.heat.advection != "none"
    # faces that may not meet as they should
    if not simple or carries or case.analysis.cyclic or case.initial_shapes:
        from .batch.computing import start_petsc

        start_petsc()
        from mpi4py import MPI

        from ..simulation.analyses.run import check
        from ..simulation.from_case import analysis_of, model_of

        check(model_of(case), analysis_of(case), MPI.COMM_SELF)
        properties += [f"initial shape {shape}" for shape in case.initial_shapes]
    if case.calibrate is not None:
        from .calibration.calibrate import described_data

        properties += described_data(case)
    print(f"{chosen.case}: ok ({', '.join(properties)})")
    return 0


def mesh(chosen) -> int:
    """Write the mesh of a case, or its picture."""
    from ..geometry.checks.mesh_checks import whole_bodies
    from ..geometry.mesh.mixed import count_cells
    from ..geometry.reading.export import check_ending, write_mesh
    from ..output.pictures import make_mesh_picture

    is_picture = chosen.output.suffix == ".png"
    if not is_picture:
        check_ending(chosen.output)
    case = load(chosen.case, tuple(chosen.overrides))
    if is_picture and case.model != "3d":
        raise CaseError(f"-o {chosen.output}: pictures of meshes require a 3d model")
    check_absent(chosen.output, chosen.overwrite)
    if case.mesh.accuracy is not None:
        from ..simulation.from_case import with_accurate_mesh
        from .batch.computing import start_petsc

        start_petsc()
        case = with_accurate_mesh(case)
    mesh = case.tagged_mesh()
    if is_picture:
        make_mesh_picture(whole_bodies(mesh, case.geometry), chosen.output)
    else:
        write_mesh(mesh, chosen.output)
    print(f"wrote {chosen.output}: {count_cells(mesh)} cells, {len(mesh.points)} points")
    return 0


def shape(chosen) -> int:
    """Write the steady worn shape of a face."""
    from .batch.computing import start_petsc
    from .shaping import check_format, shape, write_shape

    check_format(chosen.output)
    start_petsc()
    check_absent(chosen.output, chosen.overwrite)
    shaped = shape(chosen.case, chosen.body, tuple(chosen.overrides), chosen.face)
    write_shape(shaped, chosen.output)
    deepest = 1e6 * shaped.design.depth.max()
    print(
        f"wrote {chosen.output}: face of {shaped.body.name}, up to {deepest:.4g} µm to be removed"
    )
    return 0


def check_absent(path: Path, overwrite: bool) -> None:
    """Reject a file that exists unless it may be replaced.

    Raises
    ------
    CaseError
    """
    if os.path.exists(path) and not overwrite:  # Path.exists raises an error for invalid names
        raise CaseError(f"{path}: exists; use --overwrite or another name")
