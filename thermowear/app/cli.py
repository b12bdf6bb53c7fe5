"""Command line: dispatch of commands, and conversion of errors to exit codes.

Exit codes: 0 done, 1 invalid case or command line, 2 failed computation, 130 interrupted
(computed results are kept).
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time
import traceback
import warnings
from pathlib import Path

from .. import load
from ..errors import CaseError, CaseNote, ComputationError
from ..interrupts import DeferredSignals
from .arguments import parser

_INTERRUPTED = 130
_DELIVERY_TIME = 1.0  # s; launchers may drop messages written just before a failing process ends


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code."""
    with warnings.catch_warnings():
        warnings.simplefilter("default", CaseNote)
        warnings.showwarning = _note_hook(warnings.showwarning)
        try:
            chosen = parser().parse_args(arguments)
            return _COMMANDS[chosen.command](chosen)
        except CaseError as error:
            return _report_errors(error.exit_code, *error.faults)
        except ComputationError as error:
            return _report_errors(error.exit_code, str(error))
        except KeyboardInterrupt as error:
            return _report_errors(_INTERRUPTED, str(error) or "interrupted")
        except BrokenPipeError:
            return 0


def _note_hook(otherwise):
    """Hook for warnings that prints a `CaseNote` as a note and leaves others unchanged."""

    def show(message, category, *where) -> None:
        if issubclass(category, CaseNote):
            print(f"note: {_printable(str(message))}", file=sys.stderr, flush=True)
        else:
            otherwise(message, category, *where)

    return show


def _printable(line: str) -> str:
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in line)


def _report_errors(code: int, *lines: str) -> int:
    for line in lines if _is_reporting_rank() else ():
        print(f"error: {_printable(line)}", file=sys.stderr, flush=True)
    if _launched_processes() > 1:
        time.sleep(_DELIVERY_TIME)
    return code


def _is_reporting_rank() -> bool:
    """True if this process of a parallel run reports errors.

    MPI is initialised if a launcher started several processes, so that finalisation waits for all
    of them. Otherwise a silent rank that ends first could make the launcher kill the one that
    reports.
    """
    if "mpi4py.MPI" not in sys.modules and _launched_processes() == 1:
        return True
    from mpi4py import MPI

    return MPI.COMM_WORLD.rank == 0


def _launched_processes() -> int:
    return int(os.environ.get("OMPI_COMM_WORLD_SIZE", os.environ.get("PMI_SIZE", "1")))


def _cases(_) -> int:
    from ..case.starters import starters

    for name, title in starters().items():
        print(f"{name:32} {title}")
    return 0


def _init(chosen) -> int:
    from ..case.starters import starter_files, starter_text

    path = chosen.output or Path(f"{chosen.name}.toml")
    files = {path: starter_text(chosen.name).encode()}
    files |= {path.parent / name: data for name, data in starter_files(chosen.name).items()}
    for file in files:
        _check_absent(file, chosen.overwrite)
    for file, data in files.items():
        try:
            file.write_bytes(data)
        except OSError as error:
            raise CaseError(f"{file}: cannot be written: {error.strerror}") from None
    print(f"wrote {' and '.join(map(str, files))}; next: python3 -m thermowear run {path}")
    return 0


def _validate(chosen) -> int:
    case = load(chosen.case, tuple(chosen.overrides))
    properties = [f"{case.analysis.type} analysis", case.geometry.type, case.model]
    if case.geometry.from_file:
        from ..geometry.checks.mesh_checks import described, whole_bodies

        properties += described(whole_bodies(case.tagged_mesh(), case.geometry))
    if case.initial_shapes:
        from .batch.computing import start_petsc

        start_petsc()
        from mpi4py import MPI

        from ..simulation.from_case import model_of
        from ..simulation.system.building import check_contact_points

        check_contact_points(model_of(case), MPI.COMM_SELF)
        properties += [f"initial shape {shape}" for shape in case.initial_shapes]
    print(f"{chosen.case}: ok ({', '.join(properties)})")
    return 0


def _mesh(chosen) -> int:
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
    _check_absent(chosen.output, chosen.overwrite)
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


def _shape(chosen) -> int:
    if _launched_processes() > 1:
        raise CaseError("shape: runs in one process; start it without mpirun")
    from .batch.computing import start_petsc
    from .shaping import check_format, shape, write_shape

    check_format(chosen.output)
    start_petsc()
    _check_absent(chosen.output, chosen.overwrite)
    shaped = shape(chosen.case, chosen.body, tuple(chosen.overrides), chosen.face)
    write_shape(shaped, chosen.output)
    deepest = 1e6 * shaped.design.depth.max()
    print(
        f"wrote {chosen.output}: face of {shaped.body.name}, up to {deepest:.4g} µm to be removed"
    )
    return 0


def _check_absent(path: Path, overwrite: bool) -> None:
    if os.path.exists(path) and not overwrite:  # Path.exists raises an error for invalid names
        raise CaseError(f"{path}: exists; use --overwrite or another name")


def _plot(chosen) -> int:
    from ..output.calibration import draw_calibration, is_calibration
    from ..output.pictures import make_pictures
    from ..output.sweep import draw_sweep, is_sweep

    try:
        draw = draw_sweep if is_sweep(chosen.folder) else make_pictures
        draw = draw_calibration if is_calibration(chosen.folder) else draw
        problems = draw(chosen.folder)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    for problem in problems:
        print(f"note: {problem}", file=sys.stderr)
    return 0


def _animate(chosen) -> int:
    from ..output.pictures import make_animation

    path = chosen.output or chosen.folder / "animation.gif"
    try:
        make_animation(chosen.folder, path, chosen.fps)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    print(f"wrote {path}")
    return 0


def _report(chosen) -> int:
    from ..output.calibration import is_calibration, write_calibration_report
    from ..output.report import write_report

    write = write_calibration_report if is_calibration(chosen.folder) else write_report
    print(f"wrote {write(chosen.folder)}")
    return 0


def _verify(chosen) -> int:
    from ..output.console import Terminal, print_checks
    from ..verification import CASES, SLOW, all_checks

    unknown = [name for name in chosen.ids if name not in CASES]
    if unknown:
        raise CaseError(f"verify {unknown[0]}: unknown case; one of: {', '.join(CASES)}")
    left_out = [] if chosen.ids or chosen.slow else [name for name in CASES if name in SLOW]
    names = chosen.ids or [name for name in CASES if name not in left_out]
    checks = [check for name in names for check in all_checks(name, CASES[name])]
    if chosen.json:
        print(json.dumps([check.as_row() for check in checks], indent=2, ensure_ascii=False))
    else:
        print_checks(Terminal(highlight=False), checks)
    if left_out:
        print(
            f"note: slow cases not computed: {', '.join(left_out)} (use --slow or their names)",
            file=sys.stderr,
        )
    return 0 if all(check.passed for check in checks) else ComputationError.exit_code


def _run(chosen) -> int:
    """Run a case, the only command on several MPI ranks.

    Case and computation errors are raised on all ranks; any other error aborts all ranks.
    """
    began = time.perf_counter()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with DeferredSignals():  # some libraries print a traceback where their import is interrupted
        from .batch.computing import start_petsc

        start_petsc()

        from mpi4py import MPI

        from .session import run_session

    comm = MPI.COMM_WORLD
    try:
        return run_session(chosen, comm, time.perf_counter() - began)
    except (CaseError, ComputationError):
        raise
    except Exception:
        traceback.print_exc()
        if comm.size > 1:
            comm.Abort(ComputationError.exit_code)
        return ComputationError.exit_code


def _sweep(chosen) -> int:
    from .sweeping import run_sweep

    return _batch(chosen, run_sweep)


def _calibrate(chosen) -> int:
    from .calibration.command import run_calibration

    return _batch(chosen, run_calibration)


def _batch(chosen, run) -> int:
    """Run a command that distributes runs to workers."""
    if _launched_processes() > 1 and chosen.executor != "mpi":
        raise CaseError(
            f"{chosen.command}: starts its own processes (--processes N); start it without mpirun, "
            "or use --executor mpi"
        )
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    return run(chosen)


_ALL = (
    _run,
    _sweep,
    _calibrate,
    _cases,
    _init,
    _validate,
    _mesh,
    _shape,
    _verify,
    _plot,
    _animate,
    _report,
)
_COMMANDS = {command.__name__[1:]: command for command in _ALL}
