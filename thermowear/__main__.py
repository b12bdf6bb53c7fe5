"""``python3 -m thermowear`` and the console script."""

import os
import sys


def run() -> int:
    """Run the command line, with one thread unless the user says otherwise.

    Most matrices are small, and threads that wait for one another cost far more than they save
    where anything else runs (3 s become 16 s, measured). Processes do the work: `mpirun`.
    """
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # before a BLAS is loaded
    try:
        from .app.cli import main
        from .interrupts import deliver_again

        deliver_again()
        return main()
    except KeyboardInterrupt:  # while importing: the command line itself has not begun
        print("error: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    if not sys.flags.safe_path:  # the current folder, which may be anybody's: after all libraries
        sys.path.append(sys.path.pop(0))
    sys.exit(run())
