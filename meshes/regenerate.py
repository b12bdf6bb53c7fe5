"""Make the reference meshes in this folder anew (``make meshes``)."""

from pathlib import Path

import thermowear as tw
from thermowear.geometry.reading.export import write_mesh

HERE = Path(__file__).parent
DEMOS = HERE.parent / "demos"
MESHES = {
    "annular_punch.msh": ("annular_punch.toml",),
    "annular_punch_not_matching.msh": (
        "annular_punch.toml",
        "mesh.bodies.plate.elements=17",
        "mesh.bodies.plate.grading=0.45",
    ),
    "cylinder_on_block.msh": ("cylinder_on_block.toml",),
}
"""The demo and what is changed in it, by file."""

if __name__ == "__main__":
    for name, (demo, *overrides) in MESHES.items():
        mesh = tw.load(DEMOS / demo, tuple(overrides)).tagged_mesh()
        write_mesh(mesh, HERE / name)
        print(f"{name}: {len(mesh.cells)} quadrilaterals, {len(mesh.points)} points")
