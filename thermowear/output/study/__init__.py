"""Results of a study: tables of quantiles, indices, swings and bands, pictures, and report."""

from .console import print_study
from .folder import StudyFolder, is_study
from .pictures import draw_study
from .report import write_study_report
from .tables import bands_file, write_bands, write_quantiles, write_sobol, write_tornado
