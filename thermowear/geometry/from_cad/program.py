"""Program that meshes CAD files, run by `meshing_process` in a process of its own.

OpenCASCADE may crash, hang or exhaust the memory on a malformed file: memory and processor time are
limited, and no file can be written. The request is read from the standard input, the mesh is
written to the standard output as ``.npz``.
"""

from __future__ import annotations

import io
import itertools
import json
import os
import pickle
import sys
from dataclasses import asdict

import numpy as np

from .meshing import make_mesh, mesh_arrays, refinement, set_sizes
from .request import CadError, CadRequest
from .solids import CadBody, CadFace, chosen_faces, read_bodies
from .touching import common_faces, curved_places, touching_faces

Surfaces = dict[str, dict[str, list[CadFace]]]


def meshed(gmsh, request: CadRequest) -> dict[str, np.ndarray]:
    """Arrays of the mesh, see `mesh_arrays`, and the names in ``contents``."""
    bodies, surfaces = _read(gmsh, request)
    contacts = []
    for names in request.faces:
        sides = _sides(surfaces, names)
        zones = [zone for zone in request.zones if zone.faces == names]
        contacts.append(refinement(sides, [bodies[side[0].body] for side in sides], zones))
    set_sizes(gmsh, list(bodies.values()), contacts)
    make_mesh(gmsh, list(bodies.values()))
    contents = {
        "solids": [[list(solid.names) for solid in body.solids] for body in bodies.values()],
        "surfaces": list(surfaces),
    }
    arrays = mesh_arrays(gmsh, list(bodies.values()), surfaces)
    return arrays | {"contents": np.array(json.dumps(contents))}


def touching(gmsh, request: CadRequest) -> dict[str, np.ndarray]:
    """Pairs of bodies that touch in ``contents``."""
    bodies = read_bodies(gmsh, request.bodies)
    pairs = [
        pair
        for pair in itertools.combinations(bodies, 2)
        if any(common_faces(gmsh, bodies[pair[0]], bodies[pair[1]], request.tolerance))
    ]
    return {"contents": np.array(json.dumps(pairs))}


def curved(gmsh, request: CadRequest) -> dict[str, np.ndarray]:
    """Places where faces in contact curve against each other in ``contents``."""
    bodies, surfaces = _read(gmsh, request)
    places = curved_places(gmsh, [_sides(surfaces, names) for names in request.faces], bodies)
    return {"contents": np.array(json.dumps([asdict(place) for place in places]))}


def _read(gmsh, request: CadRequest) -> tuple[dict[str, CadBody], Surfaces]:
    """Bodies, and the faces of all surfaces."""
    bodies = read_bodies(gmsh, request.bodies)
    surfaces: Surfaces = {
        surface.name: chosen_faces(gmsh, surface, bodies) for surface in request.surfaces
    }
    for touch in request.touching:
        found = touching_faces(gmsh, touch, bodies, request.tolerance)
        for name, body, faces in zip(touch.names, touch.bodies, found, strict=True):
            surfaces[name] = {body: faces}
    return bodies, surfaces


def _sides(surfaces: Surfaces, names: tuple[str, str]) -> tuple[list[CadFace], list[CadFace]]:
    """Faces of both bodies in a contact."""
    first, second = (next(iter(surfaces[name].values())) for name in names)
    return first, second


def _set_limits(memory: int, seconds: int) -> None:
    """Limit memory [bytes] and processor time [s] of this process, and forbid writing of files."""
    import resource

    for limit, most in (
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
    ):
        _, hard = resource.getrlimit(limit)
        bound = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(limit, (bound, hard))


_TASKS = {"mesh": meshed, "touching": touching, "curved": curved}


def main(task: str, memory: str, seconds: str) -> int:
    """Write the arrays, or one line with the reason of a failure."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of OpenCASCADE goes to stderr
    request = pickle.load(sys.stdin.buffer)  # from the process that started this one
    _set_limits(int(memory), int(seconds))
    import gmsh

    try:
        gmsh.initialize(["-noenv"], interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        packed = io.BytesIO()
        np.savez(packed, allow_pickle=False, **_TASKS[task](gmsh, request))
    except MemoryError:
        reason = "geometry.path: meshing the CAD files exceeds the memory limit"
    except CadError as error:
        reason = " ".join(str(error).split())
    except Exception as error:  # gmsh and readers of malformed files raise any exception
        reason = f"{request.bodies[0].key}: the CAD files cannot be meshed: "
        reason += " ".join(str(error).split()) or type(error).__name__
    else:
        out.write(packed.getbuffer())
        out.close()
        return 0
    sys.stderr.write(f"\n{reason}")
    return 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
