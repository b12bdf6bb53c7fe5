"""``python3 -m thermowear`` and the console script."""

import os
import sys


def run() -> int:
    """Run the command line; on many ranks with one thread each, unless the user says otherwise."""
    if int(os.environ.get("OMPI_COMM_WORLD_SIZE", os.environ.get("PMI_SIZE", "1"))) > 1:
        os.environ.setdefault("OMP_NUM_THREADS", "1")  # before a BLAS is loaded
    from .cli import main

    return main()


if __name__ == "__main__":
    sys.exit(run())
