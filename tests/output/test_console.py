"""Console output."""

import io
from dataclasses import replace

import pytest
from rich.console import Console

from thermowear.output.console import print_summary
from thermowear.output.progress import ConsoleProgress, Terminal
from thermowear.results import HistoryRow


def row(time):
    return HistoryRow(time, 1.0, 2e6, 0.1, 0.0, 0.0, 300.0, 0.0, 0.1, 1e-5, 0.0, 0.0, 0.0, 0.0, 0.0)


def shown(terminal):
    text = io.StringIO()
    console = Console(file=text, force_terminal=terminal, width=120, color_system=None)
    with ConsoleProgress(console) as progress:
        progress.phase("mesh")
        for number in range(3):
            progress.step(number, row(0.5 * number), 0.25)
    return text.getvalue()


def test_plain_lines_where_nobody_watches():
    """requirement: time, step, largest pressure and distance, first and last, no control codes."""
    lines = shown(terminal=False).splitlines()
    assert len(lines) == 2
    assert "\x1b" not in "".join(lines)
    assert lines[0].startswith("t = 0 s   step 0")
    assert lines[1].startswith("t = 1 s   step 2")
    assert "2 MPa" in lines[1]
    assert "2.50e-01" in lines[1]


def test_one_live_line_on_a_terminal():
    """requirement: the live line is overwritten; the last state remains."""
    text = shown(terminal=True)
    assert "\x1b[2K" in text or "\r" in text
    assert text.rstrip().splitlines()[-1].count("t = 1 s") == 1


@pytest.mark.parametrize(
    ("pressure", "shown"), [(0.19, "0.19 Pa"), (1.9e3, "1.9 kPa"), (1.9e5, "0.19 MPa")]
)
def test_units_suit_the_numbers(pressure, shown):
    """requirement: no powers of ten for small pressures, nor thousands of micrometres."""
    summary = {"min_pressure_Pa": 0.0, "max_pressure_Pa": pressure, "approach_m": -0.012037}
    text = io.StringIO()
    print_summary(Console(file=text, width=80), summary, {})
    assert f"0 … {shown}" in text.getvalue()
    assert "-12.037 mm" in text.getvalue()


def test_a_line_of_progress_is_one_line():
    """requirement: a step of a long run fits in 80 columns."""
    text = io.StringIO()
    with ConsoleProgress(Console(file=text, width=80)) as progress:
        progress.step(1234, replace(row(12345.6), max_pressure=0.19287e6), 0.25)
    assert len(text.getvalue().rstrip("\n")) < 80


def test_tables_of_bodies_and_contacts():
    """requirement: no heading is cut, no table without numbers, volumes in mm³."""
    contact = {"normal_force_N": 500.0, "shape_range_m": 2e-6, "wear_volume_1_m3": 3e-9}
    contact |= {"max_pressure_Pa": 2e6, "friction_torque_Nm": 21.0, "friction_power_W": 105.0}
    text = io.StringIO()
    summary = {"contacts": {"left": contact}, "bodies": {"disk": {}}, "holders": {"hub": {}}}
    print_summary(Console(file=text, width=80), summary, {})
    heads = text.getvalue()
    assert "…" not in heads
    assert "bodies" not in heads
    assert "holders" not in heads
    text.truncate(0)
    summary["bodies"]["disk"]["wear_volume_m3"] = 4e-9
    print_summary(Console(file=text, width=80), summary, {})
    assert "worn volume [mm³]" in text.getvalue()
    assert text.getvalue().splitlines()[-2].split() == ["phase", "seconds"]


@pytest.mark.parametrize("name", ["[/]", "[bold]disk", "[red on blue]", ":smile:", "\\[a]", "50%"])
@pytest.mark.parametrize("kind", [Console, Terminal])
def test_names_are_text(kind, name):
    """requirement: names of bodies, holders and probes appear as they are, whatever they mean."""
    summary = {kind: {name: {"approach_m": 1e-6}} for kind in ("holders", "probes")}
    summary["probes"][name] = {"temperature_K": 300.0}
    summary["bodies"] = {name: {"contact_heat_W": 2.0}}
    text = io.StringIO()
    console = kind(file=text, width=100, force_terminal=True, color_system=None)
    print_summary(console, summary, {name: 1.0})
    with ConsoleProgress(console) as progress:
        progress.phase(name)
        progress.note(f"{name} is hot")
    assert text.getvalue().count(name) >= 5


def test_paths_are_text():
    """requirement: the last line of a command names the folder as it is."""
    text = io.StringIO()
    Terminal(file=text, width=40).print("results in [/]/:smile:/[bold]", soft_wrap=True)
    assert text.getvalue() == "results in [/]/:smile:/[bold]\n"
