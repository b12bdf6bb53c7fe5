"""Export of designed (worn) shapes: tables, meshes and STEP files."""
