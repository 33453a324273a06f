"""Figure of root stress over the face: largest tension up the fillet over face position and way of the tooth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Figure, HeatMap, Panel

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.contact.flank.root_stress import StressOverFace
    from fegear.fem.influence import Side
    from fegear.geometry.pair import Member

#: Points of the map over the way of the tooth and along the face.
_ACROSS, _ALONG = 181, 81


def root_stress_map(
    name: str, load: float, over_face: Mapping[Member, Mapping[Side, StressOverFace]], gears: Mapping[Member, str]
) -> Figure:
    """Draw both gears with one scale of colours."""
    maps = {member: over["tension"] for member, over in over_face.items()}
    top = max(float(one.value.max()) for one in maps.values()) * 1e-6
    panels = []
    for member, one in maps.items():
        # Roll positions stand unevenly; straight between them.
        x, z = np.linspace(one.x[0], one.x[-1], _ACROSS), np.linspace(one.z[0], one.z[-1], _ALONG)
        way = np.stack([np.interp(x, one.x, along) for along in one.value.T]) * 1e-6
        value = np.stack([np.interp(z, one.z, along) for along in way.T], axis=1)
        panels.append(
            Panel(
                Axis("position of the tooth's contact on the line of action", "mm"), Axis("face position z", "mm"),
                (HeatMap(x * 1e3, z * 1e3, value, "largest root tension", "MPa", limits=(0.0, top)),),
                title=f"{member} {gears[member]}: {one.value.max() * 1e-6:.4g} MPa",
            )
        )  # fmt: skip
    return Figure(
        f"root_stress_over_face_{name}",
        f"Root stress over the face of pair {name}",
        f"Pair {name}: largest tension up the fillet of a tooth of either gear along its face, on its way through the "
        "mesh; the position is that of its contact line in the middle of the face.",
        tuple(panels),
        under=f"{load:.5g} N",
    )
