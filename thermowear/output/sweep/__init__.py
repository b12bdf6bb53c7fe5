"""Results of a parameter sweep: folders of the variants, one table, two pictures."""

from .folder import SweepFolder, is_sweep
from .layout import swept
from .pictures import draw_sweep
