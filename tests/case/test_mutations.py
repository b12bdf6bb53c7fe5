"""A fuzzer of case files: whatever is in them, they are read or refused, in words, at once.

The classes of mutation stand in `mutations`. A few are tried each time, 5 000 where slow tests are
run; ``THERMOWEAR_SEED=M`` in the environment asks for others.
"""

from __future__ import annotations

import contextlib
import math
import os
import signal

import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main

from .mutations import CLASSES, mutated

FEW, MANY, CHUNK = 100, 5_000, 500
FIRST = int(os.environ.get("THERMOWEAR_SEED", "0"))
_HANGS = 20.0  # s of processor time


class Hang(Exception):
    """A case that is never read to its end."""


@contextlib.contextmanager
def ends_at_all():
    """Raise where a case keeps the processor busy for ever."""

    def stop(*_):
        raise Hang

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, _HANGS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def try_one(seed: int, folder, capsys) -> bool:
    """Test whether a mutated case is accepted; any message must be short and complete."""
    kind, (content, overrides) = mutated(seed)
    file = folder / "case.toml"
    file.write_bytes(content)
    words = ["validate", str(file), *(part for text in overrides for part in ("--set", text))]
    with ends_at_all():
        code = main(words)
    printed = capsys.readouterr()
    where = f"seed {seed} ({kind})"
    assert code in (0, 1), f"{where}: {printed.err}"
    if code == 1:
        lines = printed.err.splitlines()
        assert lines, where
        assert lines[-1].startswith("error: "), where
        assert not printed.out, where
        for line in lines:  # a note may stand before what is found when the bodies are looked at
            assert line.startswith(("error: ", "note: ")), f"{where}: {line}"
            assert len(line) < 1200, f"{where}: {line}"
        return False
    sensible(tw.load(file, overrides), where)
    return True


def sensible(case, where: str) -> None:
    """An accepted case is written out and read again, and has finite loads and a place to touch."""
    plain = tw.case.as_plain(case)
    assert tw.load(plain) == case, where
    assert tomli_w.dumps(plain), where
    if hasattr(case, "holders"):  # of several bodies: forces may be 0
        forces = [holder.force for holder in case.holders.values()]
        assert all(force is None or math.isfinite(force) for force in forces), where
        return
    for number in (case.force(), case.approach(), case.geometry.contact_area()):
        assert number is None or (math.isfinite(number) and number > 0), where
    with contextlib.suppress(tw.CaseError):  # too large for the bodies: said when they are meshed
        zone = case.geometry.expected_zone(case.pressing())
        assert zone is None or all(map(math.isfinite, zone)), where


def test_mutated_cases(tmp_path, capsys):
    """
    requirement: no traceback, no hang, no value that is taken for another one.
    """
    accepted = [try_one(seed, tmp_path, capsys) for seed in range(FIRST, FIRST + FEW)]
    assert FEW / 20 < sum(accepted) < FEW / 2  # neither all junk, nor all sound


@pytest.mark.slow
@pytest.mark.parametrize("first", range(FEW, FEW + MANY, CHUNK))
def test_many_mutated_cases(first, tmp_path, capsys):
    """
    requirement: the same of five thousand.
    """
    chunk = range(FIRST + first, FIRST + first + CHUNK)
    accepted = [try_one(seed, tmp_path, capsys) for seed in chunk]
    assert CHUNK / 20 < sum(accepted) < CHUNK / 2


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_classes_do_what_they_say(kind):
    """
    requirement: a case by its number is always the same, so that it can be looked at again.
    """
    seed = CLASSES.index(kind)
    assert mutated(seed) == mutated(seed)
    assert mutated(seed)[0] == kind.__name__
