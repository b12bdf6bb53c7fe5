"""Bodies in space on mid-planes z = const: exact states, disks between two pads, a ring."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.brakes.disk_brake import DiskSector
from thermowear.geometry.mesh.tagged import compact
from thermowear.geometry.meshing.cells import (
    divided_hexahedra,
    level,
    mesh_lattice,
    tagged_bodies,
)
from thermowear.geometry.meshing.divisions import graded_face, growing, joined
from thermowear.geometry.reading.export import write_mesh
from thermowear.simulation.from_case import model_of

from ..case.starter import changed, tables
from ..conftest import NAMES
from ..contact.solids import HEIGHTS, SIZE, two_solids
from .space import BRAKE

FORCE, HOT = 6e3, 60.0
STEEL = {"young_modulus": "200 GPa", "poisson_ratio": 0.3, "expansion": "1.2e-5 1/K"}
ALUMINIUM = {"young_modulus": "70 GPa", "poisson_ratio": 0.34, "expansion": "2.4e-5 1/K"}


def blocks_on_planes(folder, cell_type, **geometry):
    """Case of two hot blocks between smooth planes, a quarter of them."""
    path = folder / "blocks.msh"
    write_mesh(two_solids(((3, 2, 2), (2, 3, 2)), 1, cell_type=cell_type), path)
    known = NAMES | {
        "type": "file",
        "path": str(path),
        "symmetry": ["upper_low_x", "lower_low_x"],
        "rollers": ["upper_low_y", "lower_low_y"],
        "mid_plane": ["upper_end", "lower_end"],
    }
    conducting = {"conductivity": "50 W/(m K)"}
    return {
        "model": "3d",
        "geometry": known | geometry,
        "mesh": {"degree": 2},
        "bodies": {"upper": STEEL | conducting, "lower": ALUMINIUM | conducting},
        "load": {"force": f"{FORCE} N"},
        "heat": {"ambient": "20 degC", "temperature": dict.fromkeys(_ENDS, f"{20 + HOT} degC")},
        "analysis": {"type": "initial"},
    }


_ENDS = "upper_end", "lower_end"


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
def test_pressed_and_heated_blocks(tmp_path, cell_type):
    """
    requirement: blocks of different materials, free to slide on each other and on the planes that
    press and bear them, have an even pressure, uniaxial stress and free expansion.
    """
    result = tw.run(tw.load(blocks_on_planes(tmp_path, cell_type)))
    p = FORCE / (SIZE[0] * SIZE[1])
    np.testing.assert_allclose(result.interface.pressure, p, rtol=1e-9)
    fields = result.fields
    for number, E, ν, α, end in ((1, 2e11, 0.3, 1.2e-5, 1), (2, 7e10, 0.34, 2.4e-5, -HEIGHTS[1])):
        u, x = (v[fields.body == number] for v in (fields.displacement, fields.points))
        strain = p / E * np.array([ν, ν, -1.0]) + α * HOT
        expected = strain * (x - [0.0, 0.0, end])
        if number == 1:  # the holder has moved as well
            expected[..., 2] += (u - expected)[0, 0, 2]
        # sampled slightly inside of the cells
        np.testing.assert_allclose(u, expected, rtol=0.0, atol=2e-6 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("planes", "free"),
    [
        ({"symmetry": []}, "'upper': its supports leave it free to move along x; clamp"),
        ({"rollers": []}, "'upper': its supports leave it free to move along y; clamp"),
        (
            {"symmetry": [], "rollers": [], "mid_plane": ["lower_end"]},
            "'lower': its supports leave it free to move along x, along y and about z; clamp",
        ),
    ],
)
@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_a_loose_body_is_refused(tmp_path, planes, free, solver):
    """requirement: one line in place of a singular matrix, for every solver."""
    case = tw.load(blocks_on_planes(tmp_path, "tetrahedron", **planes), [f"mesh.solver={solver}"])
    with pytest.raises(tw.CaseError, match=f"^Body {free}"):
        case.tagged_mesh()
    with pytest.raises(tw.CaseError, match=f"^Body {free} one of its surfaces, or add planes"):
        tw.run(case)


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({"mid_plane": ["lower_high_y"]}, "'lower_high_y' does not lie in a plane z = const"),
        ({"mid_plane": ["upper_high_x"]}, "'upper_high_x' is not on the boundary of body 'lower'"),
        ({"mid_plane": ["lower_face"]}, "the bodies lie on both sides of the plane of 'lower_face"),
    ],
)
def test_faulty_planes(tmp_path, keys, expected):
    """requirement: one line at the key."""
    with pytest.raises(tw.CaseError, match=f"^geometry.mid_plane: {expected}"):
        tw.run(tw.load(blocks_on_planes(tmp_path, "tetrahedron", **keys)))


def test_a_pressure_on_the_plane_is_refused(tmp_path):
    case = blocks_on_planes(tmp_path, "tetrahedron", fixed="lower_high_x", mid_plane=["lower_end"])
    case["load"]["pressure"] = {"lower_end": "1 MPa"}
    with pytest.raises(tw.CaseError, match=r"load.pressure.lower_end: lies on a mid-plane"):
        tw.load(case)


def write_disk(path, whole):
    """Write a disk clamped at its inside, with one pad: half of it, or the whole."""
    geometry = DiskSector(**BRAKE["geometry"])
    mesh = geometry.build(MeshTable(degree=2, elements=4, grading=0.6))
    if whole:
        mesh = mirrored(mesh, -geometry.disk_thickness / 2)
    write_mesh(mesh, path)
    return geometry.contact_area()


def mirrored(mesh, plane):
    """Mesh with the mirror image of its disk below a plane, joined to it there."""
    own = mesh.cells[mesh.cell_tags == 2]
    nodes = np.unique(own)
    copies = np.arange(len(mesh.points))
    below = nodes[mesh.points[nodes, 2] > plane + 1e-9]
    copies[below] = len(mesh.points) + np.arange(len(below))
    points = mesh.points[below] * [1, 1, -1] + [0, 0, 2 * plane]
    middle, inside = (mesh.surfaces.index(f"disk_{name}") + 1 for name in ("middle", "inside"))
    kept = mesh.facet_tags != middle
    far = [copies[mesh.facets_of(f"disk_{name}")] for name in ("face", "inside")]
    facets = mesh.facets[kept], *far
    tags = mesh.facet_tags[kept], np.full(len(far[0]), middle), np.full(len(far[1]), inside)
    names = tuple("disk_opposite" if s == "disk_middle" else s for s in mesh.surfaces)
    return compact(
        replace(
            mesh,
            points=np.concatenate([mesh.points, points]),
            cells=np.concatenate([mesh.cells, copies[own]]),
            cell_tags=np.concatenate([mesh.cell_tags, np.full(len(own), 2)]),
            facets=np.concatenate(facets),
            facet_tags=np.concatenate(tags).astype(mesh.facet_tags.dtype),
            surfaces=names,
        )
    )


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_half_of_a_disk_between_two_pads(tmp_path, solver):
    """
    requirement: a pad that wears alike everywhere presses evenly; the same pressure on the other
    side of the whole disk makes it symmetric, so that its half on a mid-plane deforms alike.
    """
    results = []
    for whole in (False, True):
        path = tmp_path / f"{whole}.msh"
        area = write_disk(path, whole)
        known = {
            "type": "file",
            "path": str(path),
            "bodies": {"pad": "pad", "disk": "disk"},
            "contact": ["pad_face", "disk_face"],
            "held": "pad_back",
            "fixed": "disk_inside",
            "rotation_center": ["0 mm", "0 mm"],
        }
        support = {"surfaces": {"far": "disk_opposite"}} if whole else {"mid_plane": ["middle"]}
        support |= {} if whole else {"surfaces": {"middle": "disk_middle"}}
        case = BRAKE | {"geometry": known | support, "contact": {}}
        case["mesh"] = {"degree": 2, "solver": solver}
        law = {"coefficient": "1e-9 m/s/MPa", "per": "pressure", "velocity_exponent": 0.0}
        case["wear"] = {"pad": law}
        case["load"] = {"force": "10 kN"}
        if whole:
            case["load"]["pressure"] = {"far": f"{1e4 / area!r} Pa"}
        results.append(tw.run(tw.load(case)))
    half, whole = results
    places = [np.array([r.interface.x, r.interface.y]) for r in results]
    np.testing.assert_allclose(half.interface.pressure, 1e4 / area, rtol=1e-3)
    order, other = (np.lexsort(np.round(1e8 * i)) for i in places)
    shapes = half.interface.shape[order], whole.interface.shape[other]
    np.testing.assert_allclose(*shapes, rtol=0.0, atol=1e-4 * np.ptp(shapes[1]))


def quarter_ring(path, cell_type):
    """Write a quarter of a ring of lining on the upper half of a disk, with quadratic cells."""
    radii = graded_face(0.08, 0.12, 8, 0.5)
    thin = float(np.diff(radii).min())
    inside, outside = (growing(start, end, thin, 0.5, 0.01) for start, end in _BESIDE)
    angles, order = np.linspace(0.0, np.pi / 2, 7), 2

    def turned(radii, heights):
        def place(p):
            r, angle, z = np.moveaxis(p, -1, 0)
            return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)

        body = mesh_lattice((radii, angles, heights), order, place)
        return body if cell_type == "hexahedron" else divided_hexahedra(body, order)

    bodies = {
        "pad": turned(radii, growing(0.0, 0.015, thin, 0.5, 0.005)),
        "disk": turned(joined(inside, radii, outside), growing(0.0, -0.006, thin, 0.5, 0.003)),
    }
    claims = {"pad_face": level(2, 0.0), "pad_back": level(2, 0.015)}
    claims |= {"disk_face": level(2, 0.0), "disk_middle": level(2, -0.006)}
    claims |= {f"{body}_on_{axis}": level(k, 0.0) for body in bodies for k, axis in enumerate("xy")}
    claims |= {"disk_outside": lambda p: np.hypot(p[..., 0], p[..., 1]).min(axis=1) > 0.1299}
    write_mesh(replace(tagged_bodies(bodies, claims), cell_type=cell_type), path)


_BESIDE = (0.08, 0.06), (0.12, 0.13)


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
def test_a_ring_in_space_and_in_a_section(tmp_path, cell_type):
    """
    requirement: a ring of lining on half of a hot disk wears to the axisymmetric shape within 1 %;
    the disk, whose middle plane is held axially only, grows as much within 0.1 %.
    """
    case = tables("disk-brake")
    case["geometry"] |= {"pad_outer_radius": "120 mm", "disk_outer_radius": "130 mm"}
    case["geometry"] |= {"disk_inner_radius": "60 mm", "pad_angle": "360 deg"}
    case["heat"]["cooling"] = {"disk_outside": "600 W/(m^2 K)", "pad_back": "20 W/(m^2 K)"}
    section = tw.run(tw.load(case))
    quarter_ring(tmp_path / "ring.msh", cell_type)
    known = {
        "type": "file",
        "path": str(tmp_path / "ring.msh"),
        "bodies": {"pad": "pad", "disk": "disk"},
        "contact": ["pad_face", "disk_face"],
        "held": "pad_back",
        "fixed": "disk_middle",
        "mid_plane": ["disk_middle"],
        "symmetry": ["pad_on_x", "disk_on_x"],
        "rollers": ["pad_on_y", "disk_on_y"],
        "surfaces": {"disk_outside": "disk_outside"},
        "rotation_center": ["0 mm", "0 mm"],
    }
    case |= {"model": "3d", "geometry": known, "mesh": {"degree": 2}, "load": {"force": "125 N"}}
    solid = tw.run(tw.load(case))
    i, flat = solid.interface, section.interface
    order = np.argsort(flat.x)
    expected = np.interp(np.hypot(i.x, i.y), flat.x[order], flat.shape[order])
    deviation = i.shape - expected
    deviation -= np.average(deviation, weights=i.weight)
    assert np.abs(deviation).max() < 0.01 * np.ptp(expected)
    grown = [_growth(result.fields) for result in (solid, section)]
    assert grown[0] == pytest.approx(grown[1], rel=1e-3)
    assert grown[1] > 1e-5


def _growth(fields):
    """Mean radial displacement of the rim of the disk, in space or in a section [m]."""
    at, u = (v[fields.body == 2][..., :-1] for v in (fields.points, fields.displacement))
    r = np.linalg.norm(at, axis=-1)
    return np.einsum("...i,...i->...", u, at)[r > 0.13 - 1e-9].mean() / 0.13


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_friction_twists_a_disk_on_its_mid_plane(solver):
    """
    requirement: a plane normal to the axis cuts no sector: friction turns the rim about the hub by
    ∫ M(r) / (2π G t r³) dr, M the moment of friction beyond r, in the mean over rim and thickness.
    """
    case = changed(BRAKE, {"geometry.hub": True, "mesh.solver": solver})
    assert not model_of(tw.load(case)).sector_of_ring
    result = tw.run(tw.load(case))
    i, stiffness = result.interface, 110e9 / 2 / 1.28
    distance = np.hypot(i.x, i.y)
    moments = 0.35 * i.pressure * i.weight * distance
    # every point contributes from the inside of the disk to its own radius
    angle = np.sum(moments * (0.06**-2 - distance**-2)) / (4 * np.pi * stiffness * 0.01)
    fields = result.fields
    at, u = (v[fields.body == 2].reshape(-1, 3) for v in (fields.points, fields.displacement))
    on_rim = np.hypot(at[:, 0], at[:, 1]) > 0.13 - 1e-9
    at, u = at[on_rim], u[on_rim]
    turned = -(at[:, 0] * u[:, 1] - at[:, 1] * u[:, 0]) / 0.13**2
    around, down = np.arctan2(at[:, 1], at[:, 0]), np.round(at[:, 2], 9)
    levels = np.unique(down)
    means = [_mean_around(around[down == z], turned[down == z]) for z in levels]
    mean = np.trapezoid(means, levels) / 0.01
    assert mean == pytest.approx(angle, rel=0.01)


def _mean_around(angles, values):
    """Mean of a periodic function round the axis, from samples at uneven angles."""
    places, first = np.unique(np.round(angles, 9), return_index=True)
    return np.trapezoid(
        np.append(values[first], values[first[0]]), np.append(places, places[0] + 2 * np.pi)
    ) / (2 * np.pi)
