"""Commands beside run and the batches: starters, checks, meshes, schema, pictures, verification."""

from __future__ import annotations

import json
import os
import sys
import warnings
from pathlib import Path

from .. import load
from ..case.tables.schema import Case
from ..errors import CaseError, ComputationError, RunNote
from .arguments import parser


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


def plot(chosen) -> int:
    """Draw the pictures of a results folder again."""
    from ..output.calibration import draw_calibration, is_calibration
    from ..output.pictures import make_pictures
    from ..output.study import draw_study, is_study
    from ..output.sweep import draw_sweep, is_sweep

    kinds = {is_sweep: draw_sweep, is_calibration: draw_calibration, is_study: draw_study}
    try:
        draw = next((draw for is_it, draw in kinds.items() if is_it(chosen.folder)), make_pictures)
        problems = draw(chosen.folder)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    for problem in problems:
        print(f"note: {problem}", file=sys.stderr)
    return 0


def animate(chosen) -> int:
    """Write an animation of a results folder."""
    from ..output.pictures import make_animation

    path = chosen.output or chosen.folder / "animation.gif"
    try:
        make_animation(chosen.folder, path, chosen.fps)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    print(f"wrote {path}")
    return 0


def report(chosen) -> int:
    """Write the report of a results folder."""
    from ..output.calibration import is_calibration, write_calibration_report
    from ..output.report import write_report
    from ..output.study import is_study, write_study_report

    kinds = {is_calibration: write_calibration_report, is_study: write_study_report}
    write = next((write for is_it, write in kinds.items() if is_it(chosen.folder)), write_report)
    print(f"wrote {write(chosen.folder)}")
    return 0


def verify(chosen) -> int:
    """Compare the program with reference solutions."""
    from ..output.console import print_checks
    from ..output.progress import Terminal
    from ..verification import CASES, SLOW, all_checks

    unknown = [name for name in chosen.ids if name not in CASES]
    if unknown:
        raise CaseError(f"verify {unknown[0]}: unknown case; one of: {', '.join(CASES)}")
    left_out = [] if chosen.ids or chosen.slow else [name for name in CASES if name in SLOW]
    names = chosen.ids or [name for name in CASES if name not in left_out]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RunNote)  # checks show what notes would warn of
        checks = [check for name in names for check in all_checks(name, CASES[name])]
    if chosen.json:
        print(json.dumps([check.as_row() for check in checks], indent=2, ensure_ascii=False))
    else:
        print_checks(Terminal(), checks)
    if left_out:
        print(
            f"note: slow cases not computed: {', '.join(left_out)} (use --slow or their names)",
            file=sys.stderr,
        )
    return 0 if all(check.passed for check in checks) else ComputationError.exit_code


def schema(chosen) -> int:
    """Write the JSON schema of case files."""
    from .schema import case_schema

    text = json.dumps(case_schema(), ensure_ascii=False, indent=1)
    if chosen.output is None:
        print(text)
        return 0
    check_absent(chosen.output, chosen.overwrite)
    try:
        chosen.output.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise CaseError(f"{chosen.output}: cannot be written: {error.strerror}") from None
    print(f"wrote {chosen.output}")
    return 0


def completion(chosen) -> int:
    """Print the completion of commands and options for a shell."""
    try:
        import shtab
    except ImportError:
        raise CaseError("completion: needs the Python package shtab") from None
    sys.stdout.write(shtab.complete(parser(), chosen.shell, preamble=_preamble()))
    return 0


def _preamble() -> dict[str, str]:
    """Functions that complete names of starters and of verification cases in bash."""
    from ..case.starters import starters
    from ..verification import CASES

    line_ends = "\\n"
    lists = {"starters": [*starters()], "checks": [*CASES]}
    functions = (  # shtab splits words at ends of lines only
        f"_thermowear_{name}() {{ compgen -W $'{line_ends.join(words)}' -- \"$1\"; }}\n"
        for name, words in lists.items()
    )
    return {"bash": "".join(functions)}
