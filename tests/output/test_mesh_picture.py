"""Pictures of meshes with their named surfaces."""

import matplotlib.image as mpimg
import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.solids.cad_file import CadFile
from thermowear.geometry.mesh.mixed import outside

from ..cad_parts import PAD, write_blocks
from ..geometry.test_cad import KEYS


@pytest.fixture(scope="module")
def blocks(tmp_path_factory):
    return write_blocks(tmp_path_factory.mktemp("blocks"))


def test_the_boundary_with_its_names(blocks):
    """requirement: all facets of a body, each with the name of its surface."""
    keys = KEYS | {"paths": blocks}
    mesh = CadFile.model_validate(keys, context={"model": "3d"}).build(MeshTable(), None)
    points, facets, surface = outside(mesh, "pad")
    x = 1e3 * points[facets]
    areas = np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1) / 2
    a, b, c = PAD
    assert areas.sum() == pytest.approx(2 * (a * b + b * c + c * a))
    for name in ("pad_face", "back"):
        assert areas[surface == mesh.surfaces.index(name)].sum() == pytest.approx(a * b)
    assert areas[surface < 0].sum() == pytest.approx(2 * (b * c + c * a))


def test_the_picture(tmp_path, capsys):
    """requirement: `mesh -o FILE.png` shows all bodies in space, and refuses sections."""
    assert main(["init", "cad-pad", "-o", str(tmp_path / "case.toml")]) == 0
    command = ["mesh", str(tmp_path / "case.toml"), "--set", "mesh.size=20 mm"]
    assert main([*command, "-o", str(tmp_path / "mesh.png")]) == 0
    picture = mpimg.imread(tmp_path / "mesh.png")[..., :3]
    assert min(picture.shape[:2]) > 600
    assert (picture.min(axis=2) < 0.9).mean() > 0.1
    assert len(np.unique(np.round(picture[::4, ::4].reshape(-1, 3), 1), axis=0)) > 12
    assert main(["init", "own-mesh", "-o", str(tmp_path / "flat.toml")]) == 0
    capsys.readouterr()
    assert main(["mesh", str(tmp_path / "flat.toml"), "-o", str(tmp_path / "flat.png")]) == 1
    assert "pictures of meshes require a 3d model" in capsys.readouterr().err
