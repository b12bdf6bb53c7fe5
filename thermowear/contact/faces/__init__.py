"""Contact faces: facets and interpolation on them, normals, projection, values by part."""
