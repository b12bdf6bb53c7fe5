"""``python3 -m thermowear`` and the console script."""

import os
import sys


def run() -> int:
    """Run the command line with one thread unless ``OMP_NUM_THREADS`` is set.

    Most matrices are small, and the synchronisation of threads costs far more than it saves on a
    busy machine (16 s instead of 3 s, measured). Parallel runs use processes: `mpirun`.
    """
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # before a BLAS is loaded
    try:
        from .app.cli import main
        from .interrupts import deliver_again

        deliver_again()
        return main()
    except KeyboardInterrupt:  # during imports, before the command line has started
        print("error: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    if not sys.flags.safe_path:  # the current folder may be untrusted: search it after libraries
        sys.path.append(sys.path.pop(0))
    sys.exit(run())
