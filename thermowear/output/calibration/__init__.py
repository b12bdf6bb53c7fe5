"""Results of a calibration: record, tables, pictures and report."""

from .folder import CalibrationFolder, StoredRun, is_calibration
from .page import write_calibration_report
from .pictures import draw_calibration
