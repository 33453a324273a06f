"""The hot loop of motion: Taylor series of a train with periodic one-sided springs, event by event (numba).

Between changes of contact and break points of the periodic functions the accelerations are linear in the state with
coefficients that are analytic in time, so the Taylor coefficients of the motion follow from a recurrence, to any order
and without function evaluations; the step is as long as the tolerance allows, and the polynomial is the dense output
in which changes of contact and largest forces are found. Tangents (for the monodromy matrix) ride along as columns.

Where the vibration after an impact has died away and the motion only follows the slowly turning teeth, one step of
implicit collocation (Radau IIA) takes the place of thousands of Taylor steps: the time at low speed is that of
settling, not that of a turn.

The functions are plain Python on arrays; `compiled` turns them into machine code at first use. Numba keeps machine code
by the age of the caller's own file: each is therefore kept together with a digest of every file of this package.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from fegear.base.errors import MissingLibraryError
from fegear.base.extras import install
from fegear.dynamics.motion.kernel import collocation, integration, polynomials, series
from fegear.dynamics.motion.kernel.arrays import (
    DONE,
    TOO_MANY_STEPS,
    Collocation,
    MeshArrays,
    Rule,
    SpringArrays,
    TrainArrays,
    Travelled,
)

__all__ = [
    "DONE", "TOO_MANY_STEPS", "Collocation", "MeshArrays", "Rule", "SpringArrays", "TrainArrays", "Travelled",
    "compiled",
]  # fmt: skip

_LONG = "Compiling the equations of motion: about half a minute, once (done in advance by the set-up)."
#: Modules whose functions call each other as machine code.
COMPILED = (polynomials, series, collocation, integration)


def source_digest(folder: Path = Path(__file__).parent) -> str:
    """Digest of every file from which the machine code is made."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in sorted(folder.glob("*.py")))).hexdigest()


@cache
def compiled() -> Callable[..., Any]:
    """`integration.travel` as machine code, compiled at first use and kept on disk for the next process.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    try:
        from fegear.contact.machine_code import machine_code
    except ImportError:
        raise MissingLibraryError(f"{install('motion')}.") from None
    digest = source_digest()
    made: dict[object, Callable[..., Any]] = {
        function: machine_code(function, digest, _LONG if function is integration.travel else "")
        for module in COMPILED
        for _, function in inspect.getmembers(module, inspect.isfunction)
        if function.__module__ == module.__name__
    }
    travel = made[integration.travel]
    # Each is called through the names by which modules imported it.
    for module in COMPILED:
        functions = inspect.getmembers(module, inspect.isfunction)
        vars(module).update({name: made[one] for name, one in functions if one in made})
    return travel
