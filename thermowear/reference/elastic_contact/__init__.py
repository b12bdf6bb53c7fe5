"""Elastic bodies in contact: Hertz, Mindlin, and contacts that grow by wear."""
