"""Distribution of groups of tasks to workers."""

from __future__ import annotations

import os
import signal
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from threading import Lock

import pytest

from thermowear.app.batch.computing import Lost, Stopped, compute, compute_chunk
from thermowear.app.batch.pool import ProcessPool
from thermowear.output.variants.folder import LOST


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


def test_threads_compute_one_at_a_time():
    """requirement: threads of one process, as of a worker of Dask, take turns with its series."""
    busy, overlaps = Lock(), []

    def work(series, task):
        overlaps.append(not busy.acquire(blocking=False))
        time.sleep(0.01)
        busy.release()
        return id(series)

    found = []
    with ThreadPoolExecutor(4) as executor:
        compute([[k, k + 1] for k in range(8)], work, found.append, executor, 4)
    assert not any(overlaps)
    assert len(found) == 16
    assert len(set(found)) == 1


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


class Answers(Executor):
    """Executor that gives prepared answers, and is shut down as that of Dask."""

    def __init__(self, *answers):
        self.answers = list(answers)

    def submit(self, function, /, *arguments, **keywords):
        future, answer = Future(), self.answers.pop(0)
        if answer == "cancelled":
            future.cancel()
            future.set_running_or_notify_cancel()
        elif isinstance(answer, BaseException):
            future.set_exception(answer)
        elif answer == "computed":
            future.set_result(function(*arguments, **keywords))
        else:
            self.last = future
        return future

    def shutdown(self, wait=True):
        if wait and hasattr(self, "last"):
            self.last.set_running_or_notify_cancel()


def test_an_executor_that_cannot_cancel_is_interrupted():
    """requirement: what running calls return is reported; those that have not begun are left."""
    found = []
    executor = Answers("waits", KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        compute([[1], [2]], Recorded(), found.append, executor, 2)
    assert found == []
    assert executor.last.cancelled()


def test_interrupted_calls_do_not_hide_each_other():
    """requirement: outcomes of the others are kept where an interrupted call returned none."""

    class Late(Answers):
        def shutdown(self, wait=True):
            first, second = self.begun
            first.set_exception(KeyboardInterrupt())
            second.set_result(compute_chunk([("b", 1)], Recorded(), object()))

        def submit(self, function, /, *arguments, **keywords):
            if len(self.begun) == 2:
                raise KeyboardInterrupt
            future = Future()
            future.set_running_or_notify_cancel()
            self.begun.append(future)
            return future

        begun = []

    found = []
    with pytest.raises(KeyboardInterrupt):
        compute([[("a", 1)], [("b", 1)], [("c", 1)]], Recorded(), found.append, Late(), 3)
    assert found == [("b", 1)]


@pytest.mark.parametrize("answer", ["cancelled", BrokenExecutor("the pool is broken")])
def test_a_call_that_another_executor_loses(answer):
    """requirement: it is told as the death of a process, and the next ones are computed."""
    found = []
    executor = Answers(answer, "computed")
    compute([[("a", 1), ("a", 2)]], Recorded(), found.append, executor, 1)
    assert f"failed: {found[0].reason}".startswith(LOST)
    assert found[0].task == ("a", 1)
    assert found[1:] == [("a", 2)]


def test_an_error_of_the_work_ends_the_batch():
    """requirement: errors that the work does not turn into outcomes are raised."""

    def wrong(series, task):
        raise ZeroDivisionError

    with ThreadPoolExecutor(1) as executor, pytest.raises(ZeroDivisionError):
        compute([[1]], wrong, print, executor)
    with pytest.raises(ZeroDivisionError):
        compute_chunk([1], wrong)
