"""Distribution of groups of tasks to workers."""

from __future__ import annotations

import os
import signal
from concurrent.futures import ThreadPoolExecutor
from threading import Lock

import pytest

from thermowear.app.batch.computing import Lost, Stopped, compute, compute_chunk
from thermowear.app.batch.pool import ProcessPool


class Square:
    """Work that kills its process for negative numbers."""

    def __call__(self, series, task):
        if task < 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return task, task**2


class Recorded:
    """Work that records the series and groups of its tasks."""

    def __init__(self):
        self.lock, self.groups = Lock(), {}

    def __call__(self, series, task):
        with self.lock:
            self.groups.setdefault(task[0], set()).add(id(series))
        return task


def stop_at_three(series, task):
    if task == 3:
        raise Stopped(("part", task))
    return task


def test_in_this_process():
    """requirement: without an executor tasks are computed in order, with one series."""
    found, work = [], Recorded()
    tasks = [[("a", 1), ("a", 2)], [("b", 1)]]
    compute(tasks, work, found.append)
    assert found == [("a", 1), ("a", 2), ("b", 1)]
    assert len(set.union(*work.groups.values())) == 1


def test_every_task_once():
    """requirement: idle workers take over tasks of larger groups; each is computed once."""
    found = []
    groups = [[(name, k) for k in range(n)] for name, n in (("a", 200), ("b", 3), ("c", 1))]
    with ThreadPoolExecutor(3) as executor:
        compute(groups, Recorded(), found.append, executor, 3)
    assert sorted(found) == sorted(task for group in groups for task in group)


def test_a_crash_costs_one_task():
    """requirement: tasks of the chunk in which a process died are computed one by one."""
    found = []
    with ProcessPool(2) as pool:
        compute([[1, 2, 3, 4, -5, 6, 7, 8, 9]], Square(), found.append, pool, 2)
    lost = [outcome for outcome in found if isinstance(outcome, Lost)]
    assert [one.task for one in lost] == [-5]
    assert "exit code -9" in lost[0].reason
    assert sorted(one for one in found if one not in lost) == [
        (k, k**2) for k in (1, 2, 3, 4, 6, 7, 8, 9)
    ]


@pytest.mark.parametrize("workers", [0, 1])
def test_an_interrupt_keeps_what_was_computed(workers):
    """requirement: outcomes before an interrupt, and the part of the task it stopped."""
    found = []
    if workers:
        with pytest.raises(KeyboardInterrupt), ProcessPool(1) as pool:
            compute([[1, 2, 3, 4, 5]], stop_at_three, found.append, pool)
    else:
        with pytest.raises(KeyboardInterrupt):
            compute([[1, 2, 3, 4, 5]], stop_at_three, found.append)
    assert found == [1, 2, ("part", 3)]


def test_an_error_of_the_work_ends_the_batch():
    """requirement: errors that the work does not turn into outcomes are raised."""

    def wrong(series, task):
        raise ZeroDivisionError

    with ThreadPoolExecutor(1) as executor, pytest.raises(ZeroDivisionError):
        compute([[1]], wrong, print, executor)
    with pytest.raises(ZeroDivisionError):
        compute_chunk([1], wrong)
