"""Special cases against closed forms: steady principle on rigid faces, without finite elements.

Each case is solved by the generic method on points of its geometry (`patches`); closed forms are
references only. Tabulated numbers must agree to the last digit.
"""

from __future__ import annotations

from ..check import Checks, identified
from .flat import case_1, case_2, case_6
from .guided import case_3, case_4, case_5, case_7
from .turning import case_8, case_9

_CASES = (case_1, case_2, case_3, case_4, case_5, case_6, case_7, case_8, case_9)
CLOSED_FORMS: dict[str, Checks] = {
    f"case-{number}": identified(f"case-{number}", checks)
    for number, checks in enumerate(_CASES, start=1)
}
"""Checks by id of the special case."""
