"""Cases of more than two bodies: geometries, tables, schema and checks."""
