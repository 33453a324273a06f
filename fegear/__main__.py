"""Where the program starts, as ``fegear`` and as ``python -m fegear``: light, so that Ctrl-C has its answer at once."""

from fegear.streams import complain, open_streams


def main() -> None:
    """Load the command line and run it; an interrupt while it is still loading is reported like any other."""
    open_streams()
    try:
        from fegear.cli import main as run

        run()
    except KeyboardInterrupt:
        complain("fegear: interrupted; results of earlier runs are as they were.")
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
