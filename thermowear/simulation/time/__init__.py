"""Time integration with error control."""
