"""Completion of commands, options and names in bash."""

from __future__ import annotations

import subprocess

import pytest

from thermowear.app.arguments import EXAMPLES, parser
from thermowear.app.cli import main

pytest.importorskip("shtab")


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    path = tmp_path_factory.mktemp("shell") / "thermowear"
    with path.open("w", encoding="utf-8") as file, pytest.MonkeyPatch.context() as patched:
        patched.setattr("sys.stdout", file)
        assert main(["completion", "bash"]) == 0
    return path


def offered(script, line):
    """Words that bash offers at the end of a command line."""
    words = line.split(" ")
    program = f"""
        source {script}
        COMP_WORDS=({" ".join(word or "''" for word in words)})
        COMP_CWORD={len(words) - 1}
        COMP_LINE={line!r}; COMP_POINT={len(line)}
        $(complete -p thermowear | sed 's/.*-F \\([^ ]*\\).*/\\1/') thermowear
        printf '%s\\n' "${{COMPREPLY[@]}}"
    """
    done = subprocess.run(
        ["bash", "-c", program], capture_output=True, text=True, cwd=script.parent, check=False
    )
    assert not done.stderr
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("thermowear cal", ["calibrate"]),
        ("thermowear run --acc", ["--accuracy"]),
        ("thermowear study x.toml --executor d", ["dask"]),
        ("thermowear init annular-punch-t", ["annular-punch-toroidal"]),
        ("thermowear verify hertz-l", ["hertz-line"]),
        ("thermowear run some", ["some.toml"]),
    ],
)
def test_words_are_offered(script, line, expected):
    """requirement: bash completes commands, options, choices, starters, checks and files."""
    (script.parent / "some.toml").touch()
    assert offered(script, line) == expected


def test_examples_of_the_help_can_be_parsed():
    """requirement: each example in a help text is a valid command line."""
    import shlex

    for command, examples in EXAMPLES.items():
        for example in examples:
            words = shlex.split(example.partition(" > ")[0])
            assert parser().parse_args([command, *words]).command == command
