"""Contact search: common part of two faces, common refinement, pairing."""
