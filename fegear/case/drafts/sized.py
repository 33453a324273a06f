"""What a drafted gearbox comes to in a line for each stage and shaft, printed when its case is written."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator


def sized(text: str) -> Iterator[str]:
    """Stages with their sizes and shafts with their bearings; nothing of a case without shafts.

    Parameters
    ----------
    text : str
        Of the case.
    """
    case = tomllib.loads(text)
    for name, pair in case.get("pair", {}).items() if "shaft" in case else ():
        pinion, wheel = (case["gear"][pair[role]] for role in ("driver", "driven"))
        distance = f", centre distance {pair['centre_distance']}" if "centre_distance" in pair else ""
        yield (
            f"Stage {name}: teeth {pinion['teeth']}/{wheel['teeth']}, module {pinion['normal_module']}, "
            f"face width {pinion['face_width']}{distance}"
        )
    for name, shaft in case.get("shaft", {}).items():
        used = [case["bearing"][one["bearing"]] for one in shaft["bearings"]]
        bearings = ", ".join(one.get("designation", "assumed stiffness") for one in used)
        yield f"Shaft {name}: seats {shaft['sections'][0]['outer']}, bearings {bearings}"
