"""Which bores, and outer circles of ring gears, a plane gear can be solved with; asked before anything is meshed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from fegear.geometry.involute_side import InvoluteSide

#: Bores that can be solved [root radius]. Nearer the centre the whole gear turns about its bore so freely, with the
#: inverse square of the radius, that the difference between teeth is lost at the start of a flank; a thinner rim
#: [modules] takes elements without number.
_SMALLEST_BORE, _THINNEST_RIM = 5e-4, 5e-3
#: Outer radius of the thickest ring over its root radius: beyond, nothing changes but the number of elements.
_LARGEST_RING = 10.0


def check_bore(tooth: InvoluteSide, bore_radius: float, module: float | None = None) -> None:
    """Refuse bores so near the centre or the outline that elements cannot resolve what is left.

    Parameters
    ----------
    tooth : InvoluteSide
    bore_radius : float
        [modules].
    module : float, optional
        [m]; if given, the refusal is in millimetres.

    Raises
    ------
    RangeError
    """
    root = tooth.root_radius
    unit, name = (1.0, "modules") if module is None else (1e3 * module, "mm")
    if tooth.internal:
        _check_rim(root, bore_radius, unit, name)
        return
    lowest, highest = _SMALLEST_BORE * root, root - _THINNEST_RIM
    if lowest <= bore_radius <= highest:
        return
    near = "the centre" if bore_radius < lowest else f"the root circle of radius {root * unit:.6g} {name}"
    # rounded inward, so that what is reported is accepted
    step = 10.0 ** (math.floor(math.log10(highest * unit)) - 5)
    raise RangeError(
        "bore_radius",
        f"{bore_radius * unit:.9g} {name}",
        f"is too close to {near} for the FE mesh",
        f"choose between {1.001 * lowest * unit:.4g} and {math.floor(highest * unit / step) * step:.6g} {name} "
        "(radius at which the gear body is fixed to shaft or hub), or remove bore_radius (default: half the "
        "root radius)",
    )


def _check_rim(root: float, outer: float, unit: float, name: str) -> None:
    """Refuse the outer circle of a ring gear that is no rim's."""
    lowest, highest = root + _THINNEST_RIM, _LARGEST_RING * root
    if lowest <= outer <= highest:
        return
    rule = "is too close to" if outer < lowest else "is too far outside"
    # rounded inward, so that what is reported is accepted
    step = 10.0 ** (math.floor(math.log10(highest * unit)) - 5)
    raise RangeError(
        "outer_radius",
        f"{outer * unit:.9g} {name}",
        f"{rule} the root circle of radius {root * unit:.6g} {name} for the FE mesh",
        f"choose between {math.ceil(lowest * unit / step) * step:.6g} and "
        f"{math.floor(highest * unit / step) * step:.6g} {name} (radius at which the ring is fixed)",
    )
