"""Command ``verify``."""

from __future__ import annotations

import json
import sys
import warnings

from ..errors import CaseError, ComputationError, RunNote


def verify(chosen) -> int:
    """Compare the program with reference solutions."""
    from ..output.console import print_checks
    from ..output.progress import Terminal
    from ..verification import CASES, SLOW, all_checks

    unknown = [name for name in chosen.ids if name not in CASES]
    if unknown:
        raise CaseError(f"verify {unknown[0]}: unknown case; one of: {', '.join(CASES)}")
    left_out = [] if chosen.ids or chosen.slow else [name for name in CASES if name in SLOW]
    names = chosen.ids or [name for name in CASES if name not in left_out]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RunNote)  # checks show what notes would warn of
        checks = [check for name in names for check in all_checks(name, CASES[name])]
    if chosen.json:
        print(json.dumps([check.as_row() for check in checks], indent=2, ensure_ascii=False))
    else:
        print_checks(Terminal(), checks)
    if left_out:
        print(
            f"note: slow cases not computed: {', '.join(left_out)} (use --slow or their names)",
            file=sys.stderr,
        )
    return 0 if all(check.passed for check in checks) else ComputationError.exit_code
