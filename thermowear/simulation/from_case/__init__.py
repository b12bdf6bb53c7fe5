"""Translation of a case file into a model and the settings of its analysis."""

from .accurate_mesh import with_accurate_mesh
from .analysis import analysis_of, model_of
from .run import run
