"""The model of a case on a user's mesh, with a user's own tags."""

from dataclasses import fields, replace

from mpi4py import MPI

import numpy as np

import thermowear as tw
from thermowear.bulk.bodies import created_mesh, distributed_tags, in_dolfinx_order
from thermowear.geometry.mesh.tagged import compact
from thermowear.simulation.from_case import model_of

from ..case.starter import tables

CELLS, FACETS = (101, 205, 7, 33), (41, 7, 32, 205, 5, 90, 11, 3, 77, 14, 60)
"""Tags in the place of 1, 2, 3, …"""


def own_mesh(tagged):
    """A dolfinx mesh with the user's tags, as read from a file: mesh, cell tags, facet tags."""
    cells = in_dolfinx_order(tagged, tagged.cell_type, tagged.cells)
    facets = in_dolfinx_order(tagged, tagged.facet_type, tagged.facets)
    if MPI.COMM_WORLD.rank:
        cells, facets = cells[:0], facets[:0]
    points = tagged.points if MPI.COMM_WORLD.rank == 0 else tagged.points[:0]
    mesh = created_mesh(MPI.COMM_WORLD, tagged.cell_type, tagged.order, cells, points)
    tdim = mesh.topology.dim
    own_tags = (
        (tdim, cells, tagged.cell_tags, CELLS),
        (tdim - 1, facets, tagged.facet_tags, FACETS),
    )
    return mesh, *(
        distributed_tags(mesh, dim, entities, np.array([0, *own], np.int32)[tags[: len(entities)]])
        for dim, entities, tags, own in own_tags
    )


def alone(tagged, parts):
    """The mesh of one body."""
    own = np.isin(tagged.cell_tags, [tagged.bodies.index(part) + 1 for part in parts])
    on_it = np.isin(tagged.facets, tagged.cells[own]).all(axis=1)
    cut = replace(tagged, cells=tagged.cells[own], cell_tags=tagged.cell_tags[own])
    return compact(replace(cut, facets=tagged.facets[on_it], facet_tags=tagged.facet_tags[on_it]))


def python_model(name, *overrides, apart=False, backwards=False):
    """Model in Python of a starter case, its interface, and the case itself.

    Parameters
    ----------
    apart : bool
        A mesh for each body, in place of one for both.
    backwards : bool
        Body 2 is made and named first.
    """
    case = tw.load(tables(name), overrides)
    known, tagged = model_of(case), case.tagged_mesh()
    whole = None if apart else own_mesh(tagged)
    tag_of = dict(zip(tagged.surfaces, FACETS, strict=False))
    bodies = {}
    for body in known.bodies[:: -1 if backwards else 1]:
        mesh, cells, facets = own_mesh(alone(tagged, body.parts)) if apart else whole
        materials = {CELLS[tagged.bodies.index(p)]: m for p, m in body.materials.items()}
        fixed = () if body is known.bodies[0] else tuple(tag_of[s] for s in body.fixed)
        guided = (tuple(tag_of[s] for s in own) for own in (body.rollers, body.mid_plane))
        bodies[body.name] = tw.Body(body.name, mesh, cells, facets, materials, fixed, *guided)
    held, other = (bodies[body.name] for body in known.bodies)

    def surface(name):
        body = next(b for b in known.bodies if name in (*b.surfaces, *b.fixed, *b.rollers))
        return bodies[body.name].surface(tag_of[name])

    given, holder, motion = known.interface, known.holder, known.motion
    faces = [held.surface(tag_of[given.faces[0]]), other.surface(tag_of[given.faces[1]])]
    face = tw.Interface(
        *faces[:: -1 if backwards else 1],
        friction=given.friction,
        conductance=given.conductance,
        wear={bodies[known.bodies[i].name]: wear for i, wear in given.wear.items()},
        partition=given.partition,
    )
    motions = {}
    if motion.velocity is not None:
        motions = {held: tw.Translation(motion.velocity, motion.across)}
    elif motion.center is not None:
        motions = {other: tw.Rotation(motion.angular_velocity, motion.center)}
    elif motion.angular_velocity is not None:
        motions = {held: tw.Rotation(motion.angular_velocity)}
    heat = known.heat
    if heat is not None:
        by_name = {f.name: getattr(heat, f.name) for f in fields(heat)}
        for key in ("cooling", "temperature", "flux", "power"):
            by_name[key] = {surface(s): value for s, value in by_name[key].items()}
        heat = tw.Heat(**by_name)
    own = {f.name for f in fields(holder)} - {"load_direction", "bodies", "name", "hanging"}
    loads = {name: getattr(holder, name) for name in own}
    model = tw.Model(
        [face],
        [tw.Holder(surface(case.geometry.held), **loads)],
        motions,
        heat,
        kinematics=None if known.kinematics == "3d" else known.kinematics,
        thickness=known.thickness,
        symmetry=[surface(s) for s in known.symmetry],
        degree=known.discretisation.degree,
    )
    return model, face, case


def same(found, known, bound=1e-12):
    """The interface fields of two results agree to rounding; points in any order."""
    order, other = (
        np.lexsort([np.round(1e9 * c) for c in (r.interface.y, r.interface.x)])
        for r in (found, known)
    )
    for field in fields(known.interface):
        one = getattr(found.interface, field.name)[order]
        two = getattr(known.interface, field.name)[other]
        scale = np.nanmax(np.abs(two), initial=0.0)
        np.testing.assert_allclose(one, two, rtol=0.0, atol=bound * scale, err_msg=field.name)
