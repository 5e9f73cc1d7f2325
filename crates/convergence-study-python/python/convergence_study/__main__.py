"""The program `convergence-study`; also `python -m convergence_study`, which starts its guards of processes."""

import signal
import sys

from ._native import run_program


def main():
    # The program handles Ctrl-C itself; Python would only note it for later.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(run_program(sys.executable, sys.argv[1:]))


if __name__ == "__main__":
    main()
