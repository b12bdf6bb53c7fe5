"""A model in Python on the ranks of mpirun: its results, or the message of a fault, by rank."""

import sys
from dataclasses import fields, replace
from itertools import islice
from pathlib import Path
from pickle import PicklingError

from mpi4py import MPI

import dolfinx
import numpy as np

import thermowear as tw
from thermowear.parallel import on_root

from ..case.starter import STEADY
from .from_case import python_model

COARSE = ("mesh.degree=3", "mesh.elements=6")


def computed():
    """Steady state of the hot ring: columns of the interface, and a sum over each body."""
    model, _, _ = python_model(STEADY, *COARSE)
    steady = model.steady()
    interface = steady.result.interface
    columns = {f.name: getattr(interface, f.name) for f in fields(interface)}
    return columns | {body.name: cell_sum(steady.temperature(body), body) for body in model.bodies}


def cell_sum(temperature, body):
    """Temperatures in the middle of the cells of a body, weighted by the squares of their sizes."""
    mesh, own = body.mesh, np.flatnonzero(body.part_of_cells() >= 0)
    at_middle = dolfinx.fem.Function(dolfinx.fem.functionspace(mesh, ("DG", 0)))
    at_middle.interpolate(temperature)
    weights = mesh.h(mesh.topology.dim, own.astype(np.int32)) ** 2
    return mesh.comm.allreduce(at_middle.x.array[own] @ weights)


def faulty(kind):
    """A model of which one body has no cells, or is bent out of its plane."""
    model, face, _ = python_model(STEADY, *COARSE, apart=True)
    punch, plate = model.bodies
    if kind == "empty":
        other = replace(plate, cells=np.zeros(0, dtype=np.int32), materials=tw.Material(2e11, 0.3))
    else:
        plate.mesh.geometry.x[:, 2] += plate.mesh.geometry.x[:, 0] ** 2
        other = replace(plate)
    pair = tw.Interface(punch.surface(face.one.tag), other.surface(face.other.tag))
    return replace(model, interfaces=[pair], heat=None)


def saved(folder):
    """Pressures of a running-in after a saved state, continued from it and from its file."""
    model, face, _ = python_model(STEADY, *COARSE)
    state = list(islice(model.march("200 s"), 3))[1]
    state.save(folder / "state.npz")
    ways = {"state": state, "read": folder / "state.npz"}
    following = {name: next(model.march("200 s", start=start)) for name, start in ways.items()}
    return {name: np.append(np.asarray(s.pressure(face)), s.time) for name, s in following.items()}


if __name__ == "__main__":
    kind, folder = sys.argv[1], Path(sys.argv[2])
    rank = MPI.COMM_WORLD.rank
    runs = {
        "steady": computed,
        "saved": lambda: saved(folder),
        "unsendable": lambda: on_root(MPI.COMM_WORLD, lambda: lambda: 0),
    }
    try:
        found = runs[kind]() if kind in runs else faulty(kind)
    except (tw.CaseError, AttributeError, PicklingError) as fault:
        (folder / f"fault_{rank}.txt").write_text(str(fault))
    else:
        np.savez(folder / f"found_{rank}.npz", **found)
