"""The closed-form compliance sources by the names that case files use."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from fegear.errors import InputError
from fegear.formulas import cornell_compliance, potential_energy, weber_banaschek

if TYPE_CHECKING:
    from fegear.formulas.compliance import ComplianceSource

SOURCES: dict[str, ComplianceSource] = {
    s.name: s for s in (cornell_compliance.SOURCE, weber_banaschek.SOURCE, potential_energy.SOURCE)
}


def source(name: str) -> ComplianceSource:
    """Return the compliance source called `name`; an unknown name is refused with the nearest known one."""
    if name not in SOURCES:
        near = difflib.get_close_matches(name, SOURCES, 1)
        raise InputError(
            "compliance.source",
            f'"{name}"',
            f"is not one of {', '.join(SOURCES)}",
            f'did you mean "{near[0]}"?' if near else "",
        )
    return SOURCES[name]
