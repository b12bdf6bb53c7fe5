"""Commands on a results folder: pictures, animations, reports."""

from __future__ import annotations

import sys

from ..errors import CaseError


def plot(chosen) -> int:
    """Draw the pictures of a results folder again."""
    from ..output.calibration import draw_calibration, is_calibration
    from ..output.pictures import make_pictures
    from ..output.study import draw_study, is_study
    from ..output.sweep import draw_sweep, is_sweep

    kinds = {is_sweep: draw_sweep, is_calibration: draw_calibration, is_study: draw_study}
    try:
        draw = next((draw for is_it, draw in kinds.items() if is_it(chosen.folder)), make_pictures)
        problems = draw(chosen.folder)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    for problem in problems:
        print(f"note: {problem}", file=sys.stderr)
    return 0


def animate(chosen) -> int:
    """Write an animation of a results folder."""
    from ..output.pictures import make_animation

    path = chosen.output or chosen.folder / "animation.gif"
    try:
        make_animation(chosen.folder, path, chosen.fps)
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    print(f"wrote {path}")
    return 0


def report(chosen) -> int:
    """Write the report of a results folder."""
    from ..output.calibration import is_calibration, write_calibration_report
    from ..output.report import write_report
    from ..output.study import is_study, write_study_report

    kinds = {is_calibration: write_calibration_report, is_study: write_study_report}
    write = next((write for is_it, write in kinds.items() if is_it(chosen.folder)), write_report)
    print(f"wrote {write(chosen.folder)}")
    return 0
