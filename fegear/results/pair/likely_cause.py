"""What a measured strain that differs from the computed one is likely to come from, by what each cause would take.

A grid elsewhere and a wrong torque are compared by how many times their tolerance either has to be: of a gauge that is
6 % low, 0.15 mm where the grid is known to 0.1 mm are likelier than a torque that is 6 % off and known to 1 %.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures, percent

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Times the placement tolerance up to which the change with the place goes on as at its ends.
_BEYOND = 2.5
#: Relative difference from the ratio of a half bridge over both fillets within which that is named, by the number of
#: arms that it was divided by: of two the ratio is near one, where a grid or a torque may be the reason as well.
_OF_BRIDGE = {2.0: 0.02, 1.0: 0.05}
#: Measured below computed strain by less than this may be resistance of leads.
_LEADS = 0.1


def place_of_gain(displacement: Array, gains: Array, gain: float, beyond: float = 1.0) -> float | None:
    """The smallest displacement of a grid that would give a ratio of measured to computed strain [m]; None for none.

    Parameters
    ----------
    displacement, gains : ndarray, shape (G,)
        Ascending, zero with the gain one among them.
    gain : float
    beyond : float
        Times the largest displacement up to which the line through the last two goes on.
    """
    if gains.size < 2:
        return None
    place, ratio = displacement, gains
    for end, beside in ((0, 1), (-1, -2)):
        if beyond > 1.0 and (last := displacement[end]):  # where the fillet ends there is no place
            slope = (gains[end] - gains[beside]) / (last - displacement[beside])
            before = 0 if end == 0 else place.size
            place = np.insert(place, before, beyond * last)
            ratio = np.insert(ratio, before, gains[end] + slope * (beyond - 1.0) * last)
    off = ratio - gain
    at = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
    if not at.size:
        return None
    step = off[at + 1] - off[at]
    share = np.where(step == 0.0, 0.0, -off[at] / np.where(step == 0.0, 1.0, step))
    found = place[at] + share * (place[at + 1] - place[at])
    return float(found[np.abs(found).argmin()])


def likely_causes(
    off: float,
    load_tolerance: float,
    displacement: Array,
    gains: Array,
    fillet_ratio: float = 0.0,
    *,
    leads: bool = True,
) -> str:
    """Causes of a difference beyond the limit, the likeliest first, a clause after others.

    Parameters
    ----------
    off : float
        Measured less computed strain, relative.
    load_tolerance : float
        Of load and gauge factor, relative.
    displacement, gains : ndarray, shape (G,)
        Of grids within the placement tolerance [m], and measured / computed strain that each would give.
    fillet_ratio : float
        Strain of an equal gauge in the other fillet over that of the gauge, in size; zero where it is not known.
    leads : bool
        Whether it may be a quarter bridge, whose leads count.
    """
    by_load = f"a torque, gauge factor or bridge supply {percent(abs(off))} {'higher' if off >= 0.0 else 'lower'}"
    if leads and -_LEADS < off < 0.0:
        by_load += " (or leads of a quarter bridge with two wires)"
    load = abs(off) / load_tolerance if load_tolerance else np.inf
    ways = [(load, f"{by_load}{_times(load, 'load_tolerance')}")]
    tolerance = float(np.abs(displacement).max())
    place = place_of_gain(displacement, gains, 1.0 + off, _BEYOND)
    if place is not None and tolerance:
        times = abs(place) / tolerance
        nearer = "tip" if place > 0.0 else "root"
        grid = f"a grid {abs(place) * 1e3:.2g} mm nearer to the {nearer}{_times(times, 'placement_tolerance')}"
        ways.append((times, grid))
    bridge = _of_bridge(1.0 + off, fillet_ratio)
    said = [bridge] if bridge else []
    said += [way for _, way in sorted(ways)]
    nowhere = ""
    if tolerance and place is None:
        nowhere = f"; no grid within {_BEYOND * tolerance * 1e3:.2g} mm would explain it"
    return f"; likeliest cause: {', then '.join(said)}{nowhere}"


def _times(count: float, key: str) -> str:
    return "" if not 0.0 < count < np.inf else f" ({figures(count, 2)} times {key})"


def _of_bridge(ratio: float, fillet_ratio: float) -> str:
    """A half bridge over both fillets of a tooth that was taken for another one; empty where it has another ratio."""
    if not fillet_ratio:
        return ""
    for arms, said in ((2.0, "two equal and opposite strains"), (1.0, "a quarter bridge")):
        if abs(ratio / ((1.0 + fillet_ratio) / arms) - 1.0) <= _OF_BRIDGE[arms]:
            return f"a half bridge with the other fillet, evaluated as {said} (set bridge)"
    return ""
