"""A thousand variants: killed and resumed, on MPI ranks, on workers of Dask; memory over time.

The table of each sweep is compared with that of one that nothing came in between of:

    THERMOWEAR_WITH=studies scripts/env python3 -m tests.benchmarks.many_variants [--variants 1000]

A quarter of the variants has no equilibrium: their rows have a message. The memory is that of the
process that distributes, and of the largest worker, sampled while the sweep runs.
"""

from __future__ import annotations

import argparse
import csv
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from thermowear.output.variants.folder import JOURNAL

CASE = Path(__file__).parents[2] / "demos" / "pivoted_block.toml"
COARSE = ("--set", "mesh.degree=2", "--set", "mesh.elements=3", "--no-pictures")
LOCKED = ("--set", 'motion.velocity="50 mm/s"')
_TINY = 1e-9
_EVERY = 0.2  # s


def words(variants: int, folder: Path) -> list[str]:
    """Arguments of the sweep: loads and frictions, one of them without equilibrium."""
    loads = ",".join(f"{1 + 0.001 * k:.3f} kN" for k in range(variants // 4))
    over = ["--over", "contact.friction=0.1,0.15,0.2,9.0", "--over", f"load.force={loads}"]
    return ["sweep", str(CASE), *COARSE, *LOCKED, *over, "-o", str(folder)]


def table(folder: Path) -> list[dict[str, str]]:
    """Rows of a sweep."""
    with (folder / "sweep.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def difference(one: Sequence[dict[str, str]], other: Sequence[dict[str, str]]) -> float:
    """Largest relative difference of two tables, apart from the times; infinite for other words."""
    largest = 0.0
    for a, b in zip(one, other, strict=True):
        for name in a.keys() - {"seconds"}:
            try:
                x, y = float(a[name]), float(b[name])
            except ValueError:
                largest = max(largest, 0.0 if a[name] == b[name] else np.inf)
                continue
            if not (np.isnan(x) and np.isnan(y)) and abs(x - y) > _TINY * ("error" in name):
                largest = max(largest, abs(x - y) / max(abs(x), abs(y)))
    return largest


class Memory(threading.Thread):
    """Resident memory of a process and of its largest descendant over time [MB]."""

    def __init__(self, pid: int):
        super().__init__(daemon=True)
        self.pid, self.samples = pid, list[tuple[float, float, float]]()
        self.start()

    def run(self) -> None:
        began = time.monotonic()
        while (own := _resident(self.pid)) is not None:
            others = [_resident(pid) or 0.0 for pid in _descendants(self.pid)]
            self.samples.append((time.monotonic() - began, own, max(others, default=0.0)))
            time.sleep(_EVERY)

    def text(self) -> str:
        """Memory after a fifth of the time, in the middle and at the end."""
        if len(self.samples) < 10:
            return "too short to tell"
        found = [self.samples[int(part * (len(self.samples) - 1))] for part in (0.2, 0.5, 0.95)]
        return ", ".join(f"{own:.0f} + {worker:.0f} MB at {t:.0f} s" for t, own, worker in found)


def _resident(pid: int) -> float | None:
    try:
        text = Path(f"/proc/{pid}/statm").read_text()
    except OSError:
        return None
    pages = int(text.split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6 if pages else None


def _descendants(pid: int) -> list[int]:
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return []
    return [one for child in map(int, children) for one in (child, *_descendants(child))]


def run(arguments: Sequence[str], launcher: Sequence[str] = ()) -> tuple[float, str]:
    """Run a sweep to its end; returns its wall time and memory."""
    began = time.perf_counter()
    command = [*launcher, sys.executable, "-m", "thermowear", *arguments]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    memory = Memory(process.pid)
    _, said = process.communicate()
    if process.returncode not in (0, 2):
        raise RuntimeError(said.decode())
    return time.perf_counter() - began, memory.text()


def kill_after(arguments: Sequence[str], folder: Path, count: int) -> None:
    """Kill a sweep with all its workers after a number of variants."""
    command = [sys.executable, "-m", "thermowear", *arguments]
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    while process.poll() is None and _ended(folder) < count:
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _ended(folder: Path) -> int:
    path = folder / JOURNAL
    return path.read_text().count("\n") if path.is_file() else 0


def main() -> None:
    """Print times, memory and differences."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--variants", type=int, default=1000)
    count = parser.parse_args().variants
    with tempfile.TemporaryDirectory() as place:
        at = {name: Path(place) / name for name in ("whole", "killed", "dask", "mpi")}
        seconds, memory = run([*words(count, at["whole"]), "--processes", "2"])
        whole = table(at["whole"])
        failed = sum(row["status"] != "done" for row in whole)
        print(f"{len(whole)} variants, {failed} failed: {seconds:.1f} s; memory {memory}")
        killed = [*words(count, at["killed"]), "--processes", "2", "--resume"]
        kill_after(killed, at["killed"], count // 4)
        first = _ended(at["killed"])
        kill_after(killed, at["killed"], count // 2)
        second = _ended(at["killed"])
        run(killed)
        change = difference(whole, table(at["killed"]))
        print(f"killed after {first} and {second}, resumed: largest difference {change:.1e}")
        for name, launcher, options in (
            ("dask", (), ("--executor", "dask", "--processes", "4")),
            ("mpi", ("mpirun", "-n", "3"), ("--executor", "mpi")),
        ):
            seconds, memory = run([*words(count, at[name]), *options], launcher)
            change = difference(whole, table(at[name]))
            print(f"{name}: {seconds:.1f} s; memory {memory}; largest difference {change:.1e}")


if __name__ == "__main__":
    main()
