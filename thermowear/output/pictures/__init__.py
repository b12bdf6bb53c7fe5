"""Pictures of a results folder, made from its files alone."""

from .make import make_animation, make_pictures

__all__ = ["make_animation", "make_pictures"]
