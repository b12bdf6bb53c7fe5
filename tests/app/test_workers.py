"""Processes that work off tasks, die, and are interrupted."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time

import pytest

from thermowear.app import workers
from thermowear.app.workers import work_off


def square(task, tell):
    for number in task:
        if number < 0:
            os.kill(os.getpid(), signal.SIGKILL)
        tell((number, number**2, os.getpid()))


def dawdle(task, tell):
    try:
        tell("begun")
        time.sleep(60)
    except KeyboardInterrupt:
        tell("saved")
        raise


def convert(task, tell):
    try:
        tell("begun")
        time.sleep(60)
    except KeyboardInterrupt:
        raise RuntimeError("a library: interrupted") from None


def test_all_tasks_are_done_in_other_processes():
    """requirement: tasks are computed in processes, each reported when it is finished."""
    told, lost = [], []
    work_off([[1, 2], [3], [4], [5, 6]], 2, square, told.append, lambda *given: lost.append(given))
    assert sorted((a, b) for a, b, _ in told) == [(k, k**2) for k in range(1, 7)]
    processes = {process for *_, process in told}
    assert len(processes) <= 2
    assert os.getpid() not in processes
    assert not lost


def test_a_process_that_dies_takes_one_task_with_it():
    """requirement: a crash is reported, and the other tasks are computed."""
    told, lost = [], []
    tasks = [[1, -1], [2], [3]]
    work_off(tasks, 1, square, told.append, lambda *given: lost.append(given))
    assert [a for a, *_ in told] == [1, 2, 3]
    ((task, why),) = lost
    assert task == [1, -1]
    assert "-9" in why


def test_what_is_saved_after_ctrl_c_arrives(heeds_ctrl_c):
    """requirement: after Ctrl-C the processes save their results and end."""
    told = []

    def hear(message):
        told.append(message)
        if told.count("begun") == 2 and "saved" not in told:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work_off([1, 2, 3], 2, dawdle, hear, lambda *given: None)
    assert told == ["begun", "begun", "saved", "saved"]
    assert not multiprocessing.active_children()


def test_an_interrupt_that_a_library_turns_into_an_error(heeds_ctrl_c, capfd):
    """requirement: a process that is ended says nothing."""

    def hear(message):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work_off([[1]], 1, convert, hear, lambda *given: None)
    assert capfd.readouterr().err == ""


def test_ctrl_c_while_a_process_is_started(heeds_ctrl_c, monkeypatch):
    """requirement: it is delivered once the process runs, and not to that process."""
    told, start = [], workers._SPAWN.Process.start

    def interrupted(process):
        signal.raise_signal(signal.SIGINT)
        start(process)

    monkeypatch.setattr(workers._SPAWN.Process, "start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        work_off([[1], [2]], 1, square, told.append, lambda *given: None)
    assert told == []


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
