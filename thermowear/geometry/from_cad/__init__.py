"""Bodies drawn in CAD (STEP, BREP): their faces, the faces that touch, and their mesh by gmsh."""
