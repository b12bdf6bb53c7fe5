"""Mesh file of a pad of two materials on a block, made with gmsh as by a user."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermowear.geometry.mesh.gmsh_session import gmsh_model

WIDTH, LINING, BACKING, BLOCK = 40.0, 10.0, 5.0, 20.0
"""Sizes in the unit of the file; side by side both materials are as wide as each other."""


def write_layered(path: Path, side_by_side: bool = False, left: float = 0.0) -> Path:
    """Rectangles: the lining on the block, and the backing on the lining, or beside it.

    Cells: ``PAD`` with ``LINING`` and ``BACKING``, ``BLOCK``. Lines: ``FACE``, ``BLOCK_FACE``,
    ``TOP``, ``BOTTOM``.
    """
    with gmsh_model("layered") as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        half = WIDTH / 2
        if side_by_side:
            lining = occ.addRectangle(left, 0, 0, half, LINING)
            backing = occ.addRectangle(left + half, 0, 0, half, LINING)
        else:
            lining = occ.addRectangle(left, 0, 0, WIDTH, LINING)
            backing = occ.addRectangle(left, LINING, 0, WIDTH, BACKING)
        occ.fragment([(2, lining)], [(2, backing)])
        block = occ.addRectangle(left, -BLOCK, 0, WIDTH, BLOCK)
        occ.synchronize()
        top = LINING if side_by_side else LINING + BACKING
        box = model.getEntitiesInBoundingBox

        def level(y: float) -> list[int]:
            found = box(left - 1, y - 0.01, -1, left + WIDTH + 1, y + 0.01, 1, dim=1)
            return [tag for _, tag in found]

        of_block = [t for _, t in model.getBoundary([(2, block)], oriented=False)]
        groups = {
            "FACE": [tag for tag in level(0.0) if tag not in of_block],
            "BLOCK_FACE": [tag for tag in level(0.0) if tag in of_block],
            "TOP": level(top),
            "BOTTOM": level(-BLOCK),
        }
        cells = {"PAD": [lining, backing], "LINING": [lining], "BACKING": [backing]}
        for name, tags in (cells | {"BLOCK": [block]}).items():
            model.addPhysicalGroup(2, tags, name=name)
        for name, tags in groups.items():
            model.addPhysicalGroup(1, tags, name=name)
        for _, curve in model.getEntities(1):
            long = model.occ.getMass(1, curve) >= half
            model.mesh.setTransfiniteCurve(curve, 7 if long and not side_by_side else 4)
        for _, surface in model.getEntities(2):
            model.mesh.setTransfiniteSurface(surface)
            model.mesh.setRecombine(2, surface)
        model.mesh.generate(2)
        gmsh.write(str(path))
    return path


def layered_case(path: Path, **materials: Any) -> dict[str, Any]:
    """Tables of a case, without materials of the pad but those given by cell set."""
    return {
        "model": "plane-strain",
        "geometry": {
            "type": "file",
            "path": str(path),
            "length_unit": "1 mm",
            "bodies": {"pad": ["LINING", "BACKING"], "block": "BLOCK"},
            "contact": ["FACE", "BLOCK_FACE"],
            "held": "TOP",
            "fixed": "BOTTOM",
            "thickness": "10 mm",
        },
        "mesh": {"degree": 3},
        "bodies": {
            "pad": {"materials": materials},
            "block": {"young_modulus": "4 GPa", "poisson_ratio": 0.0},
        },
        "load": {"force": "400 N"},
        "contact": {},
        "analysis": {"type": "initial"},
    }
