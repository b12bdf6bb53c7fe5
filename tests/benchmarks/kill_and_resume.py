"""Runs that are killed, or run out of disk, and go on: nothing may be lost, whatever the moment.

Runs of three analyses are killed (SIGKILL) at random moments, some of them again while they go on,
then let go on to their end. After each kill all that the folder holds is read; at the end every
number of every table is held against the run that nothing came in between of. Then runs are put on
a disk that is too small for them, and go on when there is room:

    scripts/env python3 tests/benchmarks/kill_and_resume.py [--times 20] [--seed N]

The small disks are file systems in memory, in mounts that this process has for itself: for root.
"""

import argparse
import csv
import ctypes
import json
import os
import random
import secrets
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from contextlib import suppress
from pathlib import Path

import meshio
import numpy as np

DEMOS = Path(__file__).parents[2] / "demos"
CASES = {
    "hot transient": (
        DEMOS / "disk_brake_stop.toml",
        "mesh.degree=4",
        "analysis.end_time=8 s",
        "analysis.frames=8",
    ),
    "geometry updates": (
        DEMOS / "annular_punch_deep.toml",
        "mesh.elements=4",
        "analysis.end_time=50 h",
        'analysis.output_times=["20 h"]',
        "analysis.frames=8",
    ),
    "fretting, cycle jumps": (
        DEMOS / "tube_in_support.toml",
        "mesh.elements=32",
        'analysis.jump="auto"',
        "analysis.cycles=20000",
        'analysis.output_times=["700 s"]',
        "analysis.frames=8",
    ),
}
PAUSES = ("1e-9 s", "0.5 s", "2 min")
"""Between checkpoints: after each step, now and then, only at the beginning and output times."""
TOLERANCE = 1e-12
PLENTY = 2**29
"""Bytes."""
REMOUNT, PRIVATE = 0x20, 0x44000  # of <sys/mount.h>: the same mount; it and those below, alone


def command(name, folder, *more):
    case, *overrides = CASES[name]
    chosen = [case, "-o", folder, "--no-pictures", *(f"--set={text}" for text in overrides), *more]
    return [sys.executable, "-m", "thermowear", "run", *map(str, chosen)]


def completed(name, folder, *more):
    return subprocess.run(command(name, folder, *more), capture_output=True, text=True, check=False)


def uninterrupted(name, folder):
    """How long a run takes once its folder is there [s]."""
    process = subprocess.Popen(command(name, folder), stdout=subprocess.DEVNULL)
    wait_for(folder, process)
    began = time.monotonic()
    assert process.wait() == 0
    return time.monotonic() - began


def wait_for(folder, process):
    while not (folder / "run.json").exists():
        assert process.poll() is None, f"ended with {process.returncode} before it began"
        time.sleep(0.002)


def killed(name, folder, after, *more):
    """Kill a run so many seconds after its folder is there; whether it was still running."""
    process = subprocess.Popen(
        command(name, folder, *more), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    wait_for(folder, process)
    time.sleep(after)
    process.kill()
    return process.wait() != 0


# ---- what a folder holds ----


def tables(folder):
    """All tables below a folder by name, read as anybody would: header and numbers."""
    found = {}
    for path in sorted(folder.rglob("*.csv")):
        with path.open(newline="") as file:
            header, *rows = csv.reader(file)
        assert all(len(row) == len(header) for row in rows), f"{path}: a row is cut off"
        found[str(path.relative_to(folder))] = header, np.array(rows, dtype=float)
    return found


def assert_readable(folder):
    """All that is there can be read: tables, meshes, states, words."""
    tables(folder)
    for path in folder.rglob("*.vtu"):
        assert len(meshio.read(path).points) > 0, path
    for path in folder.glob("*.json"):
        json.loads(path.read_text())
    for path in folder.glob("case.resolved.toml"):
        tomllib.loads(path.read_text())
    reached(folder)


def reached(folder):
    """Time of the checkpoint, as seen without the program [s]; None where there is none."""
    path = folder / "checkpoint.npz"
    if not path.exists():
        return None
    with np.load(path, allow_pickle=False) as file:
        arrays = dict(file)
    return json.loads(str(arrays["about"]))["time"]


def difference(folder, whole):
    """The largest between any two numbers of two folders that are to be the same, relative."""
    ours, theirs = tables(folder), tables(whole)
    names = [{str(p.relative_to(place)) for p in place.rglob("*")} for place in (folder, whole)]
    assert names[0] == names[1], f"{folder}: not the same files: {names[0] ^ names[1]}"
    worst = 0.0
    for name, (header, expected) in theirs.items():
        assert ours[name][0] == header, name
        found = ours[name][1]
        assert found.shape == expected.shape, f"{folder}/{name}: not the same rows"
        assert np.array_equal(np.isnan(found), np.isnan(expected)), name
        change = np.abs(found - expected) / np.maximum(np.abs(expected), 1e-300)
        worst = max(worst, float(np.nan_to_num(change).max(initial=0.0)))
    return worst


def gone_on(name, folder, whole):
    """Let a run go on to its end; how different its numbers are."""
    done = completed(name, folder, "--resume")
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert_readable(folder)
    return difference(folder, whole)


# ---- kill, full disk ----


def kills(name, whole, seconds, times, place, chance):
    """Kill at random moments; every other run is killed once more on its way to the end."""
    worst, hit, anew = 0.0, 0, 0
    for number in range(times):
        folder, resume = place / f"killed-{number}", ()
        pause = f"--set=analysis.checkpoint_every={chance.choice(PAUSES)}"
        for _ in range(1 + number % 2):
            hit += killed(name, folder, chance.uniform(0.0, seconds), pause, *resume)
            assert_readable(folder)
            anew += reached(folder) is None
            resume = ("--resume",)
        worst = max(worst, gone_on(name, folder, whole))
        shutil.rmtree(folder)
    print(
        f"{name}: {times} runs of {seconds:.1f} s, {hit} times killed before the end, {anew} times "
        f"before the first checkpoint; largest difference {worst:.1e}",
        flush=True,
    )
    assert worst <= TOLERANCE


def full_disks(name, whole, times, place, chance):
    """Disks with room for a part of the results."""
    needed = sum(path.stat().st_size for path in whole.rglob("*") if path.is_file())
    worst, late = 0.0, 0
    for number in range(times):
        folder = place / f"full-{number}"
        folder.mkdir()
        mount(folder, 0, int(chance.uniform(0.3, 0.9) * needed))
        done = completed(name, folder, "--set=analysis.checkpoint_every=1e-9 s")
        assert done.returncode == 2, (done.returncode, done.stderr)
        assert done.stderr.startswith("error: results cannot be written"), done.stderr
        assert done.stderr.count("\n") == 1, done.stderr
        assert_readable(folder)
        assert not list(folder.rglob("*.part"))
        late += (reached(folder) or 0.0) > 0.0
        mount(folder, REMOUNT, PLENTY)
        worst = max(worst, gone_on(name, folder, whole))
        system_call("umount", os.fsencode(folder))
    print(
        f"{name}: {times} full disks, exit code 2 each time, {late} with a checkpoint of a later "
        f"moment than the first; largest difference {worst:.1e}",
        flush=True,
    )
    assert worst <= TOLERANCE


def mount(folder, how, size):
    """A file system in memory with so many bytes."""
    system_call("mount", b"tmpfs", os.fsencode(folder), b"tmpfs", how, b"size=%d" % size)


def system_call(name, *words):
    library = ctypes.CDLL(None, use_errno=True)
    if getattr(library, name)(*words):
        raise OSError(ctypes.get_errno(), f"{name}: {os.strerror(ctypes.get_errno())}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--times", type=int, default=20, help="runs of each case that are killed")
    parser.add_argument("--disks", type=int, default=5, help="small disks of each case")
    parser.add_argument("--seed", type=int, default=secrets.randbelow(10**6))
    chosen = parser.parse_args()
    print(f"seed {chosen.seed}", flush=True)
    chance = random.Random(chosen.seed)
    if chosen.disks:
        os.unshare(os.CLONE_NEWNS)
        with suppress(OSError):  # in a changed root, which scripts/env has mounted privately
            system_call("mount", b"none", b"/", None, PRIVATE, None)
    with tempfile.TemporaryDirectory() as path:
        for name in CASES:
            place = Path(path) / name.replace(" ", "-").replace(",", "")
            place.mkdir()
            whole = place / "whole"
            seconds = uninterrupted(name, whole)
            assert_readable(whole)
            kills(name, whole, seconds, chosen.times, place, chance)
            full_disks(name, whole, chosen.disks, place, chance)


if __name__ == "__main__":
    main()
