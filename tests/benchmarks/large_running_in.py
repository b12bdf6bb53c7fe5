"""Running-in of large hot bodies in space: time by phase, steps, memory.

    python3 -m tests.benchmarks.large_running_in [--sizes 60 150 400 1000] [--steps 100]
        [--conductance 2e4 | perfect] [--solver auto] [--until-steady]

A pad of friction material slides on a metal disk, here a block: quadratic tetrahedra by gmsh, fine
at the contact and coarser away from it, faces that do not match; about 2 000 pressure coefficients
at 1 M displacement unknowns. Heat is quasi-steady. Sizes are thousands of displacement
unknowns.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from mpi4py import MPI

import thermowear as tw
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.results import Result
from thermowear.simulation.analyses.positioning import prepare
from thermowear.simulation.analyses.run import analyse
from thermowear.simulation.from_case import analysis_of, model_of

from .sizes import Console, run_sizes

PAD, DISK = (40.0, 30.0, 14.0), (56.0, 46.0, 16.0)
"""Sizes of the blocks [mm]; the pad lies in the middle of the disk."""
NAMES = {
    "bodies": {"pad": "PAD", "disk": "DISK"},
    "contact": ["PAD_FACE", "DISK_FACE"],
    "held": "PAD_BACK",
    "fixed": "DISK_BOTTOM",
}
_COARSENING = 0.0575
"""Growth of the size of the cells with the depth in the disk, relative to that at the contact
[1/mm]: nearly as many unknowns in both bodies, and 2 000 pressure coefficients at 1 M unknowns."""
_UNKNOWNS = 0.59e6
"""Displacement unknowns times the cube of the size of the cells at the contact [mm³]; measured."""


def write_mesh(path: Path, thousands: float) -> None:
    """Write the mesh of both blocks for a number of displacement unknowns."""
    size = (_UNKNOWNS / (thousands * 1e3)) ** (1 / 3)
    with gmsh_model("large") as gmsh:
        occ, tags = gmsh.model.occ, []
        for name, sides, bottom in (("PAD", PAD, 0.0), ("DISK", DISK, -DISK[2])):
            tag = occ.addBox(-sides[0] / 2, -sides[1] / 2, bottom, *sides)
            occ.synchronize()
            gmsh.model.addPhysicalGroup(3, [tag], name=name)
            tags.append((name, tag, bottom, bottom + sides[2]))
        ends = {"PAD": ("FACE", "BACK"), "DISK": ("BOTTOM", "FACE")}
        for name, tag, *levels in tags:
            for _, face in gmsh.model.getBoundary([(3, tag)], oriented=False):
                z = occ.getCenterOfMass(2, face)[2]
                for level, end in zip(levels, ends[name], strict=True):
                    if abs(z - level) < 1e-6:
                        gmsh.model.addPhysicalGroup(2, [face], name=f"{name}_{end}")
        field = gmsh.model.mesh.field
        field.add("MathEval", 1)
        field.setString(1, "F", f"{size}*(1 + {_COARSENING}*0.5*(abs(z) - z))")
        field.setAsBackgroundMesh(1)
        for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
            gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
        gmsh.option.setNumber("Mesh.Algorithm3D", 10)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))


def case_tables(mesh: Path, options: argparse.Namespace) -> dict:
    """Case of the running-in."""
    heat = {"cooling": {"PAD_BACK": "500 W/(m^2 K)", "DISK_BOTTOM": "2000 W/(m^2 K)"}}
    if options.conductance != "perfect":
        heat["conductance"] = f"{options.conductance} W/(m^2 K)"
    analysis: dict = {"type": "transient", "max_steps": options.steps}
    analysis |= {"until": "steady"} if options.until_steady else {"end_time": "3e6 s"}
    metal = {"young_modulus": "110 GPa", "poisson_ratio": 0.3, "expansion": "1.1e-5 1/K"}
    pad = {"young_modulus": "1 GPa", "poisson_ratio": 0.25, "expansion": "1.4e-5 1/K"}
    return {
        "model": "3d",
        "geometry": {"type": "file", "path": str(mesh), "length_unit": "1 mm"} | NAMES,
        "mesh": {"degree": 2, "solver": options.solver},
        "bodies": {
            "pad": pad | {"conductivity": "5 W/(m K)"},
            "disk": metal | {"conductivity": "50 W/(m K)"},
        },
        "load": {"force": "3 kN"},
        "motion": {"velocity": "0.2 m/s"},
        "contact": {"friction": 0.3},
        "wear": {"update": "never", "pad": {"coefficient": "1e-14 1/Pa", "per": "friction-stress"}},
        "heat": heat,
        "analysis": analysis,
    }


def solved(thousands: float, options: argparse.Namespace, console: Console) -> tuple[Result, dict]:
    """Running-in of one size."""
    phases = console.phases
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "blocks.msh"
        with phases("make mesh"):
            write_mesh(mesh, thousands)
        case = tw.load(case_tables(mesh, options))
        system = prepare(model_of(case), MPI.COMM_WORLD, phases)
        started = time.perf_counter()
        _, result = analyse(system, analysis_of(case), console)
    return result, {
        "pressure_coefficients": system.basis.shape[1],
        "time_s": result.history[-1].time,
        "stopped": str(result.stopped),
        "analysis_seconds": time.perf_counter() - started,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--until-steady", action="store_true")
    run_sizes("large_running_in", parser, solved, ("processor_seconds", "memory_GB"))


if __name__ == "__main__":
    main()
