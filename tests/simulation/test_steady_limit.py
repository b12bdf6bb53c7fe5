"""Ends of a running-in: the limit of the discrete interface, and another one."""

import numpy as np

import thermowear as tw
from thermowear.errors import ComputationError
from thermowear.simulation.geometry_update import outer_loop
from thermowear.simulation.interface.interface_problem import InterfaceProblem

from ..case.starter import solved
from ..conftest import DEMOS

UNTIL = "analysis={type='transient', until='steady'}"


def test_edges_that_have_left_a_coarse_face():
    """
    requirement: points that keep pointwise contact, as the pressure space is too coarse for the
    steady pressure, do not keep the running-in from its end.

    The pressure falls as 1/r over two elements along the radius: by linear functions it is 0.7 %
    off at the inner edge, where the hot faces touched last.
    """
    case = DEMOS / "two_pads_3d.toml"
    tolerance = 3e-4
    result = tw.run(tw.load(case, (UNTIL, f"analysis.steady_tolerance={tolerance}")))
    assert result.stopped is None, result.stopped
    assert result.summary["distance_from_steady"] <= tolerance
    steady = tw.run(tw.load(case)).interface.pressure
    off = np.abs(result.interface.pressure - steady).max() / steady.max()
    assert tolerance < off < 1e-2


def test_a_limit_that_is_not_the_steady_state(monkeypatch):
    """requirement: a running-in that stays away from the steady state ends in one line.

    In a body of any thickness: this one is worn through before.
    """
    monkeypatch.setattr(InterfaceProblem, "distance", lambda *_: 0.25)
    monkeypatch.setattr(outer_loop.MeshPeriod, "thinnest", lambda *_: outer_loop.Thinnest())
    coarse = "mesh.degree=3", "mesh.elements=6", "wear.update='never'"
    result = solved("annular-punch-running-in", None, UNTIL, *coarse)
    assert isinstance(result.stopped, ComputationError)
    assert "nothing changes any more" in str(result.stopped)
    assert "0.25 from the steady state" in str(result.stopped)
    assert result.summary["time_s"] < 1e30
