"""Translation of a case file into a model and the settings of its analysis."""

from .analysis import analysis_of, run
from .model import model_of
