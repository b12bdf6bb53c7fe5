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
from thermowear.geometry.mesh.tagged import compact
from thermowear.parallel import on_root
from thermowear.verification.cases.contact.contact_methods import HEIGHTS, MODULI, PRESSURE
from thermowear.verification.cases.contact.patch_in_space import SIZE, PatchInSpace

from ..case.starter import STEADY
from .from_case import own_mesh, python_model

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


def mixed(orders=(1, 2), tetrahedra=(True, False)):
    """Two blocks of different cells in series: errors of temperatures and displacements by body.

    Relative to the largest differences; also the pressures over the exact one.
    """
    meshes = PatchInSpace(columns=(2, 3), orders=orders, tetrahedra=tetrahedra).build(None)
    bodies, heights = [], {"upper": HEIGHTS[0], "lower": HEIGHTS[1]}
    for block, (name, height), E in zip(meshes.blocks, heights.items(), MODULI, strict=True):
        mesh, _, facets = own_mesh(compact(block))
        material = tw.Material(E, 0.0, conductivity=1e3 * height)
        bodies.append(tw.Body(name, mesh, None, facets, material, () if name == "upper" else 205))
    upper, lower = bodies
    face, top, bottom = upper.surface(41), upper.surface(7), lower.surface(205)
    pair = tw.Interface(lower.surface(32), face, wear={upper: tw.PowerWear(1e-15)})
    holder = tw.Holder(top, force=PRESSURE * SIZE[0] * SIZE[1])
    heat = tw.Heat(temperature={top: "340 K", bottom: "300 K"})
    found = tw.Model([pair], [holder], heat=heat, degree=2).initial()
    result = {"pressure": np.asarray(found.pressure(pair)) / PRESSURE}
    for body in bodies:
        T, u = found.temperature(body), found.displacement(body)
        z = T.function_space.tabulate_dof_coordinates()[:, 2]
        expected = 320 + 20 * z / heights[body.name]
        result[f"{body.name} T"] = (T.x.array - expected) / 20
        z = u.function_space.tabulate_dof_coordinates()[:, 2]
        moved = np.zeros((len(z), 3))
        moved[:, 2] = -PRESSURE * (np.minimum(z, 0.0) + HEIGHTS[1]) / MODULI[1]
        moved[:, 2] -= PRESSURE * np.maximum(z, 0.0) / MODULI[0]
        result[f"{body.name} u"] = (u.x.array.reshape(-1, 3) - moved) / np.abs(moved).max()
    return result


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
        "mixed": mixed,
        "saved": lambda: saved(folder),
        "unsendable": lambda: on_root(MPI.COMM_WORLD, lambda: lambda: 0),
    }
    try:
        found = runs[kind]() if kind in runs else faulty(kind)
    except (tw.CaseError, AttributeError, PicklingError) as fault:
        (folder / f"fault_{rank}.txt").write_text(str(fault))
    else:
        np.savez(folder / f"found_{rank}.npz", **found)
