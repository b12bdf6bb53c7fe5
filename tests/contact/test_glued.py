"""Glued bodies whose meshes do not match: displacement, forces, and condensation."""

import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest

from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.bulk.solvers.choice import SolverChoice, choose_solver
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_faces
from thermowear.contact.full.full_system import FullContact
from thermowear.contact.full.nitsche import default_penalty, nitsche_stiffness, normal_traction
from thermowear.contact.operators.condensation import condense, gap_trace
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import RigidMode, hold
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.contact.solvers.signorini import solve_contact
from thermowear.contact.ties import glued_points, transferred
from thermowear.errors import CaseError
from thermowear.geometry.mesh.held import free_motions
from thermowear.laws.motions import translation
from thermowear.parallel import sum_over_ranks

from .glued import COMM, PLANE, Box, boxes, glued_elasticity, tagged_boxes, turned

pytest_needs_ranks = pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
WIDTH, HEIGHTS = 0.04, (0.02, 0.03)
E, CONTRAST = 2e11, 5.0
IN_PLANE = [("quadrilateral", k) for k in (1, 2, 8)] + [("triangle", k) for k in (1, 2)]
IN_SPACE = [(cells, k) for cells in ("hexahedron", "tetrahedron") for k in (1, 2)]
MIXED = [(("hexahedron", "tetrahedron"), 2), (("triangle", "quadrilateral"), 3)]


def stack(cells, fine, swap=False, place=np.asarray, order=1):
    """Two boxes, one on the other, the finer first or last; cells of one kind, or of two."""
    dim = 3 if "hexahedron" in cells or "tetrahedron" in cells else 2
    base, letter = ((0.0, WIDTH),) * (dim - 1), "xyz"[dim - 1]
    counts = [(n,) * (dim - 1) + (1 + (dim == 2),) for n in ((5, 2) if fine else (2, 3))]
    upper = Box("upper", (*base, (0.0, HEIGHTS[0])), counts[0])
    lower = Box("lower", (*base, (-HEIGHTS[1], 0.0)), counts[1])
    given = (lower, upper) if swap else (upper, lower)
    joined = [(f"upper_low_{letter}", f"lower_high_{letter}")[:: -1 if swap else 1]]
    return (
        boxes(*given, order=order, cells=cells, place=place),
        joined[:: -1 if swap else 1],
        letter,
    )


def largest(values):
    return max(COMM.allgather(float(np.abs(values).max(initial=0.0))))


def forces(elastic, loaded):
    """Nodal forces of total forces on surfaces."""
    return np.sum([elastic.spaces.loads(elastic.surface_work(*one)) for one in loaded.items()], 0)


@pytest.mark.parametrize("fine", [True, False])
@pytest.mark.parametrize("kind", ["pull", "shear"])
@pytest.mark.parametrize(("cells", "degree"), IN_PLANE + IN_SPACE + MIXED)
def test_patch(cells, degree, kind, fine):
    """requirement: uniform stress in glued blocks of any cells that do not match, stiff on soft, in
    a turned frame, to 1e-10; the joint transfers it, and the support carries it.
    """
    place = turned(0.4)
    bodies, joined, up = stack(cells, fine, swap=fine, place=place)
    ν = 0.0 if kind == "pull" else 0.3
    materials = {"upper": (E, ν), "lower": (E / CONTRAST, ν)}
    elastic, (tie,) = glued_elasticity(bodies, degree, joined, materials, [f"lower_low_{up}"])
    axes = place(np.eye(bodies.dim))
    x, n = axes[0], axes[-1]
    depth = 1.0 if bodies.dim == 3 else PLANE.thickness / WIDTH
    area, stress = depth * WIDTH**2, 1e8
    direction, modulus = (n, E) if kind == "pull" else (x, E / (2 * (1 + ν)))
    loaded = {f"upper_high_{up}": stress * area * direction}
    if kind == "shear":
        for name, h in zip(("upper", "lower"), HEIGHTS, strict=True):
            side = stress * depth * WIDTH * h * n
            loaded |= {f"{name}_high_x": side, f"{name}_low_x": -side}
    loads = forces(elastic, loaded)
    u = elastic.solve(loads)
    z = elastic.nodes() @ n
    exact = stress / modulus * (CONTRAST * np.minimum(z + HEIGHTS[1], HEIGHTS[1]) + z.clip(0.0))
    assert largest(u.reshape(-1, len(n)) - np.outer(exact, direction)) < 1e-10 * largest(exact)
    traction = transferred(tie, elastic.multipliers(u, loads), degree)
    assert tie.sides[0].face.name.startswith("upper") == fine  # the multipliers on the finer side
    sign = 1.0 if tie.sides[0].face.name.startswith("lower") else -1.0
    assert largest(traction - sign * stress * direction) < 1e-9 * stress
    reactions = elastic.reactions(u, loads).reshape(-1, len(n)).sum(axis=0)
    expected = -stress * area * direction
    if kind == "pull":
        assert sum_over_ranks(COMM, reactions) == pytest.approx(expected, rel=1e-9, abs=1.0)


@pytest.mark.parametrize("cells", ["quadrilateral", "triangle", "hexahedron", "tetrahedron"])
def test_uniform_expansion(cells):
    """requirement: glued blocks of one expansion and different stiffness expand without stress,
    also where both are guided at the edge of their joint.
    """
    bodies, joined, up = stack(cells, True)
    α, ν, rise = 1.2e-5, 0.3, 80.0
    guides = {"symmetric": ("upper_low_x", "lower_low_x")}
    guides |= {"rollers": ("lower_low_y", "upper_low_y") if up == "z" else ("lower_low_y",)}
    guides |= {"mid_plane": ("lower_low_z",)} if up == "z" else {}
    materials = {"upper": (E, ν, α), "lower": (E / 50, ν, α)}
    elastic, _ = glued_elasticity(bodies, 2, joined, materials, [], **guides)
    spaces = lagrange_spaces(bodies, 2)
    loads = elastic.thermal_load(spaces).multiply(np.full(spaces.owned, rise))
    u = elastic.solve(loads).reshape(-1, bodies.dim)
    strain = α * rise * (1.0 if up == "z" else 1 + ν)
    from_corner = elastic.nodes() - np.array([0.0] * (bodies.dim - 1) + [-HEIGHTS[1]])
    assert largest(u - strain * from_corner) < 1e-10 * strain * WIDTH
    reactions = elastic.reactions(u.ravel(), loads)
    assert largest(reactions) < 1e-9 * strain * E * WIDTH**2


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("counts", [(4, 4), (5, 2)])
def test_an_inclined_joint_that_ends_at_a_plane_of_symmetry(counts, degree):
    """requirement: uniform traction on the joint, also in the direction that the supports fix."""
    upper = Box("upper", ((0.0, 0.04), (0.0, 0.02)), (counts[0], 2))
    lower = Box("lower", ((0.0, 0.04), (-0.02, 0.0)), (counts[1], 2))

    def inclined(p):  # the joint, while the outer faces stay level
        x, y = p.T
        return np.column_stack([x, y + 0.3 * x * (1 - np.abs(y) / 0.02)])

    bodies = boxes(upper, lower, place=inclined)
    materials = {"upper": (E, 0.0), "lower": (E, 0.0)}
    known = bodies, degree, [("upper_low_y", "lower_high_y")], materials, ["lower_low_x"]
    elastic, _ = glued_elasticity(*known, symmetric=("upper_low_x",))
    pull = 1e8 * PLANE.thickness * np.array([1.0, 0.0])
    u = elastic.solve(forces(elastic, {"upper_high_x": 0.008 * pull, "lower_high_x": 0.032 * pull}))
    exact = 1e8 / E * elastic.nodes()[:, 0]
    assert largest(u[::2] - exact) < 1e-10 * largest(exact)
    assert largest(u[1::2]) < 1e-10 * largest(exact)


def test_rings_glued_at_a_cylinder():
    """requirement: Lamé's solution of a thick ring under inner pressure, by two glued rings."""
    a, b, c, p, ν, h = 0.05, 0.07, 0.1, 1e8, 0.3, 0.02
    inner = Box("inner", ((a, b), (0.0, h)), (2, 3))
    outer = Box("outer", ((b, c), (0.0, h)), (2, 1))
    materials, joined = {"inner": (E, ν), "outer": (E, ν)}, [("outer_low_x", "inner_high_x")]
    flat = tuple(f"{name}_{side}_y" for name in materials for side in ("low", "high"))
    known = boxes(inner, outer), 8, joined, materials, [], Axisymmetric()
    elastic, (tie,) = glued_elasticity(*known, rollers=flat)
    u = elastic.solve(loads := elastic.spaces.loads(elastic.pressure_work("inner_low_x", p)))
    r = elastic.nodes()[:, 0]
    exact = (1 + ν) / E * p * a**2 / (c**2 - a**2) * ((1 - 2 * ν) * r + c**2 / r)
    assert largest(u[::2] - exact) < 1e-9 * largest(exact)
    traction = transferred(tie, elastic.multipliers(u, loads), 8)
    pressure = p * a**2 / (c**2 - a**2) * (c**2 / b**2 - 1)
    sign = 1.0 if tie.sides[0].face.name.startswith("outer") else -1.0
    assert largest(traction[:, 0] - sign * pressure) < 1e-7 * p


@pytest.mark.parametrize("along", [True, False])
@pytest.mark.parametrize(("degree", "counts"), [(2, (16, 8)), (4, (6, 4)), (8, (3, 2))])
def test_bent_bar(degree, counts, along):
    """requirement: a cantilever glued across its middle, or along it, bends as one of one mesh, to
    1e-4.
    """
    length, h, force = 0.1, 0.02, np.array([0.0, -1e3])
    many, few = counts
    whole = Box("bar", ((0.0, length), (-h / 2, h / 2)), (2 * many, few))
    if along:
        first = Box("first", ((0.0, length), (0.0, h / 2)), (2 * many, few))
        second = Box("second", ((0.0, length), (-h / 2, 0.0)), (2 * many - 1, few))
        joined, clamped, loaded = ("first_low_y", "second_high_y"), "first_low_x", "first_high_x"
        clamps = [clamped, "second_low_x"]
    else:
        first = Box("first", ((0.0, length / 2), (-h / 2, h / 2)), (many, few))
        second = Box("second", ((length / 2, length), (-h / 2, h / 2)), (many, few + 1))
        joined, clamps, loaded = ("first_high_x", "second_low_x"), ["first_low_x"], "second_high_x"
    one = elasticity(boxes(whole), PLANE, degree, {"bar": ElasticMaterial(E, 0.3)}, ["bar_low_x"])
    expected = _work(one, one.spaces.loads(one.surface_work("bar_high_x", force)))
    materials = {"first": (E, 0.3), "second": (E, 0.3)}
    glued, _ = glued_elasticity(boxes(first, second), degree, [joined], materials, clamps)
    loads = glued.spaces.loads(glued.surface_work(loaded, force))
    if along:  # half of the force on either end
        loads = (loads + glued.spaces.loads(glued.surface_work("second_high_x", force))) / 2
    assert _work(glued, loads) == pytest.approx(expected, rel=1e-4)


def _work(elastic, loads):
    return sum_over_ranks(COMM, loads @ elastic.solve(loads))


def between_walls(counts, degree):
    """Two glued layers clamped at both ends, and loads on the upper one."""
    upper = Box("upper", ((0.0, 0.04), (0.0, 0.02)), (counts[0], 8))
    lower = Box("lower", ((0.0, 0.04), (-0.02, 0.0)), (counts[1], 8))
    walls = [f"{name}_{side}_x" for name in ("upper", "lower") for side in ("low", "high")]
    materials = {"upper": (E, 0.3), "lower": (E, 0.3)}
    joined = [("upper_low_y", "lower_high_y")]
    known = boxes(upper, lower), degree, joined, materials, walls
    elastic, _ = glued_elasticity(*known)
    return elastic, forces(elastic, {"upper_high_y": np.array([1e3, -1e4])})


@pytest.mark.parametrize("degree", [1, 2, 5])
@pytest.mark.parametrize("counts", [(1, 1), (1, 3), (5, 2), (4, 4)])
def test_both_bodies_between_walls(counts, degree):
    """requirement: where both bodies are clamped at the ends of the joint, conditions that the
    supports fulfil are left out; the walls carry the whole load, and each body is in equilibrium.
    """
    elastic, loads = between_walls(counts, degree)
    u = elastic.solve(loads)
    reactions = elastic.reactions(u, loads)
    total = sum_over_ranks(COMM, reactions.reshape(-1, 2).sum(axis=0))
    assert total == pytest.approx(np.array([-1e3, 1e4]), rel=1e-9)
    carried = reactions + loads + elastic.joint_forces(u, loads)
    for name in ("upper", "lower"):
        own = np.repeat(elastic.owned_by(name), 2)
        found = sum_over_ranks(COMM, np.where(own, carried, 0.0).reshape(-1, 2).sum(axis=0))
        assert np.abs(found).max() < 1e-6


@pytest.mark.parametrize(("degree", "allowed"), [(1, 0.04), (2, 0.01), (3, 0.01)])
def test_supports_at_a_joint_do_not_hold_it_twice(degree, allowed):
    """requirement: unequal meshes between walls deflect like equal ones."""
    unequal, equal = (_work(*between_walls(counts, degree)) for counts in ((4, 3), (4, 4)))
    assert unequal == pytest.approx(equal, rel=allowed)


def test_a_circle_of_joints():
    """requirement: four blocks glued round a common edge carry a uniform stress, whether their
    conditions depend on each other or not; each of a chain is held by its neighbours.
    """
    for degree, uneven in ((1, 0), (1, 1), (2, 1)):
        given, h = [], 0.02
        for k, (i, j) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
            ends = (i * h, (i + 1) * h), (j * h, (j + 1) * h)
            given.append(Box("abcd"[k], ends, (2 + uneven * k, 2 + uneven * (k % 3))))
        joined = [("a_high_x", "b_low_x"), ("b_high_y", "c_low_y")]
        joined += [("c_low_x", "d_high_x"), ("d_low_y", "a_high_y")]
        materials = dict.fromkeys("abcd", (E, 0.0))
        known = boxes(*given), degree, joined, materials, ["a_low_y", "b_low_y"]
        elastic, _ = glued_elasticity(*known)
        assert elastic.spaces.groups == ((0, 1, 2, 3),)
        end = np.array([0.0, 1e8 * h * PLANE.thickness])
        u = elastic.solve(forces(elastic, {"c_high_y": end, "d_high_y": end}))
        exact = 1e8 / E * elastic.nodes()[:, 1]
        assert largest(u[1::2] - exact) < 1e-10 * largest(exact)
        assert largest(u[::2]) < 1e-10 * largest(exact)


def pressed(degree, method="condensed", whole=False):
    """Pad with a glued back, or of one mesh, pressed on a disk: points, pressure and approach."""
    pad = Box("pad", ((0.01, 0.03), (0.0, 0.01)), (4, 2))
    back = Box("back", ((0.01, 0.03), (0.01, 0.015)), (3, 1))
    if whole:
        pad = Box("pad", ((0.01, 0.03), (0.0, 0.015)), (4, 3))
    disk = Box("disk", ((0.0, 0.04), (-0.02, 0.0)), (8, 4))
    bodies = boxes(pad, disk, *([] if whole else [back]))  # glued ones are not neighbours
    joined = [] if whole else [("back_low_y", "pad_high_y")]
    held = "pad_high_y" if whole else "back_high_y"
    materials = dict.fromkeys(bodies.names, (E, 0.3))
    elastic, _ = glued_elasticity(bodies, degree, joined, materials, [held, "disk_low_y"])
    pairing = pair(*gather_faces(bodies, ("pad_low_y", "disk_high_y")), PLANE, degree + 2)
    trace = gap_trace(elastic.spaces, Contacts((pairing,)))
    gap, load = 0.5 * (pairing.points[:, 0] - 0.02) ** 2, np.array([2e4])
    if method != "condensed":
        stiffness = (default_penalty if method == "penalty" else nitsche_stiffness)(
            elastic, pairing
        )
        stress = None if method == "penalty" else normal_traction(elastic, pairing)
        modes = (pairing.normals @ [0.0, -1.0])[:, None]
        known = elastic, pairing, trace, trace, modes, modes, stiffness, stress
        found = FullContact(*known).solve(gap, load)
        return pairing.points[:, 0], found.pressure, found.motion[0]
    basis = pressure_basis(pairing, max(degree - 1, 1))
    holder = hold(
        Contacts((pairing,)), pairing.normals, [RigidMode(translation((0.0, -1.0)), load=1.0)]
    )
    contact = condense(elastic, pairing.weights, trace, trace, basis, holder)
    λ = np.random.default_rng(1).uniform(0, 1e8, basis.shape[1])
    u = elastic.solve(trace @ (pairing.weights * (basis @ λ)))
    weak = contact.weak(sum_over_ranks(COMM, trace.T @ u))
    np.testing.assert_allclose(contact.compliance @ λ, weak, rtol=1e-9)
    solution = solve_contact(contact.compliance, contact.weak(gap), contact.modes, load)
    return pairing.points[:, 0], basis @ solution.coefficients, solution.motion[0]


@pytest.mark.parametrize("method", ["condensed", "penalty", "nitsche"])
def test_contact_like_one_body(method):
    """requirement: a pad glued on its back touches as one of one mesh, condensed or not."""
    (x, glued, approach), (at, whole, expected) = pressed(6, method), pressed(6, method, True)
    assert approach == pytest.approx(expected, rel=1e-4)
    assert glued == pytest.approx(np.interp(x, at, whole), abs=1e-3 * whole.max())


@pytest.mark.parametrize("cells", ["tetrahedron", ("hexahedron", "tetrahedron")])
def test_free_motions_of_glued_bodies(cells):
    """requirement: a body without a support of its own is held by those glued to it."""
    ends = ((0.0, 0.04), (0.0, 0.04))
    given = Box("a", (*ends, (0.0, 0.02)), (2, 2, 1)), Box("b", (*ends, (-0.03, 0.0)), (1, 1, 1))
    mesh, every = tagged_boxes(given, cells=cells), ["along x", "along y", "along z"]
    every += ["about x", "about y", "about z"]
    clamped, guided = ["b_low_z"], ((), (), ())
    assert free_motions(mesh, ["a"], clamped, guided) == every
    assert free_motions(mesh, ["a", "b"], clamped, guided) == []
    apart = (("a_low_x",), ("b_low_y",), ())  # each guides the others
    assert free_motions(mesh, ["a", "b"], (), apart) == ["along z"]


def test_glued_bodies_are_factorised():
    """requirement: multigrid is refused in one line, and not chosen where a factor fits."""
    bodies, joined, _ = stack("hexahedron", True)
    assert choose_solver("auto", bodies, 2, True, glued=joined).name == "direct"
    with pytest.raises(CaseError, match=r"^mesh\.solver: glued bodies are solved by a factor"):
        choose_solver("multigrid", bodies, 2, False, glued=joined)
    materials = {"upper": (E, 0.3), "lower": (E, 0.3)}
    known = bodies, 2, joined, materials, ["lower_low_z"]
    with pytest.raises(CaseError, match=r"^mesh\.solver: glued bodies are solved by a factor"):
        glued_elasticity(*known, choice=SolverChoice("multigrid", available=1.0))


def test_the_smaller_face_has_the_multipliers():
    """requirement: the first face of a joint lies opposite the other one as a whole."""
    small = Box("small", ((0.01, 0.02), (0.0, 0.01)), (1, 1))
    large = Box("large", ((0.0, 0.04), (-0.01, 0.0)), (8, 2))
    bodies = boxes(small, large)
    for surfaces in (("small_low_y", "large_high_y"), ("large_high_y", "small_low_y")):
        tie = glued_points(*gather_faces(bodies, surfaces), PLANE, 2)
        assert tie.sides[0].face.name == "small_low_y"
        assert tie.unpaired == pytest.approx(0.0, abs=1e-9)


def test_glued_faces_that_are_apart():
    """requirement: refused in one line that names them."""
    upper = Box("upper", ((0.0, 0.04), (0.002, 0.02)), (2, 1))
    bodies = boxes(upper, Box("lower", ((0.0, 0.04), (-0.02, 0.0)), (3, 1)))
    faces = gather_faces(bodies, ("upper_low_y", "lower_high_y"))
    with pytest.raises(CaseError, match=r"glued faces upper_low_y and lower_high_y are "):
        glued_points(*faces, PLANE, 2)


def numbers():
    """Displacements of the points, multipliers and reactions of a glued chain with a contact."""
    _, pressure, approach = pressed(3)
    bodies, joined, up = stack("tetrahedron", True)
    materials = {"upper": (E, 0.3), "lower": (E / 50, 0.3)}
    guides = {"rollers": ("upper_low_y", "lower_low_y")}
    elastic, _ = glued_elasticity(bodies, 2, joined, materials, [f"lower_low_{up}"], **guides)
    loads = forces(elastic, {"upper_high_z": np.array([1e4, 2e4, -3e4])})
    u = elastic.solve(loads)
    multipliers = elastic.multipliers(u, loads)
    reactions = sum_over_ranks(COMM, elastic.reactions(u, loads).reshape(-1, 3).sum(axis=0))
    return [
        *(pressure / 1e6),
        1e9 * approach,
        *(multipliers / 1e6),
        *reactions,
        _work(elastic, loads),
    ]


@pytest_needs_ranks
def test_two_ranks_give_the_serial_numbers():
    """requirement: displacement, traction and reactions on two ranks as on one, to 1e-8."""
    assert on_two_ranks("test_glued") == pytest.approx(numbers(), rel=1e-8, abs=1e-7)


def on_two_ranks(module):
    """List of numbers of a test module, on two ranks."""
    script = (
        f"import json; from tests.contact.{module} import COMM, numbers; found = numbers()\n"
        "if COMM.rank == 0: print(json.dumps([float(x) for x in found]))"
    )
    command = ["mpirun", "--oversubscribe", "-n", "2", sys.executable, "-c", script]
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))}
    environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env=environment, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
