"""Command line: dispatch of commands, and conversion of errors to exit codes.

Exit codes: 0 done, 1 invalid case or command line, 2 failed computation, 130 interrupted
(computed results are kept).
"""

from __future__ import annotations

import importlib.util
import os
import sys
import time
import traceback
import warnings
from contextlib import nullcontext

from ..errors import CaseError, CaseNote, ComputationError
from ..interrupts import DeferredSignals, ForcedEnd
from . import case_commands
from .arguments import parser
from .case_commands import verify

_INTERRUPTED = 130
_OF_THE_SYSTEM = {"basix", "dolfinx", "ffcx", "gmsh", "mpi4py", "petsc4py", "ufl"}
"""Packages that `pip install` does not bring."""
_COMPUTING = {"run", "sweep", "study", "calibrate"}
_DELIVERY_TIME = 1.0  # s; launchers may drop messages written just before a failing process ends


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code."""
    with warnings.catch_warnings():
        warnings.simplefilter("default", CaseNote)
        warnings.showwarning = _note_hook(warnings.showwarning)
        try:
            chosen = parser().parse_args(arguments)
            with ForcedEnd(_INTERRUPTED) if chosen.command in _COMPUTING else nullcontext():
                return COMMANDS[chosen.command](chosen)
        except CaseError as error:
            return _report_errors(error.exit_code, *error.faults)
        except ComputationError as error:
            return _report_errors(error.exit_code, str(error))
        except ModuleNotFoundError as error:
            if _package(error) not in _OF_THE_SYSTEM:
                raise
            return _report_errors(CaseError.exit_code, _needed(error))
        except KeyboardInterrupt as error:
            return _report_errors(_INTERRUPTED, str(error) or "interrupted")
        except BrokenPipeError:
            return 0


def _package(error: ModuleNotFoundError) -> str:
    return (error.name or "").partition(".")[0]


def _needed(error: ModuleNotFoundError) -> str:
    return (
        f"the Python module {_package(error)} is not installed: dolfinx, PETSc, MPI and gmsh come "
        "from the system, by apt, conda, a container or scripts/env (README, Quick start)"
    )


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
    if importlib.util.find_spec("mpi4py") is None:
        return True
    from mpi4py import MPI

    return MPI.COMM_WORLD.rank == 0


def _launched_processes() -> int:
    return int(os.environ.get("OMPI_COMM_WORLD_SIZE", os.environ.get("PMI_SIZE", "1")))


def _run(chosen) -> int:
    """Run a case, the only command on several MPI ranks.

    Case and computation errors are raised on all ranks; any other error aborts all ranks.
    """
    began = time.perf_counter()
    with DeferredSignals():  # some libraries print a traceback where their import is interrupted
        from .batch.computing import start_petsc

        start_petsc()

        from mpi4py import MPI

        from .session import run_session

    comm = MPI.COMM_WORLD
    try:
        return run_session(chosen, comm, time.perf_counter() - began)
    except (CaseError, ComputationError, ModuleNotFoundError):
        raise
    except Exception:
        traceback.print_exc()
        if comm.size > 1:
            comm.Abort(ComputationError.exit_code)
        return ComputationError.exit_code


def _sweep(chosen) -> int:
    from .sweeping import run_sweep

    return _batch(chosen, run_sweep)


def _study(chosen) -> int:
    from .study.command import run_study

    return _batch(chosen, run_study)


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
    return run(chosen)


def _shape(chosen) -> int:
    if _launched_processes() > 1:
        raise CaseError("shape: runs in one process; start it without mpirun")
    return case_commands.shape(chosen)


COMMANDS = {
    "run": _run,
    "sweep": _sweep,
    "study": _study,
    "calibrate": _calibrate,
    "cases": case_commands.cases,
    "init": case_commands.init,
    "validate": case_commands.validate,
    "mesh": case_commands.mesh,
    "shape": _shape,
    "verify": verify,
    "plot": case_commands.plot,
    "animate": case_commands.animate,
    "report": case_commands.report,
    "schema": case_commands.schema,
    "completion": case_commands.completion,
}
