"""Results folder, tables, pictures, report and console output; no physics."""
