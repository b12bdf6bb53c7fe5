"""Pictures of bodies by VTK, in a process of their own that may crash."""

from .jobs import PictureJob, attempt
from .renderer import Renderer
