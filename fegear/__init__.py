"""fegear: a finite-element workbench for gear teeth.

What a script needs stands at the top: `run` computes a case; `Gear`, `Pair` and the questions about them do without
one. They are loaded when they are first used. Below them lie the packages of the mechanics, in SI throughout.
"""

from __future__ import annotations

#: Type checkers take it for true; importing typing would cost more than the rest of ``import fegear``.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from fegear.base.errors import FegearError, InputError
    from fegear.workbench.any_result import compute, crosscheck
    from fegear.workbench.fillet import fillet_design
    from fegear.workbench.gear import Gear
    from fegear.workbench.measured import gauge, measured_transmission_error
    from fegear.workbench.moving import dynamic_factor, vibration_revolution
    from fegear.workbench.pair import Pair
    from fegear.workbench.questions import (
        flank_design,
        load_sharing,
        mesh_stiffness_revolution,
        relief,
        root_stress,
        stiffness_table,
        transmission_error,
    )
    from fegear.workbench.rack import Rack
    from fegear.workbench.rating import rating
    from fegear.workbench.results import Results
    from fegear.workbench.run import run

__version__ = "0.2.0"

__all__ = [
    "FegearError", "Gear", "InputError", "Pair", "Rack", "Results", "__version__", "compute", "crosscheck",
    "dynamic_factor", "fillet_design", "flank_design", "gauge", "load_sharing", "measured_transmission_error",
    "mesh_stiffness_revolution", "rating", "relief", "root_stress", "run", "stiffness_table", "transmission_error",
    "vibration_revolution",
]  # fmt: skip

#: Modules of the names above, besides the version.
_HOMES = {
    "FegearError": "base.errors",
    "Gear": "workbench.gear",
    "InputError": "base.errors",
    "Pair": "workbench.pair",
    "Rack": "workbench.rack",
    "Results": "workbench.results",
    "compute": "workbench.any_result",
    "crosscheck": "workbench.any_result",
    "dynamic_factor": "workbench.moving",
    "fillet_design": "workbench.fillet",
    "flank_design": "workbench.questions",
    "gauge": "workbench.measured",
    "load_sharing": "workbench.questions",
    "measured_transmission_error": "workbench.measured",
    "mesh_stiffness_revolution": "workbench.questions",
    "rating": "workbench.rating",
    "relief": "workbench.questions",
    "root_stress": "workbench.questions",
    "run": "workbench.run",
    "stiffness_table": "workbench.questions",
    "transmission_error": "workbench.questions",
    "vibration_revolution": "workbench.moving",
}

#: Old names of the top: the name of now, and the release since which it is that. An old name works, and warns, for at
#: least one minor release (docs/stability.md).
_RENAMED: dict[str, tuple[str, str]] = {}


if not TYPE_CHECKING:  # type checkers know the names from their imports, and find a wrong one

    def __getattr__(name: str) -> Any:
        """Load a name of the top at its first use."""
        import importlib

        if name in _RENAMED:
            import warnings

            new, since = _RENAMED[name]
            warnings.warn(f"fegear.{name} was renamed fegear.{new} in {since}", DeprecationWarning, stacklevel=2)
            return __getattr__(new)
        if name not in _HOMES:
            raise AttributeError(f"module 'fegear' has no attribute {name!r}; it has {', '.join(sorted(_HOMES))}")
        found = getattr(importlib.import_module(f"fegear.{_HOMES[name]}"), name)
        globals()[name] = found
        return found


def __dir__() -> list[str]:
    return sorted(__all__)
