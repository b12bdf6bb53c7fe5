"""Make the reference meshes in this folder anew (``make meshes``)."""

from pathlib import Path

import thermowear as tw
from thermowear.geometry.export import write_mesh

HERE = Path(__file__).parent
CASE = HERE.parent / "demos" / "annular_punch.toml"
MESHES = {
    "annular_punch.msh": (),
    "annular_punch_not_matching.msh": (
        "mesh.bodies.plate.elements=17",
        "mesh.bodies.plate.grading=0.45",
    ),
}

if __name__ == "__main__":
    for name, overrides in MESHES.items():
        case = tw.load(CASE, overrides)
        mesh = case.tagged_mesh()
        write_mesh(mesh, HERE / name)
        print(f"{name}: {len(mesh.cells)} quadrilaterals, {len(mesh.points)} points")
