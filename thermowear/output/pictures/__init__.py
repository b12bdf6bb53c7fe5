"""Pictures of a results folder, drawn from its files."""

from .make import make_animation, make_mesh_picture, make_pictures
