"""Contact search: faces, projection, common refinement, pairing."""
