"""Cost of a calibration: neighbouring runs in one process, against finite differences of commands.

A hot ring turning on a plate wears for 200 s; its depths, temperatures and friction torques give
the wear coefficient, the friction and the conductivity of the ring. `calibrate` takes derivatives
from runs with the same time steps, which share meshes and factors. The usual way is an optimiser
whose residuals come from a run of the program each, and whose derivatives are differences of such
runs. Start, bounds, scaling and data are the same:

    scripts/env python3 -m tests.benchmarks.calibration [--noise-free] [--coarse] [--only-calibrate]
"""

import argparse
import csv
import resource
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

import numpy as np
import tomli_w
from scipy.interpolate import PchipInterpolator
from scipy.optimize import least_squares

import thermowear as tw
from thermowear.app.calibration.calibrate import problem_of, runner
from thermowear.case import as_plain

DEMO = Path(__file__).parents[2] / "demos" / "annular_punch.toml"
TRUTH = {"k": 2e-7, "mu": 0.25, "c": 50.0}
START = {"k": 1e-7, "mu": 0.35, "c": 70.0}
BOUNDS = {"k": (1e-8, 1e-6), "mu": (0.1, 0.5), "c": (10.0, 200.0)}
KEYS = {
    "k": ("wear.punch.coefficient", "1/MPa"),
    "mu": ("contact.friction", ""),
    "c": ("bodies.punch.conductivity", "W/(m K)"),
}
DATA = {"max_wear_1": ("um", 1e-6, 20), "max_temperature": ("K", 1.0, 20),
        "friction_torque": ("N m", 1.0, 10)}  # fmt: skip
"""Measured quantities with unit, its value in SI, and number."""
SCATTER = {"max_wear_1": 0.02, "max_temperature": 0.003, "friction_torque": 0.02}
"""Relative standard deviations; that of temperatures is 1 K."""
END = 200.0


def times(number):
    return np.linspace(END / number, END, number)


def tables(coarse):
    """Case of a running-in, with the parameters to be found."""
    found = tomllib.loads(DEMO.read_text(encoding="utf-8"))
    found["analysis"] = {
        "type": "transient",
        "end_time": f"{END} s",
        "output_times": {"values": times(20).tolist(), "unit": "s"},
        "tolerance": 1e-5,
    }
    found["mesh"] |= {"degree": 4, "elements": 6} if coarse else {"degree": 6, "elements": 8}

    def with_unit(name, value):
        unit = KEYS[name][1]
        return f"{value!r} {unit}" if unit else value

    found["calibrate"] = {
        "tolerance": 1e-6,
        "parameters": {
            name: {
                "key": key,
                "start": with_unit(name, START[name]),
                "lower": with_unit(name, BOUNDS[name][0]),
                "upper": with_unit(name, BOUNDS[name][1]),
                "scale": "linear" if name == "mu" else "log",
            }
            for name, (key, _) in KEYS.items()
        },
    }
    return found


def measured(case, folder, noisy):
    """Files of measurements by a run with the true values."""
    for name, (unit, _, number) in DATA.items():
        rows = "\n".join(f"{t!r}, 1, 1" for t in map(float, times(number)))
        head = f"time [s], {name} [{unit}], deviation [{unit}]"
        (folder / f"{name}.csv").write_text(f"{head}\n{rows}\n", encoding="utf-8")
    files = {name: folder / f"{name}.csv" for name in DATA}
    problem = problem_of(case, files)
    exact = problem.model(runner()).predict(np.array(list(TRUTH.values())))
    random = np.random.default_rng(5)
    for one in problem.measurements:
        values, exact = np.split(exact, [len(one.values)])
        unit, size, number = DATA[one.label]
        deviations = SCATTER[one.label] * np.abs(values)
        data = values + noisy * deviations * random.normal(size=number)
        rows = "\n".join(
            ", ".join(repr(float(v)) for v in row)
            for row in zip(times(number), data / size, deviations / size, strict=True)
        )
        head = f"time [s], {one.label} [{unit}], deviation [{unit}]"
        files[one.label].write_text(f"{head}\n{rows}\n", encoding="utf-8")
    return files


class Commands:
    """Residuals by the command ``run``, a process each."""

    def __init__(self, case, files, folder):
        self.runs, self._folder = 0, folder
        self._measurements = problem_of(case, files).measurements
        self._file = folder / "case.toml"
        plain = {key: table for key, table in as_plain(case).items() if key != "calibrate"}
        self._file.write_text(tomli_w.dumps(plain), encoding="utf-8")

    def residuals(self, internal):
        """Weighted residuals of all measurements."""
        out, overrides = self._folder / "run", []
        for (key, unit), value in zip(KEYS.values(), values_of(internal), strict=True):
            text = f'"{float(value)!r} {unit}"' if unit else repr(float(value))
            overrides += ["--set", f"{key}={text}"]
        words = [sys.executable, "-m", "thermowear", "run", str(self._file), "-o", str(out)]
        words += ["--no-pictures", "--overwrite", *overrides]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        self.runs += 1
        with (out / "history.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        found = []
        for one in self._measurements:
            column = one.reading.quantity.header
            x, y = (np.array([float(row[c]) for row in rows]) for c in ("time_s", column))
            predicted = PchipInterpolator(x, y)(one.reading.at["time"])
            found.append((predicted - one.values) / one.deviations)
        return np.concatenate(found)


def children():
    """Processor time of the commands so far [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def internal_of(named):
    return np.array([named[n] if n == "mu" else np.log(named[n]) for n in KEYS])


def values_of(internal):
    return [z if n == "mu" else np.exp(z) for n, z in zip(KEYS, internal, strict=True)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--noise-free", action="store_true")
    parser.add_argument("--coarse", action="store_true", help="a small mesh")
    parser.add_argument("--only-calibrate", action="store_true")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case = tw.load(tables(chosen.coarse))
        files = measured(case, folder, not chosen.noise_free)
        began, used = time.perf_counter(), time.process_time()
        found = tw.calibrate(case, files)
        one, used = time.perf_counter() - began, time.process_time() - used
        print(f"calibrate: {one:.1f} s ({used:.1f} s of CPU), {found.runs} runs, {found.values}")
        errors = {k: f"{e:.2g}" for k, e in found.standard_errors.items()}
        print(f"    standard errors {errors}, reduced chi² {found.fit.reduced_chi2:.3g}")
        print("", found.fit.message, *found.notes(), sep="\n    ")
        if chosen.only_calibrate:
            return
        commands = Commands(case, files, folder)
        lower, upper = (internal_of({n: BOUNDS[n][k] for n in KEYS}) for k in (0, 1))
        began, before = time.perf_counter(), children()
        other = least_squares(
            commands.residuals,
            internal_of(START),
            bounds=(lower, upper),
            diff_step=1e-4,
            ftol=1e-12,
            xtol=1e-8,
            gtol=None,
        )
        two, cpu = time.perf_counter() - began, children() - before
        values = np.array(values_of(other.x))
        difference = np.abs(np.array(list(found.values.values())) / values - 1)
        print(f"separate runs: {two:.1f} s ({cpu:.1f} s of CPU), {commands.runs} runs, {values}")
        print(f"    {other.message}, {other.nfev} evaluations")
        print(f"ratio {two / one:.1f} (CPU {cpu / used:.1f}), relative differences {difference}")


if __name__ == "__main__":
    main()
