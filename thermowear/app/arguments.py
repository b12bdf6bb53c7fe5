"""Parser of the command line: commands, options and help texts."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import __version__
from ..errors import CaseError


class _Parser(argparse.ArgumentParser):
    def error(self, message: str):
        raise CaseError(f"{message} (see {self.prog} --help)")


def parser() -> argparse.ArgumentParser:
    """Parser of all commands and options; the parsed result has the name of its `command`."""
    result = _Parser(prog="thermowear", description="Thermo-mechanical sliding wear of two bodies.")
    result.add_argument("--version", action="version", version=f"thermowear {__version__}")
    commands = result.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)

    run = _command(commands, "run", "compute a case")
    _add_case(run)
    run.add_argument("-o", "--output", metavar="DIR", type=Path, help="default: results/<case>")
    existing = run.add_mutually_exclusive_group()
    existing.add_argument("--overwrite", action="store_true", help="replace existing results")
    existing.add_argument(
        "--resume", action="store_true", help="continue the run that was stopped in DIR"
    )
    run.add_argument("--no-pictures", dest="pictures", action="store_false")
    run.add_argument(
        "--accuracy",
        action="store_true",
        help="repeat the case one degree lower and higher, and print all three side by side",
    )

    sweep = _command(commands, "sweep", "compute all combinations of values of keys")
    _add_case(sweep)
    sweep.add_argument(
        "--over",
        metavar="KEY=V1,V2,...",
        action="append",
        required=True,
        help="a key and its values, such as load.force='1 kN,2 kN'; can be repeated",
    )
    sweep.add_argument(
        "-o", "--output", metavar="DIR", type=Path, help="default: results/<case>-sweep"
    )
    sweep.add_argument("--overwrite", action="store_true", help="replace existing results")
    sweep.add_argument("--no-pictures", dest="pictures", action="store_false")
    sweep.add_argument(
        "--processes",
        metavar="N",
        type=_positive,
        help="for variants that share no factorisations; default: number of cores",
    )

    _command(commands, "cases", "list the starter cases")

    init = _command(commands, "init", "write a starter case to edit")
    init.add_argument("name", metavar="NAME")
    init.add_argument("-o", "--output", metavar="FILE", type=Path, help="default: NAME.toml")
    init.add_argument("--overwrite", action="store_true")

    validate = _command(commands, "validate", "check a case without computing it")
    _add_case(validate)

    mesh = _command(commands, "mesh", "write the mesh of a case (.msh .vtu .xdmf .inp)")
    _add_case(mesh)
    mesh.add_argument("-o", "--output", metavar="FILE", type=Path, required=True)
    mesh.add_argument("--overwrite", action="store_true")

    shape = _command(commands, "shape", "write the steady worn shape of a contact face")
    _add_case(shape)
    shape.add_argument("-o", "--output", metavar="FILE", type=Path, required=True)
    shape.add_argument(
        "--body", metavar="NAME", help="body whose face is shaped; default: the body in the holder"
    )
    shape.add_argument("--overwrite", action="store_true")

    verify = _command(commands, "verify", "verify against reference solutions")
    verify.add_argument("ids", metavar="ID", nargs="*", help="default: all but the slow ones")
    verify.add_argument(
        "--slow", action="store_true", help="include cases that take more than two minutes"
    )
    verify.add_argument("--json", action="store_true", help="print the checks as JSON")

    plot = _command(commands, "plot", "redraw the pictures of a results folder")
    plot.add_argument("folder", metavar="DIR", type=Path)

    animate = _command(commands, "animate", "animate a run with analysis.frames")
    animate.add_argument("folder", metavar="DIR", type=Path)
    animate.add_argument(
        "-o", "--output", metavar="FILE", type=Path, help=".gif or .mp4; default: DIR/animation.gif"
    )
    animate.add_argument("--fps", metavar="N", type=_rate, default=8.0, help="frames per second")

    report = _command(commands, "report", "write report.html of a results folder")
    report.add_argument("folder", metavar="DIR", type=Path)
    return result


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


def _command(commands, name: str, text: str) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
    command.set_defaults(command=name)
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
