"""Reader of gmsh mesh files."""
