"""Hertz's line contact by thermowear and by GetFEM, on the same meshes and in one process.

A half cylinder is pressed on a block by 0.05 mm, without friction. Both programs use the same
curved cells, displacements of degree 2 and pressures of degree 1 on the face of the cylinder, and
MUMPS on one thread. What is timed begins with a mesh in memory and ends with the pressure; then
the approach grows in small steps. Forms are compiled before.

Last, thermowear as it is meant to be used: few elements of high degree whose ends lie at the edges
of the contact, at no larger errors of peak and force; meshing and positioning are in the time.

    export THERMOWEAR_EXTRA_PACKAGES=python3-getfem
    scripts/env python3 tests/benchmarks/hertz_getfem.py             # 27 k displacement values
    scripts/env python3 tests/benchmarks/hertz_getfem.py --large     # 250 k too: minutes
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before anything loads a BLAS

import argparse
import importlib
import importlib.metadata
import time
import tomllib
from dataclasses import dataclass, field
from math import pi, sqrt
from unittest import mock

from mpi4py import MPI

import numpy as np

from thermowear import geometry  # noqa: F401  (makes the geometries known)
from thermowear.case import load
from thermowear.case.starters import starter_text
from thermowear.geometry.orders import reference_nodes
from thermowear.reference.hertz import contact_modulus
from thermowear.simulation.phases import Phases
from thermowear.simulation.preparation import interface_problem, prepare
from thermowear.simulation.system import build

gf = importlib.import_module("getfem")  # not in scripts/packages: it serves here only

RADIUS, THICKNESS, APPROACH = 10e-3, 1e-3, 5e-5
YOUNG, POISSON = 210e9, 0.3
MODULUS = contact_modulus((YOUNG, POISSON), (YOUNG, POISSON))
CONVERGED_PEAK = 1.00097698  # over the formula: thermowear, degree 8, 32 elements in the zone
CONVERGED_FORCE = 2230.166  # likewise [N]
STEPS, INCREMENT = 100, APPROACH / 100  # of the approach, after the first solution [m]
GETFEM_STEPS = 10  # that GetFEM computes of them; the rest is extrapolated

# GetFEM's Newton method weighs residuals of different dimensions against each other: with lengths
# in micrometres and stresses over Young's modulus they are of one size, in metres the conditions
# of contact would vanish beside the forces.
MICRON = 1e6
# Over the width of the contact, of Young's modulus. Newton's method needs the fewest steps here.
AUGMENTATION = 1.0
SETTINGS = f"""GetFEM's settings, the fastest found that give the pressure:
- small displacements: symmetric augmented Lagrangian in the assembly language
  (add_nonlinear_term), faces paired by an interpolate transformation, r = {AUGMENTATION:g} E/width;
- supports by multipliers (elimination, "with_simplification", takes far longer on large meshes);
- Newton from the rigidly moved cylinder, line search "simplest" that takes whole steps,
  max_res 1e-8 (relative), lsolver mumps (symmetric), quadrature 3 x 3.
Not used: the bricks "integral" and "nodal contact between nonmatching meshes", which leave out
points that are apart in the mesh (wrong pressures), and "large sliding by ray tracing" (slower)."""


@dataclass
class Clock:
    """Wall and processor seconds of parts of a computation."""

    parts: dict[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self):
        self._last = time.perf_counter(), time.process_time()

    def part(self, name: str) -> None:
        """Everything since the last call, or since the clock was made."""
        now = time.perf_counter(), time.process_time()
        self.parts[name] = now[0] - self._last[0], now[1] - self._last[1]
        self._last = now

    @property
    def total(self) -> tuple[float, float]:
        wall, processor = zip(*self.parts.values(), strict=True)
        return sum(wall), sum(processor)


@dataclass(frozen=True)
class Outcome:
    """What one program found and what it took.

    Attributes
    ----------
    dofs, pressures : int
        Displacement values and values of the pressure.
    peak, force : float
        [Pa], [N]
    first, further : Clock
        First solution, and all further steps.
    later_force : float
        After as many further steps as GetFEM computes [N].
    newton : int or None
        Newton steps of the first solution.
    """

    dofs: int
    pressures: int
    peak: float
    force: float
    first: Clock
    further: Clock
    later_force: float
    newton: int | None = None

    @property
    def over_formula(self) -> float:
        """Peak over ``√(F E*/(π R))`` with the force that was found."""
        return self.peak / sqrt(self.force / THICKNESS * MODULUS / (pi * RADIUS))


# ---- the mesh ------------------------------------------------------------------------------------


def case_of(elements: int, *overrides: str):
    """The starter case, whole, with that many elements in the contact zone."""
    tables = tomllib.loads(starter_text("cylinder-on-block"))
    whole = ("geometry.half=false", f"load={{approach='{APPROACH} m'}}")
    return load(tables, (*whole, f"mesh.elements={elements}", *(overrides or QUADRATIC)))


QUADRATIC = ("contact.positioning=false", "mesh.degree=2", "mesh.grading=1.0")


def displacement_values(mesh) -> int:
    """Of degree 2 on the quadrilaterals of a mesh."""
    corners = mesh.cells[:, :4]
    edges = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2), axis=2)
    vertices, edges = np.unique(corners), np.unique(edges.reshape(-1, 2), axis=0)
    return 2 * (len(vertices) + len(edges) + len(corners))


def meshed(values: int):
    """Case and mesh with about that many displacement values."""

    def few(elements):
        return displacement_values(case_of(elements).tagged_mesh()) <= values

    low, high = 10, 20
    while few(high):
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        if few(middle):
            low = middle
        else:
            high = middle
    case = case_of(low)
    return case, case.tagged_mesh()


# ---- thermowear ----------------------------------------------------------------------------------


def by_thermowear(case, mesh) -> Outcome:
    """First solution and all further steps."""
    with mock.patch.object(type(case), "tagged_mesh", return_value=mesh):
        clock, phases = Clock(), Phases()
        system = build(case, MPI.COMM_WORLD, phases)
    clock.part("mesh, pairing, assembly, factors")
    problem = interface_problem(system)
    clock.part("condensation")
    states = [problem.unworn()]
    clock.part("contact")

    def force(contact):
        return system.holder.carried(contact.pressure, system.weights)

    further = Clock()
    closed = np.ones(len(system.weights), dtype=bool)
    for step in range(1, STEPS + 1):
        lowered = -step * INCREMENT * system.holder.closing
        states.append(problem.solve(lowered, 0.0, states[-1], closed))
    further.part("steps")
    return Outcome(
        dofs=system.elastic.fixed.size,
        pressures=system.basis.shape[1],
        peak=float(states[0].pressure.max()),
        force=force(states[0]),
        first=clock,
        further=further,
        later_force=force(states[GETFEM_STEPS]),
    )


def by_high_degree(case) -> tuple[float, float, float, int]:
    """Wall seconds, errors of peak and force, displacement values; meshing is in the time."""
    clock = Clock()
    system = prepare(case, MPI.COMM_WORLD, Phases())
    contact = interface_problem(system).unworn()
    clock.part("all")
    force = system.holder.carried(contact.pressure, system.weights)
    peak = contact.pressure.max() / sqrt(force / THICKNESS * MODULUS / (pi * RADIUS))
    errors = abs(peak / CONVERGED_PEAK - 1), abs(force / CONVERGED_FORCE - 1)
    return clock.total[0], *errors, system.elastic.fixed.size


# ---- GetFEM --------------------------------------------------------------------------------------


def getfem_mesh(mesh, body: str, surfaces: list[str]) -> gf.Mesh:
    """One body with the same curved cells; surfaces become regions 1, 2, …"""
    order = mesh.facets.shape[1] - 1
    transformation = gf.GeoTrans(f"GT_QK(2,{order})")
    cells = mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]
    target = transformation.pts().T
    places = reference_nodes("quadrilateral", order)
    distances = np.linalg.norm(places - target[:, None], axis=2)
    nodes = MICRON * mesh.points[cells[:, distances.argmin(axis=1)]]
    result = gf.Mesh("empty", 2)
    convexes = result.add_convex(transformation, np.asfortranarray(nodes.transpose(2, 1, 0)))
    # gmsh's edges y = 0, x = 1, y = 1, x = 0 in GetFEM's numbering of faces
    sides = [(convex, face) for convex in convexes for face in (3, 0, 2, 1)]
    ends = np.stack([cells[:, :4], np.roll(cells[:, :4], -1, axis=1)], axis=2).reshape(-1, 2)
    where = {tuple(sorted(pair)): side for pair, side in zip(ends.tolist(), sides, strict=True)}
    for number, surface in enumerate(surfaces, start=1):
        facets = mesh.facets[mesh.facet_tags == mesh.surfaces.index(surface) + 1]
        chosen = [where[tuple(sorted(pair))] for pair in facets[:, :2].tolist()]
        result.set_region(number, np.array(chosen).T)
    return result


def by_getfem(case, mesh) -> Outcome:
    """First solution and some further steps."""
    faces, ends = case.geometry.contact, (case.geometry.held, case.geometry.fixed)
    meshes = [
        getfem_mesh(mesh, body, [face, end])
        for body, face, end in zip(case.geometry.bodies, faces, ends, strict=True)
    ]
    left, right = case.geometry.expected_zone(case.pressing())
    clock = Clock()
    model, integration = getfem_model(meshes, AUGMENTATION / (MICRON * (right - left)))
    clock.part("spaces and model")
    newton = solve(model)
    clock.part("Newton")
    pressure = YOUNG * model.variable("p")
    force = carried(model, integration)
    clock.part("pressure and force")
    further = Clock()
    for step in range(1, GETFEM_STEPS + 1):
        model.set_variable("push", [0.0, -MICRON * (APPROACH + step * INCREMENT)])
        solve(model)
    further.part("steps")
    return Outcome(
        dofs=len(model.variable("u1")) + len(model.variable("u2")),
        pressures=len(pressure),
        peak=float(pressure.max()),
        force=force,
        first=clock,
        further=further,
        later_force=carried(model, integration),
        newton=newton,
    )


def getfem_model(meshes: list[gf.Mesh], augmentation: float) -> tuple[gf.Model, gf.MeshIm]:
    """The model with its start, and the integration on the cylinder."""
    spaces = [gf.MeshFem(mesh, 2) for mesh in meshes]
    rule = gf.Integ("IM_GAUSS_PARALLELEPIPED(2,4)")  # 3 x 3 points
    integrations = [gf.MeshIm(mesh, rule) for mesh in meshes]
    model = gf.Model("real")
    model.add_initialized_data("lame", POISSON / (1 + POISSON) / (1 - 2 * POISSON))
    model.add_initialized_data("shear", 0.5 / (1 + POISSON))
    model.add_initialized_data("push", [0.0, -MICRON * APPROACH])
    for u, space, integration, given in zip(
        ("u1", "u2"), spaces, integrations, (("push",), ()), strict=True
    ):
        space.set_fem(gf.Fem("FEM_QK(2,2)"))
        model.add_fem_variable(u, space)
        model.add_isotropic_linearized_elasticity_brick(integration, u, "lame", "shear")
        model.add_Dirichlet_condition_with_multipliers(integration, u, space, 2, *given)
    model.set_variable("u1", np.tile([0.0, -MICRON * APPROACH], spaces[0].nbdof() // 2))
    multipliers = gf.MeshFem(meshes[0], 1)
    multipliers.set_fem(gf.Fem("FEM_QK(2,1)"))
    model.add_filtered_fem_variable("p", multipliers, 1)
    model.add_initialized_data("r", augmentation)
    model.add_interpolate_transformation_from_expression("below", *meshes, "[X(1); 0]")
    model.add_macro("gap", "(Interpolate(X, below) + Interpolate(u2, below) - X - u1).Normal")
    model.add_macro("closing", "(Test_u1 - Interpolate(Test_u2, below)).Normal")
    model.add_macro("pressed", "pos_part(p - r*gap)")
    lagrangian = "pressed*closing - (p - pressed)/r*Test_p"
    model.add_nonlinear_term(integrations[0], lagrangian, 1, True)
    return model, integrations[0]


def solve(model: gf.Model) -> int:
    """Newton's method; returns its steps."""
    steps, converged = model.solve(
        *("max_res", 1e-8, "max_iter", 60, "lsolver", "mumps"),
        *("lsearch", "simplest", "alpha min", 1.0),
    )
    if not converged:
        raise RuntimeError(f"GetFEM: no solution in {steps} Newton steps")
    return int(steps)


def carried(model: gf.Model, integration: gf.MeshIm) -> float:
    """Force of the pressure on the thickness [N]."""
    force = gf.asm_generic(integration, 0, "-p*Normal(2)", 1, model)
    return float(np.ravel(force)[0]) * YOUNG / MICRON * THICKNESS


# ---- report --------------------------------------------------------------------------------------


def compared(values: int, repeat: int, elements: int, degree: int, grading: float) -> None:
    """Run both and print; the fastest of some runs counts.

    Then with a few elements of a high degree, with a grading.
    """
    case, mesh = meshed(values)
    own, other = (
        min((run(case, mesh) for _ in range(repeat)), key=lambda found: found.first.total[1])
        for run in (by_thermowear, by_getfem)
    )
    assert own.dofs == other.dofs
    print(f"\n{own.dofs} displacement values, {case.mesh.elements} elements in the contact zone")
    row("", "thermowear", "GetFEM", "ratio")
    row("values of the pressure", f"{own.pressures}", f"{other.pressures}", "")
    seconds("first solution, wall [s]", own.first.total[0], other.first.total[0])
    seconds("first solution, processor [s]", own.first.total[1], other.first.total[1])
    scale = STEPS / GETFEM_STEPS
    steps = own.further.total, [scale * value for value in other.further.total]
    seconds(f"{STEPS} further steps, wall [s]", steps[0][0], steps[1][0])
    seconds(f"{STEPS} further steps, processor [s]", steps[0][1], steps[1][1])
    errors = [abs(run.over_formula / CONVERGED_PEAK - 1) for run in (own, other)]
    row("peak over the formula", *(f"{run.over_formula:.6f}" for run in (own, other)), "")
    row("its error", *(f"{error:.1e}" for error in errors), f"{errors[1] / errors[0]:.2g}")
    errors = [abs(run.force / CONVERGED_FORCE - 1) for run in (own, other)]
    row("error of the force", *(f"{error:.1e}" for error in errors), f"{errors[1] / errors[0]:.2g}")
    for name, run in (("thermowear", own), ("GetFEM", other)):
        parts = ", ".join(f"{part} {wall:.3f}" for part, (wall, _) in run.first.parts.items())
        newton = "" if run.newton is None else f" ({run.newton} Newton steps)"
        print(f"{name} [s]: {parts}{newton}")
    print(f"GetFEM: {GETFEM_STEPS} further steps were computed and counted {scale:g} times;")
    print(f"the force after them differs by {abs(other.later_force / own.later_force - 1):.1e}")
    few = case_of(elements, f"mesh.degree={degree}", f"mesh.grading={grading}")
    by_high_degree(few)  # compiles the forms
    wall, peak, force, dofs = min(by_high_degree(few) for _ in range(3))
    print(
        f"thermowear, degree {degree}, {elements} elements in the zone, positioned, {dofs} values:"
    )
    print(f"{wall:.3f} s, meshing included; errors of peak {peak:.1e}, of force {force:.1e}")
    print(f"GetFEM takes {other.first.total[0] / wall:.1f} times as long")


def row(label: str, own: str, other: str, ratio: str) -> None:
    print(f"{label:33}{own:>13}{other:>13}{ratio:>9}")


def seconds(label: str, own: float, other: float) -> None:
    row(label, f"{own:.3f}", f"{other:.3f}", f"{other / own:.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--large", action="store_true", help="250 k displacement values too")
    large = parser.parse_args().large
    gf.util_trace_level(0)
    print(f"dolfinx {importlib.metadata.version('fenics-dolfinx')}, GetFEM {getfem_version()}")
    print(SETTINGS)
    small = case_of(10)
    by_thermowear(small, small.tagged_mesh())  # compiles the forms
    compared(27_500, repeat=3, elements=8, degree=6, grading=0.5)
    if large:
        compared(252_500, repeat=1, elements=10, degree=8, grading=0.4)


def getfem_version() -> str:
    """From the library that the process has loaded, or unknown."""
    with open("/proc/self/maps", encoding="utf-8") as maps:
        names = {line.split()[-1] for line in maps if "libgetfem.so." in line}
    return names.pop().partition(".so.")[2] if names else "of an unknown version"


if __name__ == "__main__":
    main()
