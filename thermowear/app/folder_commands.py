"""Commands on a results folder: pictures, animations, reports."""

from __future__ import annotations

import sys

from ..errors import CaseError


def plot(chosen) -> int:
    """Draw the pictures of a results folder again."""
    from ..output.calibration import draw_calibration, is_calibration
    from ..output.pictures import make_pictures
    from ..output.sweep import draw_sweep, is_sweep

    try:
        draw = draw_sweep if is_sweep(chosen.folder) else make_pictures
        draw = draw_calibration if is_calibration(chosen.folder) else draw
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

    write = write_calibration_report if is_calibration(chosen.folder) else write_report
    print(f"wrote {write(chosen.folder)}")
    return 0
