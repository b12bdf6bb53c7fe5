"""Pictures of bodies by VTK, in a process of their own that may crash."""

from .renderer import PictureJob, Renderer, attempt
