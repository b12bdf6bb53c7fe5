"""The hot ring of the starter case on a mesh with a user's own tags."""

from dataclasses import fields, replace

from mpi4py import MPI

import dolfinx
import numpy as np

import thermowear as tw
from thermowear.bulk.bodies import distribute
from thermowear.geometry.mesh.orders import compact

from ..case.starter import STEADY, tables

COARSE = ("mesh.degree=3", "mesh.elements=6")
IN_TIME = ("analysis.type=transient", "analysis.end_time=200 s")
CELLS = {"punch": 205, "plate": 101}
FACETS = {"punch_top": 7, "punch_face": 32, "plate_face": 5, "plate_bottom": 90}
FORCE = f"{50e6 * np.pi * (0.12**2 - 0.02**2)!r} N"


def case(*overrides):
    """The case that the model in Python is compared with."""
    return tw.load(tables(STEADY), (*COARSE, *overrides))


def own_mesh(tagged):
    """A dolfinx mesh with the user's tags, as read from a file."""
    found = distribute(tagged, MPI.COMM_WORLD)
    mesh, tdim = found.mesh, found.mesh.topology.dim
    return mesh, *(
        dolfinx.mesh.meshtags(mesh, dim, tags.indices, renamed(tags.values, names, own))
        for dim, tags, names, own in (
            (tdim, found.cell_tags, found.names, CELLS),
            (tdim - 1, found.facet_tags, found.surfaces, FACETS),
        )
    )


def renamed(values, names, own):
    """Tags of the user."""
    return np.array([0, *(own.get(name, 1000) for name in names)], dtype=np.int32)[values]


def alone(tagged, body):
    """The mesh of one body."""
    tag = tagged.bodies.index(body) + 1
    cells = tagged.cells[tagged.cell_tags == tag]
    own = np.isin(tagged.facets, cells).all(axis=1)
    return compact(
        replace(
            tagged,
            cells=cells,
            cell_tags=np.full(len(cells), tag, dtype=np.int32),
            facets=tagged.facets[own],
            facet_tags=tagged.facet_tags[own],
        )
    )


def steel():
    return tw.Material("200 GPa", 0.3, expansion="1.2e-5 1/K", conductivity="50 W/(m K)")


def ring(first=("plate", "punch"), apart=False, other_first=True, **changes):
    """The model; bodies are made in the order of `first`, of one mesh or of one for each."""
    tagged = case().tagged_mesh()
    whole = None if apart else own_mesh(tagged)
    bodies = {}
    for name in first:
        mesh, cells, facets = own_mesh(alone(tagged, name)) if apart else whole
        fixed = {"fixed": FACETS["plate_bottom"]} if name == "plate" else {}
        bodies[name] = tw.Body(name, mesh, cells.find(CELLS[name]), facets, steel(), **fixed)
    punch, plate = bodies["punch"], bodies["plate"]
    top, bottom = punch.surface(FACETS["punch_top"]), plate.surface(FACETS["plate_bottom"])
    faces = punch.surface(FACETS["punch_face"]), plate.surface(FACETS["plate_face"])
    face = tw.Interface(
        *(reversed(faces) if other_first else faces),
        friction=0.25,
        conductance="1e6 W/(m^2 K)",
        wear={punch: tw.PowerWear(2e-13 * 0.25)},
    )
    given = {
        "interfaces": [face],
        "holders": [tw.Holder(top, force=FORCE)],
        "motions": {punch: tw.Rotation("0.1 rad/s")},
        "heat": tw.Heat(cooling={top: "2000 W/(m^2 K)", bottom: 2000.0}),
        "kinematics": "axisymmetric",
        "degree": 3,
    }
    return tw.Model(**(given | changes)), bodies, face


def same(found, known, bound=1e-12):
    """The interface fields of two results agree to rounding."""
    for field in fields(known.interface):
        one, two = (getattr(result.interface, field.name) for result in (found, known))
        scale = np.nanmax(np.abs(two), initial=0.0)
        np.testing.assert_allclose(one, two, rtol=0.0, atol=bound * scale, err_msg=field.name)
