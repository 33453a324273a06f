"""How deep a relief a tooth can take, and what to change where a design asks for more."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.printed import figures
from fegear.geometry.plausible_flanks import DEEPEST_RELIEF, deepest_relief

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array
    from fegear.design.excitation_relief import MinimumExcitationRelief


def refuse_deeper_than_the_tooth(*reliefs: MinimumExcitationRelief) -> None:
    """Refuse designs that remove more than the tooth has to give, and name what would do.

    Parameters
    ----------
    reliefs : MinimumExcitationRelief
        Of one design: same loading and load.

    Raises
    ------
    RangeError
        With the shortest design zone, or else the largest load, that stays within the tooth.
    """
    worst = max(reliefs, key=_depth)
    depth = _depth(worst)
    if depth <= 1.0:
        return
    loading, pair = worst.loading, worst.compliance.pair
    ratio, middle = loading.length / loading.base_pitch, 0.5 * (pair.x_start + pair.x_end)
    rule = (
        f"requires a relief of {_most(worst) * 1e6:.4g} um on the {worst.member}, {depth:.3g} times the maximum of "
        f"{DEEPEST_RELIEF:g} module (at most half the tooth thickness)"
    )
    room = 2.0 * min(loading.centre - pair.x_start, pair.x_end - loading.centre)
    longest = max(loading.length, room)

    def fits(length: float, centre: float, load: float) -> bool:
        n = max(math.floor(length / loading.base_pitch * (1.0 + 1e-12)), 1)
        kept = loading.peak if n == loading.order else math.nan
        tried = replace(loading, length=length, centre=centre, peak=kept)
        return all(_depth(replace(r, loading=tried, load=load)) <= 1.0 for r in reliefs)

    if fits(longest, loading.centre, worst.load):
        pitch = loading.base_pitch
        least = _least(lambda a: fits(a * pitch, loading.centre, worst.load), ratio, longest / pitch)
        raise RangeError(
            "design.contact_ratio", f"{ratio:.6g}", rule,
            f"choose at least {least:.4g} (design.length {least * pitch * 1e3:.5g} mm)",
        )  # fmt: skip
    if fits(pair.path_length, middle, worst.load):
        raise RangeError(
            "design.centre", f"{loading.centre * 1e3:.6g} mm", rule,
            f"choose the middle of the path, {middle * 1e3:.6g} mm, and a design length up to "
            f"{pair.path_length * 1e3:.6g} mm",
        )  # fmt: skip
    load, lever = worst.load, pair.driver.base_radius
    while load > 1e-9 * worst.load and not fits(pair.path_length, middle, load):
        load *= 0.9
    raise RangeError(
        "design.load", f"{worst.load:.6g} N ({figures(worst.load * lever, 4)} N m on the driver)", rule,
        f"reduce the load: with the full path of contact as design length the limit is {figures(load)} N "
        f"({figures(load * lever)} N m on the driver, {figures(load / worst.compliance.face_width * 1e-3)} N/mm)",
    )  # fmt: skip


def _places(relief: MinimumExcitationRelief) -> Array:
    pair = relief.compliance.pair
    return np.linspace(pair.x_start, pair.x_end, 241)


def _depth(relief: MinimumExcitationRelief) -> float:
    """Largest removal over what the tooth can take; infinite where the removal is no number."""
    pair, x = relief.compliance.pair, _places(relief)
    share = relief.at(x) / deepest_relief(pair.gear(relief.member), pair.roll_angle(x, relief.member))
    return float(share.max()) if np.isfinite(share).all() else math.inf


def _most(relief: MinimumExcitationRelief) -> float:
    return float(relief.at(_places(relief)).max())


def _least(fits: Callable[[float], bool], low: float, high: float) -> float:
    """Smallest contact ratio above `low` that fits, in thousandths; `high` fits."""
    thousandths = range(math.floor(low * 1e3) + 1, math.ceil(high * 1e3))
    first, last = 0, len(thousandths)
    while first < last:
        tried = (first + last) // 2
        if fits(thousandths[tried] * 1e-3):
            last = tried
        else:
            first = tried + 1
    return thousandths[first] * 1e-3 if first < len(thousandths) else high
