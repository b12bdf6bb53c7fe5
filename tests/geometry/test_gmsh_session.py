"""Interrupts during a session of gmsh."""

import ctypes
import signal

import gmsh
import numpy as np
import pytest

from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.simulation.runtime.history import StopRequest

VIEW = type(np.zeros(1).ctypes)
"""numpy's view of an array as an argument of a C function."""


@pytest.fixture
def interrupted_conversion(heeds_ctrl_c, monkeypatch):
    """Ctrl-C arrives while an array is converted to an argument."""
    address = VIEW._as_parameter_

    def interrupted(view):
        signal.raise_signal(signal.SIGINT)
        return address.fget(view)

    monkeypatch.setattr(VIEW, "_as_parameter_", property(interrupted))


def add_points(gmsh):
    """Add two nodes; arrays are converted by ctypes. Return the nodes' tags."""
    gmsh.model.addDiscreteEntity(1, 1)
    gmsh.model.mesh.addNodes(1, 1, np.array([1, 2]), np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))
    return list(gmsh.model.mesh.getNodes()[0])


def test_ctrl_c_is_delivered_after_the_session(heeds_ctrl_c):
    """requirement: a session that Ctrl-C meets ends complete and closed, then as interrupted."""
    tags = []

    def session():
        with gmsh_model("interrupted") as gmsh:
            signal.raise_signal(signal.SIGINT)
            tags.extend(add_points(gmsh))

    with pytest.raises(KeyboardInterrupt):
        session()
    assert tags == [1, 2]
    assert not gmsh.isInitialized()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ctrl_c_while_an_argument_is_converted(interrupted_conversion):
    """requirement: it is an interrupt, also the second one, and no failure of gmsh."""

    def session():
        with gmsh_model("interrupted") as gmsh, pytest.raises(ctypes.ArgumentError):
            add_points(gmsh)

    with pytest.raises(KeyboardInterrupt):
        session()


def test_a_step_that_meshes_anew_is_completed(heeds_ctrl_c):
    """requirement: inside a loop that stops after its step, the session passes the request on."""
    with StopRequest() as stop:
        with gmsh_model("worn body") as gmsh:
            signal.raise_signal(signal.SIGINT)
            assert add_points(gmsh) == [1, 2]
        assert stop.recorded


def test_an_ignored_signal_stays_ignored(monkeypatch):
    """requirement: as in a process started in the background."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with gmsh_model("ignored"):
            signal.raise_signal(signal.SIGINT)
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
