"""The two ways a run can fail, and the exit codes that go with them."""


class CaseError(Exception):
    """What the user wrote cannot be run (exit code 1).

    Parameters
    ----------
    faults : list of str
        One line per fault, each starting with the key's path.
    """

    exit_code = 1

    def __init__(self, *faults: str):
        self.faults = list(faults)
        super().__init__("\n".join(faults))


class ComputationError(Exception):
    """The computation did not reach an answer (exit code 2)."""

    exit_code = 2


class UnwritableError(ComputationError):
    """Results cannot be written any more: a disk is full, or gone."""


class CaseNote(UserWarning):
    """What is legal in a case, and still odd enough to be said; the command line prints it."""
