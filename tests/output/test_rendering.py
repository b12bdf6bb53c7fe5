"""Rendering process: its jobs, its failures, its end, and its X server."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from thermowear.output.pictures import make
from thermowear.output.rendering import PictureJob, Renderer, display, renderer

RESULTS = Path(__file__).parent / "data" / "0.1.0" / "steady"
ENDS = 30.0  # s; patience of these tests on a busy machine

FAKE = """
import json, os, signal, sys
for line in sys.stdin:
    kind, arguments, _ = json.loads(line)
    if kind == "crash":
        print("something about graphics", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGSEGV)
    if kind == "sleep":
        signal.pause()
    print(json.dumps("failed" if kind == "fail" else ""), flush=True)
"""


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Renderer whose process draws nothing, but fails, crashes and sleeps."""
    (tmp_path / "fake.py").write_text(FAKE, encoding="utf-8")
    monkeypatch.setattr(renderer, "_MODULE", "fake")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=":")
    with Renderer() as result:
        yield result


def jobs(*kinds):
    return [PictureJob(kind, (), timeout=1.0 if kind == "sleep" else ENDS) for kind in kinds]


def test_a_failure_leaves_the_others(fake):
    """requirement: each job has its own reason of failure, in order."""
    fake.begin(jobs("draw", "fail", "draw"))
    assert fake.reasons() == ["", "failed", ""]


def test_a_crash_leaves_the_others(fake):
    """requirement: it costs the job being drawn, and is told; those after it are drawn."""
    fake.begin(jobs("draw", "crash", "draw", "fail"))
    reasons = fake.reasons()
    assert reasons == ["", "ended by SIGSEGV: something about graphics", "", "failed"]


def test_a_crash_leaves_the_curves(fake, tmp_path, monkeypatch):
    """requirement: they are drawn, and a note says what is missing and why."""
    folder = Path(shutil.copytree(RESULTS, tmp_path / "results"))
    of_the_bodies = {"the bodies": PictureJob("crash", ())}
    monkeypatch.setattr(make, "_of_the_bodies", lambda *_: of_the_bodies)
    (note,) = make.make_pictures(folder, fake)
    reason = "ended by SIGSEGV: something about graphics"
    assert note == f"the bodies could not be drawn: {reason}"
    assert (folder / "interface.png").is_file()


def test_what_takes_too_long_is_given_up(fake):
    fake.begin(jobs("sleep", "draw"))
    assert fake.reasons() == ["not done after 1 s", ""]


def test_a_process_that_has_gone_is_replaced(fake):
    """requirement: one that ended while it had nothing to do costs no picture."""
    fake.start()
    fake._process.kill()
    fake._process.wait()
    fake.begin(jobs("draw"))
    assert fake.reasons() == [""]


def test_a_process_that_cannot_start(fake, monkeypatch):
    """requirement: each job hears why; starting early is no error."""
    monkeypatch.setattr(sys, "executable", "/no/such/python")
    monkeypatch.setattr(renderer, "ending_with_parent", list)
    fake.start()
    fake.begin(jobs("draw", "draw"))
    reasons = fake.reasons()
    assert len(reasons) == 2
    assert all("/no/such/python" in reason for reason in reasons)


def test_no_job_no_process(fake):
    fake.begin([])
    assert fake.reasons() == []
    assert fake._process is None


# ---- the process itself ----

WAITING = """
import sys
from thermowear.output.rendering import Renderer
with Renderer() as renderer:
    renderer.start()
    print(renderer._process.pid, flush=True)
    sys.stdin.read()
"""


def children(pid):
    """Processes that a process has started."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            state, parent = (folder / "stat").read_text().rpartition(")")[2].split()[:2]
        except OSError:
            continue
        if int(parent) == pid and state != "Z":
            found.append(int(folder.name))
    return found


def ended(pid):
    """Wait for the end of a process that may not be a child."""
    limit = time.monotonic() + ENDS
    while time.monotonic() < limit:
        try:
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


def servers(pid):
    """X servers of a rendering process, once it has drawn its first scene or needs none."""
    limit = time.monotonic() + ENDS
    while time.monotonic() < limit:
        if found := children(pid):
            return found
        time.sleep(0.05)
    return []


@pytest.mark.skipif(not display.ending_with_parent(), reason="no setpriv")
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_it_ends_with_its_parent(number):
    """requirement: a run that is killed leaves neither a renderer nor an X server."""
    command = [sys.executable, "-c", WAITING]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as parent:
        pid = int(parent.stdout.readline())
        started = servers(pid) if display._needs_x() else []
        parent.send_signal(number)
        parent.wait()
        assert ended(pid)
        assert all(ended(server) for server in started)


def test_a_killed_renderer_takes_its_server_along():
    """requirement: no X server is left, however the process ends."""
    with Renderer() as mine:
        mine.start()
        started = servers(mine._process.pid) if display._needs_x() else []
        mine._process.kill()
        assert all(ended(server) for server in started)


def test_an_idle_renderer_ends_at_once():
    """requirement: a run that fails does not wait for it, nor for its X server."""
    with Renderer() as mine:
        mine.start()
        pid = mine._process.pid
        started = servers(pid) if display._needs_x() else []
    assert not Path(f"/proc/{pid}").exists()
    assert all(ended(server) for server in started)


def test_no_server_where_none_is_needed(monkeypatch):
    """requirement: builds of VTK that draw without X get no server, and keep the surroundings."""
    before = dict(os.environ)
    monkeypatch.setattr(display, "_needs_x", lambda: False)
    monkeypatch.setattr(display, "_server", lambda: pytest.fail("a server is started"))
    with display.display():
        assert dict(os.environ) == before


def test_a_build_for_x_without_any(monkeypatch, tmp_path):
    """requirement: it is said rather than tried, which would end the process."""
    monkeypatch.setattr(display, "_needs_x", lambda: True)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(OSError, match="neither Xvfb nor a DISPLAY"), display.display():
        pass
    monkeypatch.setenv("DISPLAY", ":7")
    with display.display():
        assert os.environ["DISPLAY"] == ":7"


def test_a_server_that_ends_at_once(monkeypatch, tmp_path):
    """requirement: its exit code is said, and nothing waits for it."""
    (tmp_path / "Xvfb").write_text("#!/bin/sh\nexit 3\n", encoding="utf-8")
    (tmp_path / "Xvfb").chmod(0o755)
    monkeypatch.setattr(display, "_needs_x", lambda: True)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    with pytest.raises(OSError, match=r"Xvfb.* code 3"), display.display():
        pass


def test_the_reason_reaches_the_notes(monkeypatch, tmp_path):
    """requirement: without an X server each job is refused with the reason, in one process."""
    if not display._needs_x():
        pytest.skip("VTK needs no X here")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("DISPLAY", raising=False)
    with Renderer() as mine:
        mine.begin(jobs("bodies", "mesh"))
        reasons = mine.reasons()
    assert len(reasons) == 2
    assert all("neither Xvfb nor a DISPLAY" in reason for reason in reasons)
