"""Teeth that are cut into a shaft of the case: known without the mechanics of shafts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.case.reading import Scene

#: Diameters that differ by less than this share are one.
SAME = 1e-3
#: Least length of a piece of a section, over the shaft's.
PIECE = 1e-9


def cut_into(scene: Scene, gear: str) -> float | None:
    """Radius of the hole below teeth that are cut into a shaft of the case [m]; None of other gears.

    They are where the shaft is thicker than the gear's bore, as for `stiffened`; a body with rim and web never is.
    """
    made = scene.gears[gear]
    if made.tooth.internal or made.body is not None:
        return None
    for part in scene.case.shaft.values():
        for place in part.gears:
            if place.gear == gear:
                bare, half = part.build(), 0.5 * made.face_width
                low, high = (min(max(place.at + end, 0.0), bare.length) for end in (-half, half))
                if not high - low > PIECE * bare.length:
                    return None
                outer, inner = bare.diameters(np.linspace(low, high, 17)[1:-1])
                thicker = outer.max() > 2.0 * made.bore_radius * (1.0 + SAME)
                return 0.5 * float(inner.max()) if thicker else None
    return None
