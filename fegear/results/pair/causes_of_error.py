"""Causes of measured transmission errors: computed curves of other reliefs and torques beside all traces of a pair."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.contact.trace_causes import Causes, Traced, likeliest_causes

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.loaded_teeth import LoadedTeeth
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.plane.possible_flanks import Possible
    from fegear.contact.trace_causes import Cause
    from fegear.results.pair.measured_error_data import TraceBeside

#: Even roll positions over the base pitch; those of jumps would have to be evaluated anew for each start of a relief.
_POSITIONS = 256
_TURN = 2.0 * math.pi


def causes_of_error(traces: Sequence[TraceBeside], teeth: LoadedTeeth, fit: Collection[str]) -> Causes:
    """Which relief or torque explains the traces; none of pairs with a width, and where teeth differ.

    Parameters
    ----------
    traces : sequence of TraceBeside
        By load, ascending.
    teeth : LoadedTeeth
    fit : collection of str
        What was fitted.
    """
    if not hasattr(teeth, "engagement") or any(one.otherwise.counts_otherwise for one in traces):
        return Causes()
    from fegear.contact.plane.possible_flanks import possible_flanks

    e = cast("LoadedPair", teeth).engagement
    if e.uneven or e.pair.contact_ratio < 1.0:
        return Causes()
    phase = np.linspace(0.0, 1.0, _POSITIONS + 1)
    x = e.pair.x_start + e.pair.base_pitch * phase[:-1]
    angle = _TURN * (e.pair.x_start / e.pair.base_pitch + phase)

    def curves_of(possible: Possible, value: float) -> list[tuple[Array, Array]]:
        changed, factor = possible.made(value)
        found = changed.solve(changed.grid(x), [factor * one.load for one in traces]).transmission_error
        scale = value if possible.kind == "scale" else 1.0
        return [(angle, scale * np.append(found[:, i], found[0, i])) for i in range(len(traces))]

    shift = 0.5 * _TURN if "shift" in fit else 0.0
    traced = [
        Traced(
            one.found.teeth * one.found.angle, one.found.te, one.found.spread / math.sqrt(one.found.pitches),
            "offset" in fit, shift, one.tolerance, _TURN, one.load_tolerance,
        )
        for one in traces
    ]  # fmt: skip
    tolerance = max(one.load_tolerance for one in traces)

    def within(cause: Cause) -> bool:
        kind = cause.of.kind  # a size that nothing but the flanks explains is judged as such
        return kind == "scale" or (kind == "load" and abs(cause.value - 1.0) <= tolerance)

    return likeliest_causes(traced, possible_flanks(e, tolerance), curves_of, within)
