"""Elasticity of the bodies."""
