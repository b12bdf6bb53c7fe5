"""Pictures of bodies in space, drawn by pyvista in the rendering process."""
