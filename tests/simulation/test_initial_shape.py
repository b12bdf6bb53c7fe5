"""Runs that start from a worn shape."""

import csv
import os

import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.errors import CaseError
from thermowear.output.tables import write_points

from ..case.starter import RUNNING_IN, solved
from ..conftest import COLD_RUNNING_IN

COARSE = ("mesh.degree=5", "mesh.elements=8")
STEADY = "analysis={type='steady'}"


@pytest.fixture(scope="module")
def steady(tmp_path_factory):
    """The steady state and a file with its shape."""
    result = solved(RUNNING_IN, None, *COARSE, STEADY)
    file = tmp_path_factory.mktemp("shape") / "profile.csv"
    write_points(file, result.profile)
    return result, file


def test_the_steady_shape_needs_no_running_in(steady):
    """requirement: bodies that begin in the steady shape carry the steady pressure at once."""
    result, file = steady
    shaped = f"geometry.initial_shape={str(file)!r}"
    begun = solved(RUNNING_IN, None, *COARSE, shaped, "analysis={type='initial'}")
    assert begun.interface.pressure == pytest.approx(result.interface.pressure, rel=1e-2)
    assert begun.interface.shape == pytest.approx(
        result.interface.shape, abs=1e-9 * np.ptp(result.interface.shape)
    )


def test_a_shape_from_another_mesh(steady):
    """requirement: the shape is a curve along the face, whatever mesh it was computed on."""
    result, file = steady
    shaped = f"geometry.initial_shape={str(file)!r}"
    begun = solved(RUNNING_IN, None, "mesh.degree=4", shaped, "analysis={type='initial'}")
    inner = (begun.interface.s > 2e-3) & (begun.interface.s < 98e-3)
    exact = np.interp(begun.interface.s, result.interface.s, result.interface.pressure)
    assert begun.interface.pressure[inner] == pytest.approx(exact[inner], rel=2e-2)


@pytest.mark.parametrize(
    ("rows", "text"),
    [
        (None, "cannot be read"),
        ([], "is empty"),
        ([["s_m", "shape_m"], [0, 0], [0.1, 1e300]], "beyond 1e100 m"),
        ([["s_m", "shape_m"], [0, 0], [0.1, "inf"]], "no numbers"),
        ([["s_m", "shape_m"], [0, 0], [100, 0.02]], "is it in metres?"),
        ([["s_m", "shape_m"], [0, 0], [0.05, 30], [0.1, 0]], "are they in metres?"),
        ([["s_m", "shape_m"], [0, 0], [0.1, 0], [0.1, 1e-6]], "different shapes at s_m = 0.1"),
        ([["s_m", "shape_m"], [0, 0], [0, 0]], "one place only"),
        ([["s_m;shape_m"], ["0;0"], ["0,1;0"]], "columns between commas"),
        ([["a", "b"], [1, 2], [3, 4]], "no columns s_m and shape_m"),
        ([["s_m", "shape_m"], [0, 0]], "no columns s_m and shape_m with numbers"),
        ([["s_m", "shape_m"], [0, 0], [0.1, "much"]], "no numbers"),
        ([["s_m", "shape_m"], [0, 0], [0.05, 1e-6]], "the contact face from 0 to 0.1 m"),
    ],
)
def test_faults(tmp_path, capsys, rows, text):
    """requirement: one line with the key's path and what is wrong with the file."""
    file = tmp_path / "shape.csv"
    if rows is not None:
        with file.open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream).writerows(rows)
    with pytest.raises(CaseError) as caught:
        solved(RUNNING_IN, None, *COARSE, f"geometry.initial_shape={str(file)!r}", STEADY)
    (line,) = caught.value.args
    assert line.startswith("geometry.initial_shape: ")
    assert text in line
    words = [str(COLD_RUNNING_IN), "--set", f"geometry.initial_shape={str(file)!r}"]
    assert main(["validate", *words]) == 1
    assert capsys.readouterr().err == f"error: {line}\n"


def test_validate_reads_the_shape(tmp_path, capsys):
    """requirement: a good one is said, and nothing else."""
    file = tmp_path / "shape.csv"
    file.write_text("s_m,shape_m\n0,0\n0.1,1e-6\n", "utf-8")
    shaped = f"geometry.initial_shape={str(file)!r}"
    assert main(["validate", str(COLD_RUNNING_IN), "--set", shaped]) == 0
    heard = capsys.readouterr()
    assert (
        f"ok (transient analysis, annular-punch, axisymmetric, initial shape {file})" in heard.out
    )
    assert heard.err == ""


def test_a_pipe_is_no_shape(tmp_path):
    """requirement: what may never end is not waited for."""
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(CaseError, match="is a pipe"):
        solved(RUNNING_IN, None, *COARSE, f"geometry.initial_shape={str(tmp_path / 'pipe')!r}")


def test_doubled_places_of_one_shape(steady, tmp_path):
    """requirement: a place that is there twice with one shape is there once."""
    _, file = steady
    twice = tmp_path / "twice.csv"
    head, *rows = file.read_text().splitlines()
    twice.write_text("\n".join([head, *rows, *rows[::-1]]))
    first, second = (
        solved(
            RUNNING_IN,
            None,
            *COARSE,
            f"geometry.initial_shape={str(name)!r}",
            "analysis={type='initial'}",
        )
        for name in (file, twice)
    )
    assert second.interface.pressure == pytest.approx(first.interface.pressure, rel=1e-12)
