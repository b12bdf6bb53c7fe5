"""Animations of a results folder with frames."""

from .make import FPS, check_film, draw_animation, has_frames

__all__ = ["FPS", "check_film", "draw_animation", "has_frames"]
