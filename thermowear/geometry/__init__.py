"""Geometries and meshes: built-in geometries, mesh files, mesh motion, shapes for CAD."""

from .mesh.tagged import TaggedMesh

__all__ = ["TaggedMesh"]
