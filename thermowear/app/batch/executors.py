"""Executors of batches: processes of this machine, MPI ranks, or workers of Dask."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ...errors import CaseError
from .pool import ProcessPool

Kind = Literal["processes", "mpi", "dask"]
_START = 60
"""Longest wait for the workers of Dask [s]."""
_WORTH = 50
"""Number of tasks that are worth the start of one more process, although they share factors."""


@dataclass(frozen=True)
class Workers:
    """Workers that a batch is computed by.

    Attributes
    ----------
    executor : Executor or None
        None computes in this process.
    count : int
        Number of workers.
    """

    executor: Executor | None
    count: int = 1


class Crew:
    """Workers of a command, which are started when they are needed.

    Attributes
    ----------
    serves : bool
        True on an MPI rank that only computes for the first one, and has done so.
    """

    def __init__(self, stack: ExitStack, choice: Choice, ranks: Workers | None = None):
        self._stack, self._choice, self._ranks = stack, choice, ranks
        self.serves = ranks is not None and ranks.executor is None

    def workers(self, groups: int, tasks: int) -> Workers:
        """Start the workers for a number of groups that share nothing, and of tasks in all."""
        choice, own = self._choice, max(groups, tasks // _WORTH)
        if self._ranks is not None:
            return self._ranks
        count = min(choice.processes or min(_cores(), own), tasks)
        if choice.kind == "dask":
            return self._stack.enter_context(_dask(choice.scheduler, count))
        return self._stack.enter_context(_processes(count))


@dataclass(frozen=True)
class Choice:
    """Choice of the workers.

    Attributes
    ----------
    kind : str
    processes : int or None
        Number of processes; None: of the cores, but no more than are worth their start.
    scheduler : str or None
        Address of a scheduler of Dask, or the file (`.json`) that it writes; None starts workers on
        this machine.

    Raises
    ------
    CaseError
        If they contradict each other.
    """

    kind: Kind = "processes"
    processes: int | None = None
    scheduler: str | None = None

    def __post_init__(self):
        if self.scheduler is not None and self.kind != "dask":
            raise CaseError("--scheduler: needs --executor dask")
        if self.processes is not None and (self.kind == "mpi" or self.scheduler is not None):
            where = "by mpirun" if self.kind == "mpi" else "where the scheduler runs"
            raise CaseError(f"--processes: the number of workers is chosen {where}")

    @contextmanager
    def crew(self) -> Iterator[Crew]:
        """Context manager of the workers; on MPI ranks but the first it ends when all is done."""
        with ExitStack() as stack:
            ranks = stack.enter_context(_ranks()) if self.kind == "mpi" else None
            yield Crew(stack, self, ranks)


def _cores() -> int:
    return len(os.sched_getaffinity(0))


@contextmanager
def _processes(count: int) -> Iterator[Workers]:
    if count <= 1:
        yield Workers(None)
        return
    with ProcessPool(count) as pool:
        yield Workers(pool, count)


@contextmanager
def _ranks() -> Iterator[Workers]:
    """Ranks that ``mpirun`` has started: the first distributes, the others compute."""
    from .computing import start_petsc

    start_petsc()
    from mpi4py import MPI
    from mpi4py.futures import MPICommExecutor

    if MPI.COMM_WORLD.size == 1:
        raise CaseError(
            "--executor mpi: found one process; start it by mpirun -n N python3 -m thermowear …"
        )
    with MPICommExecutor(MPI.COMM_WORLD, root=0) as ranks:
        executor: Any = ranks  # None on all ranks but the first
        yield Workers(executor, MPI.COMM_WORLD.size - 1)


@contextmanager
def _dask(scheduler: str | None, count: int) -> Iterator[Workers]:
    """Workers of a scheduler of Dask, or of this machine; each computes one case at a time."""
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise CaseError(
            "--executor dask: needs the package distributed (Debian: python3-distributed)"
        ) from None
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with ExitStack() as stack:
        where: dict[str, Any] = {"address": scheduler}
        if scheduler is None:
            own = {"n_workers": count, "threads_per_worker": 1, "dashboard_address": None}
            where = {"address": stack.enter_context(LocalCluster(**own))}
        elif scheduler.endswith(".json"):
            where = {"scheduler_file": _written(Path(scheduler))}
        try:
            client = stack.enter_context(Client(**where, timeout=_START))
            client.wait_for_workers(1, timeout=_START)
        except (OSError, TimeoutError) as error:
            raise CaseError(f"--scheduler {scheduler}: no workers there: {error}") from None
        executor = stack.enter_context(client.get_executor())
        yield Workers(executor, len(client.nthreads()))


def _written(file: Path) -> str:
    """Name of a scheduler's file, once it is there: Dask would wait for it without end."""
    end = time.monotonic() + _START
    while not file.exists():
        if time.monotonic() > end:
            raise CaseError(f"--scheduler {file}: no such file after {_START} s")
        time.sleep(0.1)
    return str(file)
