"""Pool of processes that compute calls, die, and are interrupted."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Future, wait

import pytest

from thermowear.app.batch import pool as pools
from thermowear.app.batch.pool import ProcessPool
from thermowear.errors import ComputationError, note


def square(number):
    if number < 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return number**2, os.getpid()


def fail(text):
    raise ComputationError(text)


def unpicklable():
    return lambda: None


def dawdle(path):
    try:
        path.touch()
        time.sleep(60)
    except KeyboardInterrupt:
        return "saved"


def convert(path):
    try:
        path.touch()
        time.sleep(60)
    except KeyboardInterrupt:
        raise RuntimeError("a library: interrupted") from None


def wait_for(paths):
    deadline = time.monotonic() + 60
    while not all(path.exists() for path in paths):
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_all_calls_are_computed_in_other_processes():
    """requirement: calls are computed in at most the given number of processes."""
    with ProcessPool(2) as pool:
        found = [future.result() for future in [pool.submit(square, k) for k in range(1, 7)]]
        assert next(pool.map(square, [7]))[0] == 49
    assert [value for value, _ in found] == [k**2 for k in range(1, 7)]
    processes = {process for _, process in found}
    assert len(processes) <= 2
    assert os.getpid() not in processes
    assert not multiprocessing.active_children()
    with pytest.raises(RuntimeError, match="shut down"):
        pool.submit(square, 1)


def noted(text):
    note(text)
    return text


def test_notes_are_not_repeated_by_each_process(capfd):
    """requirement: the first process notes what is unusual in a case; others print nothing."""
    with ProcessPool(2) as pool:
        assert pool.submit(noted, "unusual").result() == "unusual"
    assert capfd.readouterr().err == ""


def test_a_process_that_dies_takes_one_call_with_it():
    """requirement: a crash fails its call, and the others are computed."""
    with ProcessPool(1) as pool:
        futures = [pool.submit(square, k) for k in (1, -1, 2, 3)]
        wait(futures)
    assert [f.result()[0] for f in futures if f.exception() is None] == [1, 4, 9]
    with pytest.raises(ComputationError, match="exit code -9"):
        futures[1].result()


def test_a_process_that_dies_before_its_call():
    """requirement: its call fails as one that the process was computing, and no other error.

    Nor does this process end, where a library handles signals as PETSc does.
    """
    ended = []
    before = signal.signal(signal.SIGPIPE, lambda *_: ended.append("by SIGPIPE"))
    worker = pools._Worker()
    worker.process.kill()
    worker.process.join()
    call = pools._Call(Future(), square, (1,), {})
    worker.begin(call)
    if not worker.idle:  # the call still found room in the pipe
        worker.receive()
    assert worker.idle
    with pytest.raises(ComputationError, match="exit code -9"):
        call.future.result(timeout=10)
    worker.end()
    signal.signal(signal.SIGPIPE, before)
    assert not ended


def test_errors_and_results_that_cannot_be_sent():
    """requirement: an error is that of the call; what cannot be pickled is said to be so."""
    with ProcessPool(1) as pool:
        with pytest.raises(ComputationError, match="no equilibrium"):
            pool.submit(fail, "no equilibrium").result()
        with pytest.raises(ComputationError, match="local object"):
            pool.submit(unpicklable).result()
        with pytest.raises(Exception, match=r"local object|pickle"):
            pool.submit(square, lambda: None).result()
        assert pool.submit(square, 3).result()[0] == 9


def test_an_interrupt_lets_running_calls_return(tmp_path):
    """requirement: running calls return what they have; waiting ones are cancelled."""
    paths = [tmp_path / str(k) for k in range(3)]
    with ProcessPool(2) as pool:
        futures = [pool.submit(dawdle, path) for path in paths]
        wait_for(paths[:2])
        pool.interrupt()
    assert [future.result() for future in futures[:2]] == ["saved", "saved"]
    assert futures[2].cancelled()
    assert not multiprocessing.active_children()


def test_an_interrupt_that_a_library_turns_into_an_error(tmp_path, capfd):
    """requirement: a process that is ended prints nothing."""
    with ProcessPool(1) as pool:
        future = pool.submit(convert, tmp_path / "begun")
        wait_for([tmp_path / "begun"])
        pool.interrupt()
    assert isinstance(future.exception(), RuntimeError)
    assert capfd.readouterr().err == ""


def test_ctrl_c_while_a_process_is_started(heeds_ctrl_c, monkeypatch):
    """requirement: it is delivered once the process runs, and not to that process."""
    start = pools._SPAWN.Process.start

    def interrupted(process):
        signal.raise_signal(signal.SIGINT)
        start(process)

    monkeypatch.setattr(pools._SPAWN.Process, "start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        ProcessPool(1)
    deadline = time.monotonic() + 60
    while multiprocessing.active_children():
        assert time.monotonic() < deadline
        time.sleep(0.02)


INTERRUPTED_IN_A_DESTRUCTOR = """
import signal
import time
from thermowear.interrupts import deliver_again

signal.signal(signal.SIGINT, signal.default_int_handler)


class Vector:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

deliver_again()
try:
    vector = Vector()
    del vector
    time.sleep(60)
except KeyboardInterrupt:
    print("interrupted")
"""


def test_an_interrupt_inside_a_destructor_is_not_lost():
    """requirement: Ctrl-C during deallocation of a matrix ends the run without a traceback."""
    command = [sys.executable, "-c", INTERRUPTED_IN_A_DESTRUCTOR]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("interrupted\n", "")
