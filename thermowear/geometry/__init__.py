"""Built-in geometries, mesh files, meshing, mesh motion, export to CAD."""

from .mesh.tagged import TaggedMesh
