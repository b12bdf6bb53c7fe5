"""Contact that ends at a sharp edge: pressure functions cut by the edge, and what is singular."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.model import Body, Discretisation, Holder, Interface, Material, Model
from thermowear.model.analyses import StaticAnalysis
from thermowear.simulation.analyses.run import run
from thermowear.simulation.runtime.observer import Observer
from thermowear.verification.check import starter

from .extruded import Blocks

STEEL = Material(2e11, 0.3, label="steel")
UP = np.array([0.0, 5e-3, 12e-3])
NARROW, WIDE = np.linspace(6.3e-3, 16.3e-3, 5), np.linspace(0.0, 24e-3, 9)
ENDS = np.array([0.0, 4e-3])


def model(blocks, in_space=False, order=("upper", "lower"), **contact):
    """Blocks pressed together by the holder of the upper one, faces named in an order."""
    down = (0.0, 0.0, -1.0) if in_space else (0.0, -1.0)
    meshes = blocks.extruded(ENDS, axis=1) if in_space else blocks.section()
    names = ["upper", "lower"]
    interface = Interface(
        faces=(f"{order[0]}_face", f"{order[1]}_face"),
        bodies=(names.index(order[0]), names.index(order[1])),
        name="joint",
        **contact,
    )
    origin = (0.0,) * len(down)
    return Model(
        kinematics="3d" if in_space else "plane-strain",
        bodies=tuple(Body(name, {name: STEEL}, fixed=(f"{name}_end",)) for name in names),
        interfaces=(interface,),
        holders=(Holder(down, origin, origin, force=1e3, name="press"),),
        meshes=meshes,
        discretisation=Discretisation(degree=2),
        thickness=None if in_space else ENDS[-1],
    )


class Notes(Observer):
    """Keeps the notes of a run."""

    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def initial(given, observer=None):
    return run(given, StaticAnalysis("initial"), observer=observer)


def largest(result):
    return result.summary["max_pressure_Pa"]


@pytest.mark.parametrize("in_space", [False, True])
def test_any_body_first(in_space):
    """requirement: the narrow body above or below, its face first or second: the same pressures to
    1e-12, mirror images to 1e-9; an edge that cuts elements is no exception.
    """
    above, below = Blocks((NARROW, UP), (WIDE, -UP[::-1])), Blocks((WIDE, UP), (NARROW, -UP[::-1]))
    known = initial(model(above, in_space))
    exchanged = initial(model(above, in_space, ("lower", "upper")))
    scale = largest(known)
    np.testing.assert_allclose(
        exchanged.interface.pressure, known.interface.pressure, rtol=0, atol=1e-12 * scale
    )
    for order in (("upper", "lower"), ("lower", "upper")):
        mirrored = initial(model(below, in_space, order))
        assert largest(mirrored) == pytest.approx(scale, rel=1e-9, abs=0.0)
        assert mirrored.summary["contacts"]["joint"]["between"] == list(order)
    assert scale < 3.0 * 1e3 / (10e-3 * ENDS[-1])


@pytest.mark.parametrize("degree", [1, 2])
def test_each_face_cut_by_the_edge_of_the_other(degree):
    """requirement: as an edge moves over an element, the largest pressure stays between those of
    whole elements, within 20 %; slivers of 1e-6 and of a third of an element alike.
    """
    size, found = 5e-3, []
    for part in (0.0, 1e-6, 0.1, 0.4, 0.7, 0.9, 0.99, 1 - 1e-6, 1.0):
        upper, lower = np.linspace(0.0, 40e-3, 9), np.linspace(20e-3, 70e-3, 11)
        given = model(Blocks((upper, UP), (lower + part * size, -UP[::-1])))
        found.append(largest(initial(replace(given, discretisation=Discretisation(degree)))))
    assert min(found) > 0.95 * found[0]
    assert max(found) < 1.2 * max(found[0], found[-1])


def test_singular_pressure_is_said():
    """requirement: finer elements double the pressure at the edge, which is called singular; the
    share of its elements and the pressure beside them fall to what is not singular.
    """
    said, observer = [], Notes()
    for count in (5, 17):
        narrow = np.linspace(NARROW[0], NARROW[-1], count)
        result = initial(model(Blocks((narrow, UP), (WIDE, -UP[::-1]))), observer)
        said.append((largest(result), result.summary["contacts"]["joint"]))
    assert sum("is singular" in note for note in observer.notes) == 2
    (coarse, first), (fine, second) = said
    assert fine > 1.3 * coarse
    shares = [one["singular_edge_load_fraction"] for one in (first, second)]
    assert 0.5 < shares[0] < 0.8
    assert 0.1 < shares[1] < 0.3
    assert second["max_pressure_off_singular_edges_Pa"] < 0.7 * fine


@pytest.mark.parametrize(
    ("upper", "contact"),
    [(WIDE, {}), (NARROW, {"compliance": 1e-12})],
    ids=["both bodies end there", "a soft layer"],
)
def test_what_is_not_singular(upper, contact):
    """requirement: no note where both bodies end at the same edge, or a layer yields."""
    observer = Notes()
    summary = initial(model(Blocks((upper, UP), (WIDE, -UP[::-1])), **contact), observer).summary
    assert "singular_edge_load_fraction" not in summary["contacts"]["joint"]
    assert not [note for note in observer.notes if "singular" in note]


@pytest.mark.parametrize(
    ("name", "rounded"),
    [("punch-on-block", ('geometry.edge_radius="1 mm"',)), ("rectangular-punch", None)],
)
def test_a_contact_face_that_ends_with_the_punch(name, rounded):
    """requirement: an edge is as singular where the smooth surface under it goes on beyond the
    contact face; the pressure off it is the same on other meshes. Rounded edges are not.
    """
    settings = "analysis.type=initial", "mesh.degree=2"
    coarse, fine = (tw.run(starter(name, *settings, f"mesh.elements={n}")).summary for n in (8, 12))
    assert coarse["singular_edge_load_fraction"] > fine["singular_edge_load_fraction"] > 0.0
    assert fine["max_pressure_off_singular_edges_Pa"] < 0.7 * fine["max_pressure_Pa"]
    if rounded is not None:
        assert (
            "singular_edge_load_fraction" not in tw.run(starter(name, *settings, *rounded)).summary
        )
