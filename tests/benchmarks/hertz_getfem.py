"""Hertz's line contact by thermowear and by GetFEM, on the same meshes and in one process.

A half cylinder is pressed on a block by 0.05 mm, without friction. Both programs use the same
curved cells, displacements of degree 2 and pressures of degree 1 on the face of the cylinder, and
MUMPS; one thread for everything. GetFEM is used in two ways: tuned to this problem, and as its
documentation shows it. What is timed begins with a mesh in memory and ends with the pressure; then
the approach grows in small steps. Forms are compiled before. Wall and processor times are the same
unless other programs are at work.

Errors are those of the peak over Hertz's formula, of the force, and of the pressure on the whole
face (in L², relative), against thermowear with many elements of high degree.

Last, thermowear as it is meant to be used: few elements of high degree whose ends lie at the edges
of the contact, at no larger errors; meshing and positioning are in the time.

    export THERMOWEAR_EXTRA_PACKAGES=python3-getfem
    scripts/env python3 tests/benchmarks/hertz_getfem.py             # 27 k displacement values
    scripts/env python3 tests/benchmarks/hertz_getfem.py --large     # 250 k too: minutes
    scripts/env python3 tests/benchmarks/hertz_getfem.py --eliminated  # a third way: minutes more
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before anything loads a BLAS
os.environ["SCOTCH_PTHREAD_NUMBER"] = "1"  # orders the unknowns of GetFEM's MUMPS

import argparse
import importlib
import importlib.metadata
import time
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import isnan, pi, sqrt
from unittest import mock

from mpi4py import MPI

import numpy as np
from numpy.polynomial import legendre
from scipy.interpolate import BPoly

from thermowear import geometry  # noqa: F401  (makes the geometries known)
from thermowear.case import load
from thermowear.case.starters import starter_text
from thermowear.geometry.mesh.nodes import reference_nodes
from thermowear.reference.elastic_contact.hertz import contact_modulus
from thermowear.simulation.analyses.positioning import prepare
from thermowear.simulation.from_case import model_of
from thermowear.simulation.interface.interface_problem import interface_problem
from thermowear.simulation.system.building import build
from thermowear.timer import Phases

gf = importlib.import_module("getfem")  # not in scripts/packages: it serves here only

RADIUS, THICKNESS, APPROACH = 10e-3, 1e-3, 5e-5
YOUNG, POISSON = 210e9, 0.3
MODULUS = contact_modulus((YOUNG, POISSON), (YOUNG, POISSON))
STEPS, INCREMENT = 100, APPROACH / 100  # of the approach, after the first solution [m]

SETTINGS = """GetFEM in every column: small displacements, an augmented Lagrangian in the assembly
language (add_nonlinear_term), faces paired by an interpolate transformation, [X(1); 0], 3 x 3
points of quadrature, lsolver mumps.
tuned, the fastest settings found that give the pressure:
- symmetric Lagrangian, hence symmetric MUMPS; r = E/width; lengths in µm, stresses over E;
- supports by multipliers of degree 2;
- Newton from the rigidly moved cylinder, whole steps, max_res 1e-8.
documented, the nearest example of the documentation: "wheel in contact" of the tutorial, which is
demo_wheel_contact.py, with Dirichlet_version = True; here on this mesh and in plane strain:
- its unsymmetric Lagrangian with r = E/element_size, on its 2 x 2 composite rule; tractions and
  gaps are vertical, a model whose peak tends to a value 4e-4 lower; its units, cm and N/cm²;
- its supports: by multipliers of degree 1;
- Newton from rest with what the tutorial advises where the default line search does not do (here
  it stagnates above max_res): max_res 1e-9, lsearch simplest, alpha min 0.8.
eliminated (--eliminated), as documented but for the supports: "with_simplification", in the manual
"rather simple and economic"; none of the Python demos of contact uses it.
Not used: the bricks "integral" and "nodal contact between nonmatching meshes", which leave out
points that are apart in the mesh (wrong pressures), and "large sliding by ray tracing", used as in
demo_elastic_ring_contact.py (slower than documented by a fifth to a third)."""


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
class Solution:
    """A pressure on the face of the cylinder.

    Attributes
    ----------
    curve : scipy.interpolate.BPoly
        Pressure at angles from the lowest point; its pieces are the facets [Pa].
    peak, force : float
        [Pa], [N]
    dofs : int
        Displacement values.
    """

    curve: BPoly
    peak: float
    force: float
    dofs: int

    @property
    def values(self) -> int:
        """Coefficients of the pressure."""
        degree, facets = len(self.curve.c) - 1, self.curve.c.shape[1]
        return degree * facets + 1

    @property
    def over_formula(self) -> float:
        """Peak over ``√(F E*/(π R))`` with the force that was found."""
        return self.peak / sqrt(self.force / THICKNESS * MODULUS / (pi * RADIUS))

    def errors(self, converged: Solution) -> tuple[float, float, float]:
        """Relative: of the peak over the formula, of the force, of the curve in L²."""
        peak = abs(self.over_formula / converged.over_formula - 1)
        force = abs(self.force / converged.force - 1)
        points, weights = legendre.leggauss(8)
        start, size = self.curve.x[:-1, None], np.diff(self.curve.x)[:, None]
        angles, weights = start + size * (points + 1) / 2, size * weights
        exact = converged.curve(angles)
        missed = np.sum(weights * (self.curve(angles) - exact) ** 2)
        return peak, force, float(np.sqrt(missed / np.sum(weights * exact**2)))


def curve_of(points: np.ndarray, coefficients: np.ndarray) -> BPoly:
    """A pressure from its Bernstein coefficients and the ends of the facets, in order."""
    facets = len(points) - 1
    degree = len(coefficients) // facets
    assert len(coefficients) == degree * facets + 1
    of_facets = np.arange(degree + 1)[:, None] + degree * np.arange(facets)
    return BPoly(coefficients[of_facets], np.arctan2(points[:, 0], RADIUS - points[:, 1]))


@dataclass(frozen=True)
class Outcome:
    """What one program found and what it took.

    Attributes
    ----------
    solution : Solution
    first, further : Clock
        First solution, and some further steps.
    later_forces : list of float
        After each further step [N].
    newton : int or None
        Newton steps of the first solution.
    """

    solution: Solution
    first: Clock
    further: Clock
    later_forces: list[float]
    newton: int | None = None

    def all_steps(self, clock: int) -> float:
        """Wall (clock 0) or processor (1) seconds of all further steps, extrapolated; or NaN."""
        computed = len(self.later_forces)
        return self.further.total[clock] * STEPS / computed if computed else float("nan")


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


def solution_of(system, contact) -> Solution:
    coefficients = np.linalg.lstsq(system.basis, contact.pressure, rcond=None)[0]
    nodes = system.pairing.sides[0].face.nodes
    return Solution(
        curve=curve_of(np.vstack([nodes[:, 0], nodes[-1:, -1]]), coefficients),
        peak=float(contact.pressure.max()),
        force=carried_by(system, contact),
        dofs=system.elastic.fixed.size,
    )


def carried_by(system, contact) -> float:
    """Force against the approach [N]."""
    (force,) = system.holder.force_response.T @ (contact.pressure * system.weights)
    return float(force)


def by_thermowear(case, mesh) -> Outcome:
    """First solution and all further steps."""
    with mock.patch.object(type(case), "tagged_mesh", return_value=mesh):
        clock, phases = Clock(), Phases()
        system = build(model_of(case), MPI.COMM_WORLD, phases)
    clock.part("mesh, pairing, assembly, factors")
    problem = interface_problem(system)
    clock.part("condensation")
    states = [problem.unworn().contact]
    clock.part("contact")
    further = Clock()
    for step in range(1, STEPS + 1):
        lowered = -step * INCREMENT * system.holder.closure[:, 0]
        states.append(problem.worn(lowered, states[-1]))
    further.part("steps")
    forces = [carried_by(system, state) for state in states[1:]]
    return Outcome(solution_of(system, states[0]), clock, further, forces)


def by_high_degree(elements: int, degree: int, grading: float) -> tuple[float, Solution]:
    """Wall seconds, meshing and positioning included, and what was found."""
    case = case_of(elements, f"mesh.degree={degree}", f"mesh.grading={grading}")
    clock = Clock()
    system = prepare(model_of(case), MPI.COMM_WORLD, Phases())
    contact = interface_problem(system).unworn()
    clock.part("all")
    return clock.total[0], solution_of(system, contact)


# ---- GetFEM --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Usage:
    """A way to use GetFEM.

    Attributes
    ----------
    name : str
    unit : float
        Its lengths in a metre.
    young : float
        Young's modulus in its units.
    contact : callable
        Adds the conditions of contact to a model, from its meshes, this, and the width of the
        contact.
    sign : int
        Of the multiplier where it presses.
    supports : int or None
        Degree of the multipliers of the supports; None: eliminated.
    moved : bool
        Whether Newton's method begins with the cylinder moved; otherwise at rest.
    newton : tuple
        Settings of Newton's method.
    steps : int
        Further steps that are computed; the rest is extrapolated.
    """

    name: str
    unit: float
    young: float
    contact: Callable
    sign: int
    supports: int | None
    moved: bool
    newton: tuple
    steps: int

    def pushed(self, approach: float) -> list[float]:
        """Displacement of the held end."""
        return [0.0, -self.unit * approach]


def tuned_contact(model: gf.Model, mesh: gf.Mesh, usage: Usage, width: float) -> None:
    model.add_initialized_data("r", usage.young / (usage.unit * width))
    model.add_macro("gap", "(Interpolate(X, below) + Interpolate(u2, below) - X - u1).Normal")
    model.add_macro("closing", "(Test_u1 - Interpolate(Test_u2, below)).Normal")
    model.add_macro("pressed", "pos_part(p - r*gap)")
    lagrangian = "pressed*closing - (p - pressed)/r*Test_p"
    model.add_nonlinear_term(gf.MeshIm(mesh, 4), lagrangian, 1, True)


def documented_contact(model: gf.Model, mesh: gf.Mesh, usage: Usage, width: float) -> None:
    model.add_initialized_data("gamma0", 1 / usage.young)
    model.add_macro("gap", "(X + u1 - Interpolate(X, below) - Interpolate(u2, below)).[0;1]")
    model.add_macro("opening", "(Test_u1 - Interpolate(Test_u2, below)).[0;1]")
    model.add_macro("softness", "gamma0*element_size")
    rule = gf.Integ("IM_STRUCTURED_COMPOSITE(IM_GAUSS_PARALLELEPIPED(2,4),2)")
    integration = gf.MeshIm(mesh, rule)
    model.add_nonlinear_term(integration, "p*opening", 1)
    condition = "-softness*(p + neg_part(p + gap/softness))*Test_p"
    model.add_nonlinear_term(integration, condition, 1)


# GetFEM's Newton method weighs residuals of different dimensions against each other: with lengths
# in micrometres and stresses over Young's modulus they are of one size.
TUNED = Usage(
    name="tuned",
    unit=1e6,
    young=1.0,
    contact=tuned_contact,
    sign=1,
    supports=2,
    moved=True,
    newton=("max_res", 1e-8, "max_iter", 60, "lsearch", "simplest", "alpha min", 1.0),
    steps=10,
)
DOCUMENTED = Usage(
    name="documented",
    unit=1e2,
    young=1e-4 * YOUNG,
    contact=documented_contact,
    sign=-1,
    supports=1,
    moved=False,
    newton=("max_res", 1e-9, "max_iter", 100, "lsearch", "simplest", "alpha min", 0.8),
    steps=10,
)
ELIMINATED = replace(DOCUMENTED, name="eliminated", supports=None, steps=0)


def getfem_mesh(mesh, body: str, surfaces: list[str], unit: float) -> gf.Mesh:
    """One body with the same curved cells; surfaces become regions 1, 2, …"""
    order = mesh.facets.shape[1] - 1
    transformation = gf.GeoTrans(f"GT_QK(2,{order})")
    cells = mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]
    target = transformation.pts().T
    places = reference_nodes("quadrilateral", order)
    distances = np.linalg.norm(places - target[:, None], axis=2)
    nodes = unit * mesh.points[cells[:, distances.argmin(axis=1)]]
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


def by_getfem(case, mesh, usage: Usage) -> Outcome:
    """First solution and some further steps."""
    faces, ends = case.geometry.contact, (case.geometry.held, case.geometry.fixed)
    meshes = [
        getfem_mesh(mesh, body, [face, end], usage.unit)
        for body, face, end in zip(case.geometry.bodies, faces, ends, strict=True)
    ]
    left, right = case.geometry.expected_zone(case.pressing())
    clock = Clock()
    model = getfem_model(meshes, usage, right - left)
    clock.part("spaces and model")
    newton = solve(model, usage)
    clock.part("Newton")
    solution = getfem_solution(model, meshes[0], usage)
    clock.part("pressure and force")
    further, forces = Clock(), []
    for step in range(1, usage.steps + 1):
        model.set_variable("push", usage.pushed(APPROACH + step * INCREMENT))
        solve(model, usage)
        forces.append(carried(model, meshes[0], usage))
    further.part("steps")
    return Outcome(solution, clock, further, forces, newton)


def getfem_model(meshes: list[gf.Mesh], usage: Usage, width: float) -> gf.Model:
    """The model with its start."""
    model = gf.Model("real")
    model.add_initialized_data("lame", usage.young * POISSON / (1 + POISSON) / (1 - 2 * POISSON))
    model.add_initialized_data("shear", 0.5 * usage.young / (1 + POISSON))
    model.add_initialized_data("push", usage.pushed(APPROACH))
    for u, mesh, given in zip(("u1", "u2"), meshes, (("push",), ()), strict=True):
        space, integration = gf.MeshFem(mesh, 2), gf.MeshIm(mesh, 4)  # 3 x 3 points
        space.set_classical_fem(2)
        model.add_fem_variable(u, space)
        model.add_isotropic_linearized_elasticity_brick(integration, u, "lame", "shear")
        if usage.supports is None:
            model.add_Dirichlet_condition_with_simplification(u, 2, *given)
        else:
            model.add_Dirichlet_condition_with_multipliers(
                integration, u, usage.supports, 2, *given
            )
    if usage.moved:
        nodes = len(model.variable("u1")) // 2
        model.set_variable("u1", np.tile(usage.pushed(APPROACH), nodes))
    multipliers = gf.MeshFem(meshes[0], 1)
    multipliers.set_classical_fem(1)
    model.add_filtered_fem_variable("p", multipliers, 1)
    model.add_interpolate_transformation_from_expression("below", *meshes, "[X(1); 0]")
    usage.contact(model, meshes[0], usage, width)
    return model


def solve(model: gf.Model, usage: Usage) -> int:
    """Newton's method; returns its steps."""
    steps, converged = model.solve(*usage.newton, "lsolver", "mumps")
    if not converged:
        raise RuntimeError(f"GetFEM, {usage.name}: no solution in {steps} Newton steps")
    return int(steps)


def getfem_solution(model: gf.Model, mesh: gf.Mesh, usage: Usage) -> Solution:
    space = model.mesh_fem_of_variable("p")
    nodes = space.basic_dof_nodes(space.basic_dof_on_region(1)).T / usage.unit
    pressure = usage.sign * YOUNG / usage.young * model.variable("p")
    order = np.argsort(nodes[:, 0])
    return Solution(
        curve=curve_of(nodes[order], pressure[order]),
        peak=float(pressure.max()),
        force=carried(model, mesh, usage),
        dofs=len(model.variable("u1")) + len(model.variable("u2")),
    )


def carried(model: gf.Model, mesh: gf.Mesh, usage: Usage) -> float:
    """Vertical force of the pressure on the thickness [N]."""
    vertical = "-p*Normal(2)" if usage.sign > 0 else "-p"
    force = gf.asm_generic(gf.MeshIm(mesh, 4), 0, vertical, 1, model)
    return float(np.ravel(force)[0]) * YOUNG / usage.young / usage.unit * THICKNESS


# ---- report --------------------------------------------------------------------------------------


def compared(values: int, usages: list[Usage], repeat: int, converged: Solution) -> list[float]:
    """Run thermowear and GetFEM and print; the fastest of some runs counts.

    Returns the wall seconds of GetFEM's first solutions.
    """
    case, mesh = meshed(values)
    runs = {"thermowear": fastest(lambda: by_thermowear(case, mesh), repeat)}
    for usage in usages:
        runs[usage.name] = fastest(lambda way=usage: by_getfem(case, mesh, way), repeat)
    own, *others = runs.values()
    assert all(other.solution.dofs == own.solution.dofs for other in others)
    print(f"\n{own.solution.dofs} displacement values, {case.mesh.elements} elements in the zone")
    table(list(runs), list(runs.values()), converged)
    for name, run in runs.items():
        parts = ", ".join(f"{part} {wall:.3f}" for part, (wall, _) in run.first.parts.items())
        print(f"{name} [s]: {parts}" + (f" ({run.newton} Newton steps)" if run.newton else ""))
    for name, run in list(runs.items())[1:]:
        if steps := len(run.later_forces):
            apart = abs(run.later_forces[-1] / own.later_forces[steps - 1] - 1)
            print(f"{name}: {steps} further steps were computed, counted {STEPS / steps:g} times;")
            print(f"    the force after them differs from thermowear's by {apart:.1e}")
    return [other.first.total[0] for other in others]


def fastest(way: Callable[[], Outcome], repeat: int) -> Outcome:
    return min((way() for _ in range(repeat)), key=lambda found: found.first.total[1])


def table(names: list[str], runs: list[Outcome], converged: Solution) -> None:
    print(f"{'':44}{'GetFEM':>12}")
    print(f"{'':32}{names[0]:>12}" + "".join(f"{name:>12}{'ratio':>8}" for name in names[1:]))
    row("values of the pressure", [run.solution.values for run in runs], "d")
    for clock, name in enumerate(("wall [s]", "processor [s]")):
        row(f"first solution, {name}", [run.first.total[clock] for run in runs], ".3f", ".1f")
    for clock, name in enumerate(("wall [s]", "processor [s]")):
        row(f"{STEPS} further steps, {name}", [run.all_steps(clock) for run in runs], ".3f", ".0f")
    row("peak over the formula", [run.solution.over_formula for run in runs], ".6f")
    peak, force, curve = zip(*(run.solution.errors(converged) for run in runs), strict=True)
    row("its error", peak, ".1e", ".2f")
    row("error of the force", force, ".1e", ".2f")
    row("error of the pressure in L²", curve, ".1e", ".2f")


def row(label: str, values: Sequence[float], form: str, ratios: str = "") -> None:
    """The values, and all but the first over the first."""
    own, *others = values
    line = f"{label:32}{own:>12{form}}"
    for other in others:
        known = not isnan(other)
        line += f"{other:>12{form}}" if known else f"{'-':>12}"
        line += f"{other / own:>8{ratios}}" if known and ratios else " " * 8
    print(line.rstrip())


def as_meant(
    elements: int, degree: int, grading: float, taken: list[float], converged: Solution
) -> None:
    """Run thermowear with few elements of a high degree and print, beside GetFEM's seconds."""
    by_high_degree(elements, degree, grading)  # compiles the forms
    runs = [by_high_degree(elements, degree, grading) for _ in range(3)]
    seconds, solution = min(runs, key=lambda run: run[0])
    peak, force, curve = solution.errors(converged)
    print(f"thermowear, degree {degree}, {elements} elements in the zone, positioned:", end=" ")
    print(f"{solution.dofs} values, {seconds:.3f} s, meshing included;")
    print(f"    errors of peak {peak:.1e}, of force {force:.1e}, of pressure {curve:.1e};")
    print("    GetFEM takes", ", ".join(f"{other / seconds:.1f}" for other in taken), "times that")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--large", action="store_true", help="250 k displacement values too")
    parser.add_argument("--eliminated", action="store_true", help="a third way to use GetFEM too")
    options = parser.parse_args()
    usages = [TUNED, DOCUMENTED] + [ELIMINATED] * options.eliminated
    gf.util_trace_level(0)
    print(f"dolfinx {importlib.metadata.version('fenics-dolfinx')}, GetFEM {getfem_version()}")
    print(SETTINGS)
    small = case_of(10)
    by_thermowear(small, small.tagged_mesh())  # compiles the forms
    converged = by_high_degree(elements=32, degree=8, grading=0.4)[1]
    taken = compared(27_500, usages, 3, converged)
    as_meant(8, 6, 0.5, taken, converged)
    if options.large:
        taken = compared(252_500, usages, 1, converged)
        as_meant(10, 8, 0.4, taken, converged)


def getfem_version() -> str:
    """From the library that the process has loaded, or unknown."""
    with open("/proc/self/maps", encoding="utf-8") as maps:
        names = {line.split()[-1] for line in maps if "libgetfem.so." in line}
    return names.pop().partition(".so.")[2] if names else "of an unknown version"


if __name__ == "__main__":
    main()
