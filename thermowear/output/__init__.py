"""Results folder, tables, pictures and what the terminal shows. No physics."""
