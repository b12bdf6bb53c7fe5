"""Translation of a case file into a model and the settings of its analysis."""

from .analysis import analysis_of, model_of, run
