"""Where the program starts, as ``fegear`` and as ``python -m fegear``: light, so that Ctrl-C has its answer at once."""

import contextlib
import gc
import os

#: So many new objects are made before Python looks for cycles among them (its default is 700). What a command loads, up
#: to 120,000, and computes stays until it ends: looking through it two hundred times, and at the end, took a tenth of a
#: short run; once, when all is loaded, took a seventh of a plan.
_YOUNG = 200_000


def main() -> None:
    """Load the command line and run it; an interrupt while it is still loading is reported like any other."""
    _main(is_process=False)


def program() -> None:
    """The same as the program that this process is for, and ends with."""
    _main(is_process=True)


def _main(*, is_process: bool) -> None:
    gc.set_threshold(_YOUNG)
    # pydantic would look through every installed package for plugins, which fegear has no use for.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        from fegear.base.ending import leaving_with
        from fegear.base.interrupts import heed_ctrl_c
        from fegear.base.streams import open_streams

        heed_ctrl_c()
        open_streams()
        with leaving_with() if is_process else contextlib.nullcontext():
            from fegear.cli import main as run

            run()
    except KeyboardInterrupt:
        from fegear.base.streams import complain

        complain("fegear: interrupted; results of earlier runs are unchanged.")
        raise SystemExit(130) from None
    finally:
        gc.freeze()  # the process ends: its memory goes back without another search for cycles


if __name__ == "__main__":
    program()
