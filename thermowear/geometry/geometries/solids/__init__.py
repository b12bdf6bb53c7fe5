"""Geometries of bodies in space that begin as CAD files."""
