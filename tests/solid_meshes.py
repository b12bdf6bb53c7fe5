"""Meshes of bodies in space made and written by gmsh, as its users do."""

from __future__ import annotations

from thermowear.geometry.mesh.gmsh_session import gmsh_model

BLOCKS = {
    "bodies": {"pad": "PAD", "disk": "DISK"},
    "contact": ["PAD_FACE", "DISK_FACE"],
    "held": "PAD_BACK",
    "fixed": "DISK_BOTTOM",
}
"""Names in the files of `write_blocks`, with bodies that do not share nodes."""
GLUED = BLOCKS | {
    "surfaces": {"PAD_FACE": "FACE", "DISK_FACE": "FACE"},
}
"""Names for bodies that share the nodes of their joint."""
PAD, DISK = (20.0, 30.0, 10.0), (40.0, 50.0, 15.0)
"""Sizes of the blocks in the unit of the file."""


def write_blocks(path, order=1, hexahedra=False, glued=False, size=8.0, **options):
    """Write a block on a larger one, in the unit of the file.

    Parameters
    ----------
    path : Path
        The ending selects the format.
    order : int
    hexahedra : bool
        Cells are hexahedra instead of tetrahedra.
    glued : bool
        The bodies share the nodes of their joint.
    size : float
        Size of the cells.
    **options
        Further options ``Mesh.…`` of gmsh.
    """
    with gmsh_model("blocks") as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        pad = occ.addBox(-PAD[0] / 2, -PAD[1] / 2, 0, *PAD)
        disk = occ.addBox(-DISK[0] / 2, -DISK[1] / 2, -DISK[2], *DISK)
        if glued:
            occ.fragment([(3, pad)], [(3, disk)])
        occ.synchronize()
        surfaces = model.getEntities(2)
        groups = {"PAD_BACK": [], "DISK_BOTTOM": [], "PAD_FACE": [], "DISK_FACE": [], "SIDES": []}
        for _, tag in surfaces:
            _, _, z = model.occ.getCenterOfMass(2, tag)
            above, _ = model.getAdjacencies(2, tag)
            level = {PAD[2]: "PAD_BACK", -DISK[2]: "DISK_BOTTOM"}.get(round(z, 9), "SIDES")
            if abs(z) < 1e-9:
                level = "PAD_FACE" if pad in above else "DISK_FACE"
            groups[level].append(tag)
        if glued:
            groups["FACE"], groups["REST"] = groups.pop("PAD_FACE"), groups.pop("DISK_FACE")
        model.addPhysicalGroup(3, [pad], name="PAD")
        model.addPhysicalGroup(3, [disk], name="DISK")
        for name, tags in groups.items():
            model.addPhysicalGroup(2, tags, name=name)
        given = {"MeshSizeMax": size, "MeshSizeMin": size, "ElementOrder": order} | options
        if hexahedra:
            given |= {"SubdivisionAlgorithm": 2}
        for key, value in given.items():
            gmsh.option.setNumber(f"Mesh.{key}", value)
        model.mesh.generate(3)
        gmsh.write(str(path))
    return path
