"""Where the program starts, as ``fegear`` and as ``python -m fegear``: light, so that Ctrl-C has its answer at once."""

import sys


def main() -> None:
    """Load the command line and run it; an interrupt while it is still loading is reported like any other."""
    try:
        from fegear.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.stderr.write("fegear: interrupted; results of earlier runs are as they were.\n")
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
