"""Hertz's contact of a sphere in space by thermowear and by GetFEM, on the same mesh file.

A quarter of a half sphere of 10 mm is pressed by 6.4 µm on a block, without friction; both bodies
are graded quadratic tetrahedra from gmsh whose faces do not match (`verification.quarter_meshes`).
Both programs use displacements of degree 2, pressures of degree 1 on the triangles of the sphere,
MUMPS and one thread. Then the approach grows in 20 steps of 1 %. Each program runs in a process of
its own; its wall and processor time and its largest memory are measured from outside, those of the
parts inside. The first solution begins with the mesh file and ends with the pressure. Forms of
thermowear are compiled before. Where other programs are at work, processor times count.

thermowear solves by both of its condensed methods: weak contact, whose pressures are those of the
pressure space, and contact at each point. Last, weak contact on a mesh of fewer elements that are
smaller at the edge of the contact.

Errors are relative to an axisymmetric run of bodies of the same sizes (degree 8). That of the force
is of the first approach. The others are means over the first approach and the further steps that
GetFEM computes, as the edge of the contact passes through the elements: of the largest pressure, of
the radius by the second moments ``a² = 5/2 ∫ p r² dA / F``, and of the pressure on the face (L²),
all to the half ellipsoid of that run, grown by Hertz's formulas to the force that was found.
The L² errors are integrated at contact points (thermowear) or at 112 points a facet (GetFEM);
one common rule gives the same to 1 %. GetFEM's traction is not its multiplier p, of degree 1, but
``(p - r gap)₊``, whose error is printed below the table.

    export THERMOWEAR_EXTRA_PACKAGES=python3-getfem
    scripts/env python3 -m tests.benchmarks.hertz_3d_peers [--inside 0.08] [--edge 0.032]
        [--steps 4]
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before anything loads a BLAS
os.environ["SCOTCH_PTHREAD_NUMBER"] = "1"  # orders the unknowns of GetFEM's MUMPS

import argparse
import importlib
import json
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from unittest import mock

import numpy as np

from thermowear import geometry  # noqa: F401  (makes the geometries known)
from thermowear.case import load
from thermowear.geometry.mesh.nodes import reference_nodes
from thermowear.reference.elastic_contact.hertz import contact_modulus, elliptical_contact
from thermowear.verification.check import run_starter
from thermowear.verification.quarter_meshes import NAMES, MeshSizes, sphere_on_block, write_pair

BALL, BLOCK = 10.0, 12.0
"""Radius of the sphere, and radius and depth of the block [mm]."""
YOUNG, POISSON = 210e9, 0.3
APPROACH, STEPS, INCREMENT = 6.4e-6, 20, 6.4e-8
"""First approach, number of further steps, and approach of each [m]."""
GRADED = 0.1, 0.027
"""Element sizes in the contact and at its edge, by its radius, of a mesh with fewer elements."""
SETTINGS = """GetFEM: small displacements; symmetric augmented Lagrangian in the assembly language
(add_nonlinear_term, symmetric MUMPS), r = 10 E/width of the contact (1 and 100 take as many or more
Newton steps); faces paired by an interpolate transformation, [X(1); X(2); 0]; 5 points a cell, 7 a
facet; supports by penalties that move them by less than 1e-6 of the approach; lengths in µm,
stresses over E; Newton's method from the moved sphere, whole steps, to 1e-6 of the force. Tried and
slower or less accurate: penalty instead of multipliers (r = 100: peak 0.7 % low, 10 Newton steps;
1000: oscillates, 19), conjugate gradients with ILDLT (no solution in 15 times the time).
"""


def case_of(path: str, method: str = "condensed"):
    steel = {"young_modulus": f"{YOUNG} Pa", "poisson_ratio": POISSON}
    return load(
        {
            "title": "Hertz's contact of a sphere",
            "model": "3d",
            "geometry": {"type": "file", "path": path} | NAMES,
            "mesh": {"degree": 2},
            "contact": {"method": method},
            "bodies": {"upper": steel, "lower": {"like": "upper"}},
            "load": {"approach": f"{APPROACH} m"},
            "analysis": {"type": "initial"},
        }
    )


class Clock:
    """Wall and processor seconds of parts of a computation."""

    def __init__(self):
        self.parts: dict[str, tuple[float, float]] = {}
        self._last = time.perf_counter(), time.process_time()

    def part(self, name: str) -> None:
        """Everything since the last call, or since the clock was made."""
        now = time.perf_counter(), time.process_time()
        self.parts[name] = now[0] - self._last[0], now[1] - self._last[1]
        self._last = now

    def skip(self) -> None:
        """Leave out everything since the last call."""
        self._last = time.perf_counter(), time.process_time()


# ---- thermowear ----------------------------------------------------------------------------------


def by_thermowear(path: str, reference: dict, steps: int, method: str = "condensed") -> dict:
    """First solution and all further steps; errors of the first and some steps."""
    from mpi4py import MPI

    from thermowear.simulation.from_case import model_of
    from thermowear.simulation.interface.interface_problem import interface_problem
    from thermowear.simulation.system.building import build
    from thermowear.timer import Phases

    case, clock = case_of(path, method), Clock()
    mesh = case.tagged_mesh()
    clock.part("mesh file")
    with mock.patch.object(type(case), "tagged_mesh", return_value=mesh):
        system = build(model_of(case), MPI.COMM_WORLD, Phases())
    clock.part("pairing, assembly, factor")
    problem = interface_problem(system)
    clock.part("condensation")
    first = problem.unworn().contact
    clock.part("contact")
    states, further = [first], Clock()
    for step in range(1, STEPS + 1):
        lowered = -step * INCREMENT * system.holder.closure[:, 0]
        states.append(problem.worn(lowered, states[-1]))
    further.part("steps")
    x, y = system.pairing.points[:, :2].T
    w, square = system.weights, x**2 + y**2
    along = 4 * w * system.holder.force_response[:, 0]
    forces, errors = [float(along @ state.pressure) for state in states], []
    for state, force in list(zip(states, forces, strict=True))[: steps + 1]:
        known, p = Known.of(reference, force), state.pressure
        exact = known.peak * np.sqrt(np.maximum(1 - square / known.radius**2, 0.0))
        largest = p.max() if method == "pointwise" else state.warm_start.coefficients.max()
        radius = sqrt(2.5 * (w @ (p * square)) / (w @ p))
        errors.append(known.errors(largest, radius, 4 * (w @ (p - exact) ** 2)))
    return {
        "unknowns": system.elastic.fixed.size,
        "pressures": system.basis.shape[1],
        "forces": forces,
        "errors": errors,
        "first": clock.parts,
        "further": further.parts,
        "newton": None,
    }


@dataclass(frozen=True)
class Known:
    """Peak [Pa] and radius [m] of the half ellipsoid of a force, which grow with its cube root."""

    peak: float
    radius: float

    @classmethod
    def of(cls, reference: dict, force: float):
        grown = (force / reference["forces"][0]) ** (1 / 3)
        return cls(grown * reference["peak"], grown * reference["radius"])

    def errors(self, peak: float, radius: float, square: float) -> tuple[float, float, float]:
        """Relative errors of peak, radius and pressure, that from its squared norm [Pa² m²]."""
        norm = self.peak * self.radius * sqrt(np.pi / 2)
        return off(peak, self.peak), off(radius, self.radius), sqrt(square) / norm


# ---- GetFEM --------------------------------------------------------------------------------------

UNIT = 1e6
"""Its lengths in a metre; stresses are divided by Young's modulus."""
SUPPORT, PLANES = 1.0, 1e3
"""Stiffness of the ends, and of the planes of symmetry, over E [1/µm]."""
RESIDUAL = 1e-6
"""Of the residual, relative to the force of the contact."""


def by_getfem(path: str, reference: dict, steps: int) -> dict:
    """First solution and some further steps."""
    gf, case, clock = importlib.import_module("getfem"), case_of(path), Clock()
    gf.util_trace_level(0)
    mesh = case.tagged_mesh()
    meshes = [
        getfem_mesh(gf, mesh, body, [f"{body.upper()}_FACE", f"{body.upper()}_END", "X0", "Y0"])
        for body in ("upper", "lower")
    ]
    clock.part("mesh file")
    model = getfem_model(gf, meshes, 2 * UNIT * reference["radius"])
    clock.part("spaces and model")
    newton = [solve(model, reference)]
    clock.part("Newton")

    rule = gf.Integ("IM_STRUCTURED_COMPOSITE(IM_TETRAHEDRON(5),4)")
    on_face = gf.MeshIm(meshes[0], rule)  # 112 points a facet, where the solution used 7

    def total(density: str) -> float:
        return float(np.ravel(gf.asm_generic(on_face, 0, density, 1, model))[0])

    square, errors, tractions = "(X(1)*X(1) + X(2)*X(2))", [], []
    forces, tensions = [], []

    def measure() -> None:
        forces.append(-4 * YOUNG / UNIT**2 * total("p*Normal(3)"))
        tensions.append(-4 * YOUNG / UNIT**2 * total("neg_part(p)*Normal(3)"))
        known = Known.of(reference, forces[-1])
        radius, peak = UNIT * known.radius, known.peak / YOUNG
        exact = f"{peak!r}*sqrt(pos_part(1 - {square}/{radius**2!r}))"
        largest = YOUNG * float(model.variable("p").max())
        found = sqrt(2.5 * total(f"p*Normal(3)*{square}") / total("p*Normal(3)")) / UNIT
        for values, list_ in (("p", errors), ("pressed", tractions)):
            norm = 4 * total(f"sqr({values} - {exact})") * (YOUNG / UNIT) ** 2
            list_.append(known.errors(largest, found, norm))

    measure()
    further = Clock()
    for step in range(1, steps + 1):
        model.set_variable("push", [0, 0, -UNIT * (APPROACH + step * INCREMENT)])
        newton.append(solve(model, reference))
        further.part(f"step {step}")
        measure()
        further.skip()
    return {
        "unknowns": len(model.variable("u1")) + len(model.variable("u2")),
        "pressures": len(model.variable("p")),
        "errors": errors,
        "tractions": tractions,
        "forces": forces,
        "tensions": tensions,
        "first": clock.parts,
        "further": further.parts,
        "newton": newton,
    }


def getfem_mesh(gf, mesh, body: str, surfaces: list[str]):
    """One body with the same curved cells; surfaces become regions 1, 2, …"""
    transformation = gf.GeoTrans("GT_PK(3,2)")
    cells = mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]
    places, target = reference_nodes("tetrahedron", 2), transformation.pts().T
    order = np.linalg.norm(places - target[:, None], axis=2).argmin(axis=1)
    result = gf.Mesh("empty", 3)
    nodes = UNIT * mesh.points[cells[:, order]]
    result.add_convex(transformation, np.asfortranarray(nodes.transpose(2, 1, 0)))
    outside = result.outer_faces().T @ [10, 1]
    for number, surface in enumerate(surfaces, start=1):
        facets = mesh.facets_of(surface)
        facets = facets[np.isin(facets[:, 0], cells)]
        points = np.asfortranarray(UNIT * mesh.points[np.unique(facets)].T)
        faces = result.faces_from_pid(result.pid_from_coords(points, 1e-3))
        faces = faces[:, np.isin(faces.T @ [10, 1], outside)]
        assert faces.shape[1] == len(facets)
        result.set_region(number, faces)
    return result


def getfem_model(gf, meshes: list, width: float):
    """The model with its start."""
    model = gf.Model("real")
    model.add_initialized_data("lame", POISSON / (1 + POISSON) / (1 - 2 * POISSON))
    model.add_initialized_data("shear", 0.5 / (1 + POISSON))
    model.add_initialized_data("push", [0, 0, -UNIT * APPROACH])
    for u, mesh, given in zip(("u1", "u2"), meshes, (("push",), ()), strict=True):
        space, cells = gf.MeshFem(mesh, 3), gf.MeshIm(mesh, gf.Integ("IM_TETRAHEDRON(3)"))
        space.set_classical_fem(2)
        model.add_fem_variable(u, space)
        model.add_isotropic_linearized_elasticity_brick(cells, u, "lame", "shear")
        model.add_Dirichlet_condition_with_penalization(cells, u, SUPPORT, 2, *given)
        for axis, region in ((1, 3), (2, 4)):
            across = f"{PLANES}*{u}({axis})*Test_{u}({axis})"
            model.add_linear_term(cells, across, region, True, True)
    nodes = len(model.variable("u1")) // 3
    model.set_variable("u1", np.tile([0, 0, -UNIT * APPROACH], nodes))
    pressures = gf.MeshFem(meshes[0], 1)
    pressures.set_classical_fem(1)
    model.add_filtered_fem_variable("p", pressures, 1)
    model.add_interpolate_transformation_from_expression("below", *meshes, "[X(1); X(2); 0]")
    model.add_initialized_data("r", 10 / width)
    model.add_macro("gap", "(Interpolate(X, below) + Interpolate(u2, below) - X - u1).Normal")
    model.add_macro("closing", "(Test_u1 - Interpolate(Test_u2, below)).Normal")
    model.add_macro("pressed", "pos_part(p - r*gap)")
    on_face = gf.MeshIm(meshes[0], gf.Integ("IM_TETRAHEDRON(5)"))
    lagrangian = "pressed*closing - (p - pressed)/r*Test_p"
    model.add_nonlinear_term(on_face, lagrangian, 1, True)
    return model


def solve(model, reference: dict) -> int:
    """Newton's method; returns its steps."""
    # GetFEM's residual is relative to the loads, here that of the support in the sum of magnitudes
    end = np.pi / 4 * (UNIT * 1e-3 * BALL) ** 2
    force = reference["forces"][0] / 4 / YOUNG * UNIT**2
    accepted = RESIDUAL * force / (SUPPORT * UNIT * APPROACH * end)
    settings = "max_iter", 60, "lsearch", "simplest", "alpha min", 1.0, "lsolver", "mumps"
    steps, converged = model.solve("max_res", accepted, *settings)
    if not converged:
        raise RuntimeError(f"GetFEM: no solution in {steps} Newton steps")
    return int(steps)


# ---- report --------------------------------------------------------------------------------------


def axisymmetric() -> dict:
    """Converged values of bodies of the same sizes, the radius by the second moment."""
    sizes = (f"geometry.radius={BALL} mm", f"geometry.block_radius={BLOCK} mm")
    sizes += (f"geometry.block_height={BLOCK} mm", f"load={{approach='{APPROACH} m'}}")
    found = run_starter("sphere-on-block", *sizes, "mesh.degree=8", "mesh.elements=16")
    i, force = found.interface, found.summary["normal_force_N"]
    radius = sqrt(2.5 * np.sum(i.weight * i.pressure * i.x**2) / np.sum(i.weight * i.pressure))
    return {"forces": [force], "peak": found.summary["max_pressure_Pa"], "radius": radius}


PROGRAMS = {"thermowear": by_thermowear, "GetFEM": by_getfem}
"""The first two columns; further ones are thermowear again."""


def measured(program: str, *arguments) -> dict:
    """Run a program in a process of its own, and measure that from outside."""
    request = json.dumps([program, *arguments])
    command = [sys.executable, "-m", "tests.benchmarks.hertz_3d_peers", "--child", request]
    since = time.perf_counter()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        lines = child.stdout.read().splitlines()
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise RuntimeError(f"{program}: exit code {child.returncode}")
    whole = time.perf_counter() - since, used.ru_utime + used.ru_stime
    return json.loads(lines[-1]) | {"whole": whole, "memory": used.ru_maxrss * 1024 / 1e9}


def table(runs: dict[str, dict], reference: dict) -> None:
    """Print times, sizes and errors of all programs; ratios of the second to the others."""
    print(f"{'':40}" + "".join(f"{name:>12}{'ratio':>10}" for name in runs))
    rows = {
        "displacement unknowns": ("{:d}", lambda run: run["unknowns"]),
        "coefficients of the pressure": ("{:d}", lambda run: run["pressures"]),
        "error of the force": ("{:.1e}", lambda run: off(run["forces"][0], reference["forces"][0])),
        "mean error of the peak": ("{:.1e}", lambda run: mean(run["errors"])[0]),
        "mean error of the radius": ("{:.1e}", lambda run: mean(run["errors"])[1]),
        "mean error of the pressure in L²": ("{:.2e}", lambda run: mean(run["errors"])[2]),
        "  of that, first approach": ("{:.2e}", lambda run: run["errors"][0][2]),
        "largest memory [GB]": ("{:.2f}", lambda run: run["memory"]),
    }
    for clock, name in enumerate(("wall [s]", "processor [s]")):
        rows |= {
            f"first solution, {name}": ("{:.2f}", lambda run, k=clock: spent(run["first"], k)),
            f"{STEPS} further steps, {name}": (
                "{:.3f}",
                lambda run, k=clock: spent(run["further"], k) * STEPS / (len(run["forces"]) - 1),
            ),
            f"whole process, {name}": ("{:.1f}", lambda run, k=clock: run["whole"][k]),
        }
    for label, (form, value) in rows.items():
        values = [value(run) for run in runs.values()]
        peer = values[1]
        cells = (f"{form.format(v):>12}{peer / v:>10.3g}" for v in values)
        print(f"{label:40}" + "".join(cells))
    for name, run in runs.items():
        parts = ", ".join(
            f"{part} {wall:.2f} ({cpu:.2f})" for part, (wall, cpu) in run["first"].items()
        )
        print(f"{name}, wall (processor) [s]: {parts}")
        if run["newton"]:
            steps = len(run["newton"]) - 1
            print(f"{name}: Newton steps {run['newton']}; {steps} further steps computed,")
            print(f"    counted {STEPS / steps:g} times; the force after them differs by", end=" ")
            print(f"{off(run['forces'][-1], runs['thermowear']['forces'][steps]):.1e}")
            print(f"    its (p - r gap)₊: mean error in L² {mean(run['tractions'])[2]:.2e}")
            pressed = run["forces"][0] + run["tensions"][0]
            error = off(pressed, reference["forces"][0])
            print(f"    its compressive pressures alone: error of the force {error:.2e}")


def spent(parts: dict, clock: int) -> float:
    return sum(part[clock] for part in parts.values())


def off(found: float, known: float) -> float:
    return abs(found / known - 1)


def mean(errors: list) -> np.ndarray:
    """Means over the approaches."""
    return np.mean(errors, axis=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--inside", type=float, default=0.08, help="element size by the radius")
    parser.add_argument("--edge", type=float, default=0.032, help="element size at the edge")
    parser.add_argument("--steps", type=int, default=4, help="further steps of GetFEM")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        program, *arguments = json.loads(options.child)
        print(json.dumps((PROGRAMS | {"reference": axisymmetric})[program](*arguments)))
        return
    print(SETTINGS, flush=True)
    reference = measured("reference")
    modulus = contact_modulus((YOUNG, POISSON), (YOUNG, POISSON))
    known = elliptical_contact(reference["forces"][0], (1e-3 * BALL,) * 2, modulus)
    print(f"reference over Hertz's formula: peak {reference['peak'] / known.peak:.6f},", end=" ")
    print(f"radius {reference['radius'] / known.half_axes[0]:.6f}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        path, pair = Path(folder, "sphere.msh"), sphere_on_block(BALL, BLOCK)
        axes = (1e3 * reference["radius"],) * 2
        write_pair(path, pair, MeshSizes(axes, 0.4, 0.4))
        measured("thermowear", str(path), reference, 0)  # compiles the forms
        write_pair(path, pair, MeshSizes(axes, options.inside, options.edge))
        given = str(path), reference, options.steps
        runs = {program: measured(program, *given) for program in PROGRAMS}
        runs["pointwise"] = measured("thermowear", *given, "pointwise")
        write_pair(path, pair, MeshSizes(axes, *GRADED))
        runs["other mesh"] = measured("thermowear", *given)
    table(runs, reference)


if __name__ == "__main__":
    main()
