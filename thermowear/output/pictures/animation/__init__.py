"""Animations of a results folder with frames."""

from .make import FPS, check_animation, draw_animation, has_frames
