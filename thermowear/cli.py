"""The command line: words to calls, errors to exit codes, nothing else.

Exit codes: 0 done, 1 the case or the command line is wrong, 2 the computation failed,
130 interrupted (what was computed is kept).
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import time
import traceback
import warnings
from pathlib import Path

from . import __version__, load
from .errors import CaseError, CaseNote, ComputationError

_INTERRUPTED = 130
_HEARD = 1.0  # s; a launcher may drop what a process said just before it ended with an error


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code."""
    with warnings.catch_warnings():
        warnings.simplefilter("default", CaseNote)
        warnings.showwarning = _shown(warnings.showwarning)
        return _main(arguments)


def _main(arguments: list[str] | None) -> int:
    try:
        chosen = _parser().parse_args(arguments)
        return chosen.command(chosen)
    except CaseError as error:
        return _complain(error.exit_code, *error.faults)
    except ComputationError as error:
        return _complain(error.exit_code, str(error))
    except KeyboardInterrupt as error:
        return _complain(_INTERRUPTED, str(error) or "interrupted")
    except BrokenPipeError:
        return 0


def _shown(otherwise):
    """A way to show warnings: what is odd about a case as a note, all else as before."""

    def show(message, category, *where) -> None:
        if issubclass(category, CaseNote):
            print(f"note: {_printable(str(message))}", file=sys.stderr, flush=True)
        else:
            otherwise(message, category, *where)

    return show


def _printable(line: str) -> str:
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in line)


def _complain(code: int, *lines: str) -> int:
    for line in lines if _speaks() else ():
        print(f"error: {_printable(line)}", file=sys.stderr, flush=True)
    if _launched_processes() > 1:
        time.sleep(_HEARD)
    return code


def _speaks() -> bool:
    """Whether this process is the one of a parallel run that reports errors.

    MPI is started if a launcher began several processes: its end then waits for all of them.
    Without it, a silent rank that ends first makes the launcher stop the one about to speak.
    """
    if "mpi4py.MPI" not in sys.modules and _launched_processes() == 1:
        return True
    from mpi4py import MPI

    return MPI.COMM_WORLD.rank == 0


def _launched_processes() -> int:
    return int(os.environ.get("OMPI_COMM_WORLD_SIZE", os.environ.get("PMI_SIZE", "1")))


class _Parser(argparse.ArgumentParser):
    def error(self, message: str):
        raise CaseError(f"{message} (see {self.prog} --help)")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="thermowear", description="Thermo-mechanical sliding wear of two bodies.")
    parser.add_argument("--version", action="version", version=f"thermowear {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)

    run = _command(commands, "run", _run, "compute a case")
    _add_case(run)
    run.add_argument("-o", "--output", metavar="DIR", type=Path, help="default: results/<case>")
    existing = run.add_mutually_exclusive_group()
    existing.add_argument("--overwrite", action="store_true", help="replace results that are there")
    existing.add_argument(
        "--resume", action="store_true", help="go on with the run that was stopped there"
    )
    run.add_argument("--no-pictures", dest="pictures", action="store_false")
    run.add_argument(
        "--accuracy",
        action="store_true",
        help="repeat the case one degree coarser and finer, and print all three side by side",
    )

    sweep = _command(commands, "sweep", _sweep, "compute all combinations of values of keys")
    _add_case(sweep)
    sweep.add_argument(
        "--over",
        metavar="KEY=V1,V2,...",
        action="append",
        required=True,
        help="a key and its values, such as load.force='1 kN,2 kN'; may be given several times",
    )
    sweep.add_argument(
        "-o", "--output", metavar="DIR", type=Path, help="default: results/<case>-sweep"
    )
    sweep.add_argument("--overwrite", action="store_true", help="replace results that are there")
    sweep.add_argument("--no-pictures", dest="pictures", action="store_false")
    sweep.add_argument(
        "--processes",
        metavar="N",
        type=_positive,
        help="for variants that share no factors; default: as many as there are cores",
    )

    _command(commands, "cases", _cases, "list the starter cases")

    init = _command(commands, "init", _init, "write a starter case to edit")
    init.add_argument("name", metavar="NAME")
    init.add_argument("-o", "--output", metavar="FILE", type=Path, help="default: NAME.toml")
    init.add_argument("--overwrite", action="store_true")

    validate = _command(commands, "validate", _validate, "check a case without computing it")
    _add_case(validate)

    mesh = _command(commands, "mesh", _mesh, "write the mesh of a case (.msh .vtu .xdmf .inp)")
    _add_case(mesh)
    mesh.add_argument("-o", "--output", metavar="FILE", type=Path, required=True)
    mesh.add_argument("--overwrite", action="store_true")

    shape = _command(commands, "shape", _shape, "write the steady worn shape of a contact face")
    _add_case(shape)
    shape.add_argument("-o", "--output", metavar="FILE", type=Path, required=True)
    shape.add_argument("--body", metavar="NAME", help="whose face; default: the held body's")
    shape.add_argument("--overwrite", action="store_true")

    verify = _command(commands, "verify", _verify, "hold the program against known solutions")
    verify.add_argument("ids", metavar="ID", nargs="*", help="default: all but the slow ones")
    verify.add_argument(
        "--slow", action="store_true", help="with those that take more than two minutes"
    )
    verify.add_argument("--json", action="store_true", help="print a list of the checks")

    plot = _command(commands, "plot", _plot, "draw the pictures of a results folder again")
    plot.add_argument("folder", metavar="DIR", type=Path)

    animate = _command(commands, "animate", _animate, "draw a run that has kept analysis.frames")
    animate.add_argument("folder", metavar="DIR", type=Path)
    animate.add_argument(
        "-o", "--output", metavar="FILE", type=Path, help=".gif or .mp4; default: DIR/animation.gif"
    )
    animate.add_argument("--fps", metavar="N", type=_rate, default=8.0, help="frames a second")

    report = _command(commands, "report", _report, "write report.html of a results folder")
    report.add_argument("folder", metavar="DIR", type=Path)
    return parser


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise ValueError
    return number


def _rate(text: str) -> float:
    number = float(text)
    if not 0.1 <= number <= 50:
        raise ValueError
    return number


def _command(commands, name: str, function, text: str) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
    command.set_defaults(command=function)
    return command


def _add_case(command: argparse.ArgumentParser) -> None:
    command.add_argument("case", metavar="CASE", type=Path)
    command.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        dest="overrides",
        help="change a key, such as mesh.degree=6",
    )


def _cases(_) -> int:
    from .case.starters import starters

    for name, title in starters().items():
        print(f"{name:32} {title}")
    return 0


def _init(chosen) -> int:
    from .case.starters import starter_files, starter_text

    path = chosen.output or Path(f"{chosen.name}.toml")
    files = {path: starter_text(chosen.name).encode()}
    files |= {path.parent / name: data for name, data in starter_files(chosen.name).items()}
    for file in files:
        _guard(file, chosen.overwrite)
    for file, data in files.items():
        try:
            file.write_bytes(data)
        except OSError as error:
            raise CaseError(f"{file}: cannot be written: {error.strerror}") from None
    print(f"wrote {' and '.join(map(str, files))}; next: python3 -m thermowear run {path}")
    return 0


def _validate(chosen) -> int:
    case = load(chosen.case, tuple(chosen.overrides))
    about = [f"{case.analysis.type} analysis", case.geometry.type, case.model]
    if case.geometry.from_file:
        from .geometry.mesh_checks import described, whole_bodies

        about += described(whole_bodies(case.tagged_mesh(), case.geometry))
    if case.geometry.initial_shape is not None:
        from .workers import start_petsc

        start_petsc()
        from mpi4py import MPI

        from .simulation.building import check_contact_points

        check_contact_points(case, MPI.COMM_SELF)
        about.append(f"initial shape {case.geometry.initial_shape}")
    print(f"{chosen.case}: ok ({', '.join(about)})")
    return 0


def _mesh(chosen) -> int:
    from .geometry.export import check_ending, write_mesh

    check_ending(chosen.output)
    case = load(chosen.case, tuple(chosen.overrides))
    _guard(chosen.output, chosen.overwrite)
    mesh = case.tagged_mesh()
    write_mesh(mesh, chosen.output)
    print(f"wrote {chosen.output}: {len(mesh.cells)} cells, {len(mesh.points)} points")
    return 0


def _shape(chosen) -> int:
    if _launched_processes() > 1:
        raise CaseError("shape: runs in one process; start it without mpirun")
    from .shaping import check_format, shape, write_shape
    from .workers import start_petsc

    check_format(chosen.output)
    start_petsc()
    _guard(chosen.output, chosen.overwrite)
    shaped = shape(chosen.case, chosen.body, tuple(chosen.overrides))
    write_shape(shaped, chosen.output)
    deepest = 1e6 * shaped.design.depth.max()
    print(f"wrote {chosen.output}: face of {shaped.body}, up to {deepest:.4g} µm to be taken off")
    return 0


def _guard(path: Path, overwrite: bool) -> None:
    if os.path.exists(path) and not overwrite:  # unlike Path.exists, no error at odd names
        raise CaseError(f"{path}: exists; use --overwrite or another name")


def _plot(chosen) -> int:
    from .output.pictures import make_pictures
    from .output.sweep import draw_sweep, is_sweep

    try:
        draw = draw_sweep if is_sweep(chosen.folder) else make_pictures
        problems = draw(chosen.folder)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    for problem in problems:
        print(f"note: {problem}", file=sys.stderr)
    return 0


def _animate(chosen) -> int:
    from .output.pictures import make_animation

    path = chosen.output or chosen.folder / "animation.gif"
    try:
        make_animation(chosen.folder, path, chosen.fps)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    print(f"wrote {path}")
    return 0


def _report(chosen) -> int:
    from .output.report import write_report

    print(f"wrote {write_report(chosen.folder)}")
    return 0


def _verify(chosen) -> int:
    from .output.console import Terminal, print_checks
    from .verification import CASES, SLOW, all_checks

    unknown = [name for name in chosen.ids if name not in CASES]
    if unknown:
        raise CaseError(f"verify {unknown[0]}: no such case; one of: {', '.join(CASES)}")
    left_out = [] if chosen.ids or chosen.slow else [name for name in CASES if name in SLOW]
    names = chosen.ids or [name for name in CASES if name not in left_out]
    checks = [check for name in names for check in all_checks(name, CASES[name])]
    if chosen.json:
        print(json.dumps([check.as_row() for check in checks], indent=2, ensure_ascii=False))
    else:
        print_checks(Terminal(highlight=False), checks)
    if left_out:
        print(
            f"note: left out as slow: {', '.join(left_out)} (--slow, or by name)", file=sys.stderr
        )
    return 0 if all(check.passed for check in checks) else ComputationError.exit_code


def _run(chosen) -> int:
    """The one command that runs on many ranks: an error anywhere ends all of them.

    Errors of the case and of the computation are raised on all ranks alike.
    """
    began = time.perf_counter()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    from .workers import start_petsc

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
    if _launched_processes() > 1:
        raise CaseError("sweep: starts its own processes (--processes N); start it without mpirun")
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    from .sweeping import run_sweep

    return run_sweep(chosen)
