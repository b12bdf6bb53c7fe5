"""Pictures of contact in space: maps of the face, and the bodies cut open."""

from functools import cache

import matplotlib.image as mpimg
import meshio
import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.output.pictures.maps import draw_friction_maps, triangulated

from ..case.starter import changed, tables
from ..simulation.space import BRAKE, PUNCH


def areas(triangles):
    """Area of each triangle that is drawn."""
    shown = triangles.get_masked_triangles()
    x, y = triangles.x[shown], triangles.y[shown]
    return 0.5 * (
        (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    )


def grid(columns, rows):
    x, y = np.meshgrid(columns, rows, indexing="ij")
    return x.ravel(), y.ravel()


GRADED = np.array([0.0, 1e-3, 1e-2, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0])


@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_a_graded_rectangle_is_filled(turn):
    """requirement: thin cells at the boundary are not masked."""
    x, y = grid(60 * GRADED, 80 * GRADED)
    triangles = triangulated(
        x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
    )
    assert areas(triangles).sum() == pytest.approx(60 * 80, rel=1e-6)


@pytest.mark.parametrize("angle", [30, 60, 120, 150])
def test_the_bay_of_a_sector_is_left_out(angle):
    """requirement: nothing is drawn outside the face."""
    angles = np.radians(angle) * (GRADED - 0.5)
    fine = np.unique(np.concatenate([angles, np.linspace(angles[0], angles[-1], 25)]))
    r, φ = grid(np.array([80.0, 80.2, 85.0, 100.0, 115.0, 119.8, 120.0]), fine)
    found = areas(triangulated(r * np.cos(φ), r * np.sin(φ))).sum()
    assert found == pytest.approx(np.radians(angle) / 2 * (120**2 - 80**2), rel=5e-3)


CURVES = "history", "loads", "cycles"
BALL = {"mesh.elements": 6, "analysis.increments": 3, "wear.cycles": 2}
BALL |= {"analysis.output_times": ["0.0625 s"]}


@pytest.fixture(scope="module")
def folder_of(tmp_path_factory):
    """Results of a running-in or of a steady run, with their pictures, by name."""
    ending = {"type": "transient", "end_time": "1000 s"}
    cases = {
        "punch": changed(PUNCH, {"analysis": ending, "wear.block": {"coefficient": "1e-7 1/MPa"}}),
        "brake": BRAKE,
        "ball": tables("sphere-fretting", BALL),
    }

    @cache
    def run(name):
        file = tmp_path_factory.mktemp("space") / f"{name}.toml"
        file.write_text(tomli_w.dumps(cases[name]), encoding="utf-8")
        assert main(["run", str(file), "-o", str(file.parent / name)]) == 0
        return file.parent / name

    return run


@pytest.mark.parametrize(
    ("name", "pictures"),
    [
        ("punch", {"interface", "wear", "history", "bodies", "deformed", "faces"}),
        pytest.param(
            "ball",
            {"interface", "wear", "friction", "loads", "cycles", "bodies", "deformed", "faces"},
            marks=pytest.mark.slow,
        ),
        pytest.param("brake", {"interface", "bodies", "deformed", "faces"}, marks=pytest.mark.slow),
    ],
)
def test_every_picture_shows_something(folder_of, name, pictures):
    """requirement: all pictures of a 3D model exist and are not empty."""
    folder = folder_of(name)
    assert {path.stem for path in folder.glob("*.png")} == pictures
    for path in folder.glob("*.png"):
        image = mpimg.imread(path)[..., :3]
        assert min(image.shape[:2]) > 400, path
        coloured = (image.max(axis=2) - image.min(axis=2)) > 0.1
        assert coloured.mean() > (0.003 if path.stem in CURVES else 0.05), path


def test_the_fields_are_volumes(folder_of):
    """requirement: the fields are written as hexahedra."""
    mesh = meshio.read(folder_of("punch") / "fields.vtu")
    assert {block.type for block in mesh.cells} == {"hexahedron"}
    assert np.ptp(mesh.points, axis=0) == pytest.approx([0.12, 0.14, 0.11])
    assert mesh.point_data["displacement_m"].shape[1] == 3


def test_friction_in_space_is_drawn_with_its_direction(tmp_path):
    """requirement: maps of shear and slip with arrows, energy, and what sticks and slips."""
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    x, y = grid(1e-3 * np.linspace(0.1, 1, 6), angle)
    x, y = x * np.cos(y), x * np.sin(y)
    size = np.hypot(x, y)
    names = "x_m", "y_m", "z_m", "s_m", "shear_Pa", "shear_x_Pa", "shear_y_Pa", "slip_m"
    names += "slip_x_m", "slip_y_m", "dissipated_J_per_m2", "status"
    columns = x, y, 0 * x, np.nan * x, 1e9 * size, 1e9 * x, 1e9 * y, size, -x, -y, size**2
    table = np.column_stack([*columns, np.where(size < 5e-4, 1, 2)])
    np.savetxt(tmp_path / "friction.csv", table, delimiter=",", header=",".join(names), comments="")
    draw_friction_maps(tmp_path)
    image = mpimg.imread(tmp_path / "friction.png")[..., :3]
    assert ((image.max(axis=2) - image.min(axis=2)) > 0.1).mean() > 0.2


@pytest.mark.parametrize("graded", [False, True])
def test_slots_are_left_out(graded):
    """requirement: nothing is drawn across a slot that separates the points of a face."""
    along = 30 * GRADED if graded else np.linspace(0.0, 30.0, 31)
    x, y = grid(np.linspace(0.0, 40.0, 81), np.concatenate([along, 36 + along]))
    steps = np.gradient(along)
    weights = np.tile(np.concatenate([steps, steps]) * 0.5, 81)
    assert areas(triangulated(x, y)).sum() == pytest.approx(40 * 66, rel=1e-6)
    assert areas(triangulated(x, y, weights)).sum() == pytest.approx(2 * 40 * 30, rel=0.02)


def test_small_weights_tear_no_holes():
    """requirement: points of small pieces of facets do not take triangles out of a face."""
    rng = np.random.default_rng(5)
    x, y = grid(np.linspace(0.0, 40.0, 41), np.linspace(0.0, 40.0, 41))
    weights = np.where(rng.random(len(x)) < 0.1, 1e-3, 1.0)
    assert areas(triangulated(x, y, weights)).sum() == pytest.approx(40 * 40, rel=1e-9)


def test_uneven_points_tear_no_holes():
    """requirement: a place where a few points have much less area than their spacing is no gap."""
    x, y = grid(np.linspace(0.0, 40.0, 41), np.linspace(0.0, 40.0, 41))
    weights = np.where(np.hypot(x - 20, y - 20) < 2.2, 0.02, 1.0)
    assert areas(triangulated(x, y, weights)).sum() == pytest.approx(40 * 40, rel=1e-9)
