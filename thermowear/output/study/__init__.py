"""Results of a study: tables of quantiles, indices, swings and bands, pictures, and report."""

from .folder import (
    StudyFolder,
    bands_file,
    is_study,
    write_bands,
    write_quantiles,
    write_sobol,
    write_tornado,
)
from .pictures import draw_study
from .report import print_study, write_study_report
