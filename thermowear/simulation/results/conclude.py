"""Result of an analysis from its final state."""

from __future__ import annotations

from ...results import Interface, Result
from .final_state import FinalState
from .recording import profile
from .summary import summarise


def conclude(
    final: FinalState, interface: Interface, extra: dict, **recorded
) -> tuple[FinalState, Result]:
    """Final state and result of an analysis, with profile and summary. Every rank calls.

    Parameters
    ----------
    final : FinalState
    interface : Interface
        Interface at the end.
    extra : dict
        Entries that the analysis adds to the summary.
    **recorded
        Further attributes of the result, such as its histories.
    """
    history = recorded.get("history")
    summary = summarise(final, interface, history[-1].time if history else 0.0) | extra
    return final, Result(interface, profile(final.system, interface), summary, **recorded)
