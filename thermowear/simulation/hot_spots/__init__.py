"""Hot spots: thermoelastic instability that varies along the sliding direction."""
