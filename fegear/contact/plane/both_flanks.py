"""Root stress of a tooth over a turn of its gear at one place of its fillet, also of teeth loaded on both flanks.

A tooth between two mates, as a planet's between sun and ring, is bent to either side: the fillet below the flank that
one mate loads is pulled there, and pressed while the other mate loads the other flank. Both stand at one place.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np
from scipy.interpolate import CubicSpline

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.root_stress_history import superposed_stress
from fegear.contact.plane.tooth_stress import with_peaks
from fegear.fem.plane.influence import Side
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.fem.plane.root_stress import FilletCurve

#: Roll positions over the base pitch, and places along a fillet at which its extremes are looked for.
_POSITIONS, _PLACES = 200, 201
_FILLETS: tuple[Side, Side] = ("tension", "compression")


@dataclass(frozen=True)
class FilletTrace:
    """Stress along both fillets of one tooth while it passes one mesh.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Position of the tooth's contact [m], from a base pitch before the path to one after it.
    arc : mapping of side to ndarray
        Places along each fillet from the root land [modules].
    stress : mapping of side to ndarray, shape (P, points)
        Of the fillet below the loaded flank, and of the other one [Pa].
    length : float
        Of a fillet [modules].
    """

    x: Array
    arc: dict[Side, Array]
    stress: dict[Side, Array]
    length: float

    def at(self, side: Side, places: Array) -> Array:
        """Stress at places along a fillet [modules from the root land], shape (P, places) [Pa]."""
        return np.asarray(CubicSpline(self.arc[side], self.stress[side], axis=1)(places))


def fillet_trace(engagement: Engagement, member: Member, load: float) -> FilletTrace:
    """Follow one tooth of a gear through a mesh.

    Raises
    ------
    InputError
        If root stress is not known by finite elements.
    """
    engagement.compliance.refuse_unequal("bending to both sides")
    source = engagement.compliance.source(member)
    curves = {side: cast("FilletCurve | None", source.fillet_curve(0, side)) for side in _FILLETS}  # none is cut
    if any(curve is None for curve in curves.values()):
        raise InputError(
            "compliance.source", "a formula", "gives no stress along the fillet, which alternating bending requires",
            'set compliance = { source = "fe" }',
        )  # fmt: skip
    at = with_peaks(engagement, load, roll_positions(engagement, _POSITIONS), {member: (source,)})
    state = engagement.solve(engagement.grid(at), [load])
    pair, contacts = engagement.pair, state.grid.contacts
    teeth = np.arange(-1, contacts.x.shape[0] + 1)
    x = (contacts.x[0] + teeth[:, None] * pair.base_pitch).ravel()
    order = np.argsort(x)
    order = order[(x[order] > pair.x_start - pair.base_pitch) & (x[order] < pair.x_end + pair.base_pitch)]
    stress = {
        side: np.concatenate([one[:, 0] for one in superposed_stress(engagement, state, member, side, 1)])[order]
        for side in _FILLETS
    }
    arc = {side: np.asarray(curve.arc) for side, curve in curves.items() if curve is not None}
    length = min(float(curve.length) for curve in curves.values() if curve is not None)
    return FilletTrace(x[order], arc, stress, length)


@dataclass(frozen=True)
class AlternatingStress:
    """Stress at the most pulled place of a fillet over a turn of its gear.

    Parameters
    ----------
    place : float
        Along the fillet from the root land [modules].
    highest, lowest : float
        [Pa]
    highest_error, lowest_error : float
        Estimated [Pa]; NaN where nothing tells them.
    """

    place: float = shown(
        "", "arc length of the point of maximum tensile stress on the fillet, from the root land, in modules"
    )
    highest: float = shown("MPa", "maximum stress at this point over one revolution", name="stress_highest")
    lowest: float = shown("MPa", "minimum stress at this point over one revolution", name="stress_lowest")
    highest_error: float = shown(
        "MPa", "estimated error of stress_highest", name="stress_highest_error", default=math.nan
    )
    lowest_error: float = shown("MPa", "estimated error of stress_lowest", name="stress_lowest_error", default=math.nan)

    @property
    @shows("MPa", "stress range (maximum - minimum)", name="stress_range")
    def range(self) -> float:
        """[Pa]."""
        return self.highest - self.lowest

    @property
    @shows("MPa", "mean stress", name="stress_mean")
    def mean(self) -> float:
        """[Pa]."""
        return 0.5 * (self.highest + self.lowest)

    @property
    @shows("", "stress ratio R (minimum / maximum) for Y_M", name="stress_ratio")
    def ratio(self) -> float:
        """R."""
        return self.lowest / self.highest

    @property
    @shows("MPa", "estimated error of stress_range", name="stress_range_error")
    def range_error(self) -> float:
        """[Pa]."""
        return self.highest_error + self.lowest_error

    @property
    @shows("MPa", "estimated error of stress_mean", name="stress_mean_error")
    def mean_error(self) -> float:
        """[Pa]."""
        return 0.5 * self.range_error

    @property
    @shows("", "estimated error of stress_ratio", name="stress_ratio_error")
    def ratio_error(self) -> float:
        """Of R."""
        return (self.lowest_error + abs(self.ratio) * self.highest_error) / self.highest


def alternating_stress(pulled: FilletTrace, pressed: FilletTrace | None) -> tuple[AlternatingStress, Array, Array]:
    """Stress at the most pulled place of a fillet, over the mesh that pulls it and over that which presses it.

    Parameters
    ----------
    pulled : FilletTrace
        Of the mesh that loads the flank above the fillet.
    pressed : FilletTrace or None
        Of the mesh that loads the other flank; None for teeth that have one mate.

    Returns
    -------
    found : AlternatingStress
    pull, press : ndarray, shape (P,) and (P',)
        Stress at its place along x of both traces [Pa]; the second is empty for teeth that have one mate.
    """
    places = np.linspace(0.0, pulled.length, _PLACES)
    stress = pulled.at("tension", places)
    most = stress.max(axis=0)
    top = int(np.argmax(most))
    # the largest place between those looked at: a parabola through it and its neighbours
    here = slice(max(top - 1, 0), top + 2)
    place = _vertex(places[here], most[here])
    at = np.array([place])
    pull = pulled.at("tension", at)[:, 0]
    press = np.zeros(0) if pressed is None else pressed.at("compression", at)[:, 0]
    lowest = min(0.0, float(pull.min()), float(press.min(initial=0.0)))
    highest = max(float(pull.max()), float(press.max(initial=-math.inf)))
    return AlternatingStress(place, highest, lowest), pull, press


def with_errors(
    found: AlternatingStress, pull: ToothStress, press: ToothStress, loads: tuple[int, int]
) -> AlternatingStress:
    """The same with its errors: those of each mesh's largest stress, and of the place.

    Parameters
    ----------
    found : AlternatingStress
    pull, press : ToothStress
        Of the meshes that pull and press the fillet.
    loads : (int, int)
        Numbers of the load of either.
    """
    i, j = loads
    most, least = pull.largest_tension[i], press.largest_compression
    missed = abs(found.highest / most - 1.0)
    shares = [
        math.nan if error is None or size is None else abs(error / size) + missed
        for error, size in ((pull.error(i), most), (press.compression_off(j), None if least is None else least[j]))
    ]
    # nowhere is the stress lower than the most negative of all places
    under = 0.0 if least is None else max(float(least[j]) - found.lowest, 0.0)
    high, low = float(shares[0] * abs(found.highest)), float(shares[1] * abs(found.lowest)) + under
    return replace(found, highest_error=high, lowest_error=low)


def _vertex(at: Array, values: Array) -> float:
    if at.size < 3:
        return float(at[int(np.argmax(values))])
    low, middle, high = values
    bend = low - 2.0 * middle + high
    return float(at[1] + (0.5 * (low - high) / bend * (at[1] - at[0]) if bend < 0.0 else 0.0))
