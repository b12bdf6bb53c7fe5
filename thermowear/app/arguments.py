"""Parser of the command line: commands, options and help texts."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .. import __version__
from ..errors import CaseError

EXAMPLES: dict[str, tuple[str, ...]] = {
    "run": (
        "punch.toml",
        "punch.toml -o results/hot --set 'motion.angular_velocity=\"0.05 rad/s\"'",
        "punch.toml -o results/hot --resume",
    ),
    "sweep": ("punch.toml --over 'load.mean_pressure=20 MPa,50 MPa' --over mesh.degree=4,6,8",),
    "calibrate": ("punch.toml --data depth=scars.csv", "punch.toml --plan"),
    "study": ("punch.toml --indices --processes 4", "brake.toml --calibration results/punch"),
    "cases": ("",),
    "init": ("annular-punch", "annular-punch -o punch.toml"),
    "validate": ("punch.toml",),
    "mesh": ("brake.toml -o brake.vtu", "brake.toml -o brake.png"),
    "shape": ("punch.toml -o worn.step --body punch",),
    "verify": ("hertz-sphere lame", "--json"),
    "plot": ("results/punch",),
    "animate": ("results/punch -o punch.mp4 --fps 12",),
    "report": ("results/punch",),
    "schema": ("-o thermowear.schema.json",),
    "completion": ("bash > ~/.local/share/bash-completion/completions/thermowear",),
}
"""Arguments of each command, for its help."""
_FILES = {"bash": "_shtab_compgen_files", "zsh": "_files", "tcsh": "f"}
_FOLDERS = {"bash": "_shtab_compgen_dirs", "zsh": "_files -/", "tcsh": "d"}


class _Parser(argparse.ArgumentParser):
    def error(self, message: str):
        raise CaseError(f"{message} (see {self.prog} --help)")


def parser() -> argparse.ArgumentParser:
    """Parser of all commands and options; the parsed result has the name of its `command`."""
    result = _Parser(prog="thermowear", description="Thermo-mechanical sliding wear of two bodies.")
    result.add_argument("--version", action="version", version=f"thermowear {__version__}")
    commands = result.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)

    _add_runs(commands)
    _add_case_commands(commands)
    _add_folder_commands(commands)
    _add_editor_commands(commands)
    return result


def _add_runs(commands) -> None:
    """Commands that compute a case, or many variants of it, into a folder."""
    run = _results(commands, "run", "compute a case", "default: results/<case>")
    existing = run.add_mutually_exclusive_group()
    _add_flag(existing, "--overwrite", "replace existing results")
    _add_flag(existing, "--resume", "continue the run that was stopped in DIR")
    run.add_argument("--no-pictures", dest="pictures", action="store_false", help="draw nothing")
    compared = "repeat the case one degree lower and higher, and print all three side by side"
    _add_flag(run, "--accuracy", compared)

    text = "compute all combinations of values of keys"
    sweep = _results(commands, "sweep", text, "default: results/<case>-sweep")
    sweep.add_argument(
        "--over",
        metavar="KEY=V1,V2,...",
        action="append",
        required=True,
        help="a key and its values, such as load.force='1 kN,2 kN'; can be repeated",
    )
    _add_batch(sweep, "compute the variants that are missing in DIR")

    text = "find parameters of a case from measured data"
    calibrate = _results(
        commands, "calibrate", text, "default: results/<case>-calibration or -plan"
    )
    calibrate.add_argument(
        "--data",
        metavar="[NAME=]FILE",
        action="append",
        default=[],
        help="CSV file of an observation; can be repeated",
    )
    _add_flag(calibrate, "--plan", "how well measurements would determine the parameters")
    _add_batch(calibrate, "continue the search that was stopped in DIR")

    text = "propagate uncertain inputs, and rank their influence"
    study = _results(commands, "study", text, "default: results/<case>-study")
    study.add_argument(
        "--calibration",
        metavar="DIR",
        type=Path,
        help="results of a calibration, whose parameters are uncertain inputs, too",
    )
    _add_flag(study, "--indices", "compute Sobol indices, too")
    _add_batch(study, "compute the variants that are missing in DIR")


def _add_case_commands(commands) -> None:
    """Commands on a case file."""
    _command(commands, "cases", "list the starter cases")

    init = _command(commands, "init", "write a starter case to edit")
    name = init.add_argument("name", metavar="NAME")
    _complete(name, {"bash": "_thermowear_starters"})
    _add_output(init, "FILE", help="default: NAME.toml")
    _add_flag(init, "--overwrite")

    _add_case(_command(commands, "validate", "check a case without computing it"))

    mesh = _command(
        commands, "mesh", "write the mesh of a case (.msh .vtu .xdmf .inp; .png: picture)"
    )
    _add_case(mesh)
    _add_output(mesh, "FILE", required=True)
    _add_flag(mesh, "--overwrite")

    shape = _command(commands, "shape", "write the steady worn shape of a contact face")
    _add_case(shape)
    _add_output(shape, "FILE", required=True)
    shape.add_argument(
        "--body", metavar="NAME", help="body whose face is shaped; default: the body in the holder"
    )
    shape.add_argument("--face", metavar="NAME", help="its contact face, of a body with several")
    _add_flag(shape, "--overwrite")


def _add_folder_commands(commands) -> None:
    """Commands on results, and verification."""
    verify = _command(commands, "verify", "verify against reference solutions")
    ids = verify.add_argument("ids", metavar="ID", nargs="*", help="default: all but the slow ones")
    _complete(ids, {"bash": "_thermowear_checks"})
    _add_flag(verify, "--slow", "include cases that take more than two minutes")
    _add_flag(verify, "--json", "print the checks as JSON")

    plot = _command(commands, "plot", "redraw the pictures of a results folder")
    _add_folder(plot)

    animate = _command(commands, "animate", "animate a run with analysis.frames")
    _add_folder(animate)
    _add_output(animate, "FILE", help=".gif or .mp4; default: DIR/animation.gif")
    animate.add_argument("--fps", metavar="N", type=_rate, default=8.0, help="frames per second")

    report = _command(commands, "report", "write report.html of a results folder")
    _add_folder(report)


def _add_editor_commands(commands) -> None:
    """Commands for editors and shells."""
    schema = _command(commands, "schema", "write the JSON schema of case files, for editors")
    _add_output(schema, "FILE", help="default: standard output")
    _add_flag(schema, "--overwrite")

    completion = _command(commands, "completion", "print the completion of commands for a shell")
    completion.add_argument("shell", choices=("bash", "zsh", "tcsh"))


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
    examples = "".join(f"  thermowear {name} {example}\n" for example in EXAMPLES[name])
    command = commands.add_parser(
        name,
        help=text,
        description=text[0].upper() + text[1:] + ".",
        epilog=f"examples:\n{examples}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.set_defaults(command=name)
    return command


def _complete(argument: argparse.Action, completion: dict[str, str]) -> None:
    """Let the shell complete an argument, see `shtab.complete`."""
    argument.complete = completion  # type: ignore[attr-defined]


def _results(commands, name: str, text: str, default: str) -> argparse.ArgumentParser:
    """Command that computes a case into a folder."""
    command = _command(commands, name, text)
    _add_case(command)
    _add_output(command, "DIR", help=default)
    return command


def _add_flag(command, name: str, text: str | None = None) -> None:
    command.add_argument(name, action="store_true", help=text)


def _add_output(command: argparse.ArgumentParser, metavar: str, **settings: Any) -> None:
    output = command.add_argument("-o", "--output", metavar=metavar, type=Path, **settings)
    _complete(output, _FOLDERS if metavar == "DIR" else _FILES)


def _add_folder(command: argparse.ArgumentParser) -> None:
    _complete(command.add_argument("folder", metavar="DIR", type=Path), _FOLDERS)


def _add_batch(command: argparse.ArgumentParser, resumed: str) -> None:
    """Options of commands that compute many variants of a case, and what they resume."""
    existing = command.add_mutually_exclusive_group()
    _add_flag(existing, "--overwrite", "replace existing results")
    _add_flag(existing, "--resume", resumed)
    command.add_argument(
        "--no-pictures", dest="pictures", action="store_false", help="draw nothing"
    )
    command.add_argument(
        "--executor",
        choices=("processes", "mpi", "dask"),
        default="processes",
        help="processes of this machine; ranks started by mpirun; workers of Dask",
    )
    command.add_argument(
        "--processes", metavar="N", type=_positive, help="default: number of cores, at most"
    )
    command.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="of Dask, or its scheduler file; default: workers on this machine",
    )


def _add_case(command: argparse.ArgumentParser) -> None:
    _complete(command.add_argument("case", metavar="CASE", type=Path), _FILES)
    command.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        dest="overrides",
        help="change a key, such as mesh.degree=6",
    )
