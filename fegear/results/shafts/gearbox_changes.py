"""What to change in a gearbox: of every mesh, shaft and bearing its finding, and what would help."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.base.notes import Note
from fegear.base.printed import figures, percent
from fegear.base.shown import shown
from fegear.results.shafts.at_glance import BearingAtGlance, MeshAtGlance, Safety
from fegear.results.shafts.checked_shafts import STRAIGHTER, CheckedShaft
from fegear.shafts.designations import KNOWN, plain_designation
from fegear.shafts.gearbox import CAUSES
from fegear.shafts.larger_bearing import BearingChange, LargerBearing

#: What misaligns a mesh, and what makes it less.
REMEDIES = {
    "bearings": "stiffer or preloaded bearings",
    "housing": "stiffer bearing seats",
    "bending": "a thicker shaft, or bearings closer to the gear",
    "torsion": "a thicker shaft, or the torque led in from the other side",
}
CAUSE_WORDS = {"bearings": "bearing deflection", "housing": "deflection of the bearing seats",
               "bending": "bending of the shafts", "torsion": "torsion of the shafts"}  # fmt: skip
#: K_Hbeta that a corrected lead leaves, and the one from which a correction is worth its price.
_CORRECTED, _WORTH = 1.1, 1.25
#: Half-length of the middle of the face, over half its width, in which a largest load is one of crowning.
_MIDDLE = 0.4
#: Amounts of a lead below are zero [m].
_NONE = 1e-9
#: Dimensions that differ by less are one [m].
_SAME = 1e-6
#: Gain of K_Hbeta from which a lead correction is named, and what a part of the usual size more is worth.
WORTH_A_LEAD, _MORE = 1.02, 1.1


@dataclass(frozen=True)
class Change:
    """Something to change, with why and what it brings; urgent where it falls short or wastes load capacity.

    Parameters
    ----------
    verdict : str
        The part with its value and the required one, in as few words as there are, where it falls short.
    brief : str
        The remedy in as few words.
    beside : str
        The finding without the value that the verdict has; empty where the verdict has none of it.
    told : str
        The remedy without amounts that another result computes; empty where it has none.
    """

    margin: float
    part: str = shown("", "pair or bearing")
    finding: str = shown("", "what is found")
    remedy: str = shown("", "what would help")
    urgent: bool = True
    verdict: str = ""
    brief: str = ""
    beside: str = ""
    told: str = ""

    @property
    def fails(self) -> bool:
        """Whether a part falls short, other than load that could be more even."""
        return self.urgent and self.margin < 1.0


def shortest_life(one: BearingAtGlance, required_hours: float) -> Change:
    """The bearing with the least reserve of life, required in [s], and what lasts longer."""
    hours = one.duration / 3600.0
    longer = figures(hours * _MORE**one.exponent)
    remedy = f"{percent(_MORE - 1.0, whole=True)} more dynamic load rating C: {longer} h"
    if one.change is not None and one.change.fitting is not None:
        remedy = _changed_to(one, one.change.fitting)
    return Change(
        one.margin, f"bearing {one.bearing} of shaft {one.shaft}",
        f"life {figures(hours)} h, required {figures(required_hours / 3600.0)} h: minimum reserve of bearings",
        remedy, urgent=False, beside="minimum reserve of bearings",
    )  # fmt: skip


def change_of_life(one: BearingAtGlance, required_hours: float) -> Change | None:
    """A bearing whose life is below the required one [s]."""
    if not one.margin < 1.0:
        return None
    brief = remedy = f"a dynamic load rating C {_times(one.margin)} times as large"
    if one.change is not None:
        remedy = f"{_advised(one, one.change)}, or C {_times(one.margin)} times as large"
        if (fitting := one.change.fitting) is not None:
            brief = f"{fitting.said} instead of {one.designation}"
    life, required = figures(one.duration / 3600.0), figures(required_hours / 3600.0)
    return Change(
        one.margin, f"bearing {one.bearing} of shaft {one.shaft}", f"life {life} h of {required} h", remedy,
        verdict=f"bearing {one.bearing} life {life} h ({required} h required)", brief=brief,
    )  # fmt: skip


def _times(margin: float) -> str:
    """Over the present load rating, rounded up."""
    return figures(math.ceil(100.0 / margin - 1e-9) / 100.0)


def _advised(one: BearingAtGlance, change: BearingChange) -> str:
    """The bearing to change to, or that none fits, with what comes nearest and what would fit a thicker shaft."""
    if change.fitting is not None:
        return _changed_to(one, change.fitting)
    said = "no tabulated bearing that fits this seat lasts"
    if (best := change.longest) is not None:
        said += f" (longest life {_hours(one, best)} with {best.said}{_size(one, best)})"
    if (other := change.thicker) is not None:
        said += f"; on a thicker shaft {other.said}{_size(one, other)}: {_hours(one, other)}"
    return said


def _changed_to(one: BearingAtGlance, other: LargerBearing) -> str:
    """Another designation with its life at the present forces, and what of its size is not that of the present one."""
    return f"{other.said} instead of {one.designation}{_size(one, other)}: {_hours(one, other)} by its tabulated C"


def _hours(one: BearingAtGlance, other: LargerBearing) -> str:
    return f"{figures(one.duration / 3600.0 * other.revolutions / one.life)} h"


def _size(one: BearingAtGlance, other: LargerBearing) -> str:
    """Bore, outside diameter and width where they differ from the present ones, and a seat that is to be longer."""
    present = KNOWN[plain_designation(one.designation)]
    said = [
        f"{words} {figures(size * 1e3, 4)} mm"
        for words, size, own in (
            ("bore", other.bore, present.bore), ("outside diameter", other.outside_diameter, present.outside_diameter),
            ("width", other.width, present.width),
        )
        if abs(size - own) > _SAME
    ]  # fmt: skip
    if other.width > one.seat.length + _SAME:
        said.append(f"seat longer than {figures(one.seat.length * 1e3, 4)} mm")
    return f" ({', '.join(said)})" if said else ""


def change_of_shaft(one: CheckedShaft) -> Change | None:
    """A shaft that yields."""
    if not one.margin < 1.0:
        return None
    needed, diameter = figures(one.strength * 1e-6 / one.margin), f"a diameter of {figures(one.needed * 1e3)} mm"
    return Change(
        one.margin, f"shaft {one.shaft}", one.found, f"{diameter} there, or a yield strength of {needed} MPa",
        verdict=f"shaft {one.shaft} yielding S_yield {one.safety:.2f} ({figures(one.required)} required)",
        brief=diameter,
    )  # fmt: skip


def change_of_tilt(one: BearingAtGlance) -> Change | None:
    """A bearing that is tilted more than its kind permits."""
    if one.tilted is None or not one.tilted.margin < 1.0:
        return None
    return Change(
        one.tilted.margin, f"bearing {one.bearing} of shaft {one.shaft}", one.tilted.found, STRAIGHTER,
        verdict=f"bearing {one.bearing} {one.tilted.found}", brief=STRAIGHTER,
    )  # fmt: skip


def change_of_failure(note: Note) -> Change:
    """What cannot be built; its sentence ends with what to do."""
    finding, _, remedy = note.rpartition("; ")
    return Change(note.margin, "assembly", finding, remedy, verdict=finding, brief=remedy)


def change_of_mesh(one: MeshAtGlance) -> Change | None:
    """What a mesh falls short of: a safety below its minimum."""
    return _too_weak(one, one.safety) if one.margin < 1.0 and one.safety is not None else None


def change_of_load(one: MeshAtGlance) -> Change | None:
    """What evens out the load over the face, where that gains or the load is far from even."""
    uneven = one.face_load_factor if math.isfinite(one.face_load_factor) else 1.0
    gains = gain_of_lead(one) > WORTH_A_LEAD
    if not gains and uneven <= _WORTH:
        return None
    middle = not gains and abs(one.peak) < _MIDDLE
    remedy, told = ("less lead crowning C_β", "") if middle else _against_tilt(one)
    return Change(
        1.0 + 1.0 / uneven, f"pair {one.pair}", f"K_Hβ {uneven:.2f}, {place_of_peak(one)}", remedy, urgent=False,
        told=told,
    )  # fmt: skip


def place_of_peak(one: MeshAtGlance) -> str:
    """Where the load over the face is largest."""
    return "largest load at " + ("mid-face" if abs(one.peak) < _MIDDLE else "end II" if one.peak > 0.0 else "end I")


def gain_of_lead(one: MeshAtGlance) -> float:
    """K_Hbeta over that with the shafts' tilt ground away."""
    return 1.0 if one.lead is None else one.lead.before / one.lead.after


def levelled_lead(one: MeshAtGlance, *, gained: bool = True) -> str:
    """The whole lead against tilt and sag of the shafts; if `gained`, with K_Hbeta before and after it."""
    if one.lead is None or gain_of_lead(one) <= WORTH_A_LEAD:
        return "lead correction"
    slope, crowning = one.present[0] + one.lead.slope, one.present[1] + one.lead.crowning
    amounts = [f"helix slope C_Hβ {figures(slope * 1e6)} µm with {end_of_slope(slope)}"] if abs(slope) > _NONE else []
    if crowning > _NONE or one.present[1] or not amounts:
        amounts.append(f"crowning C_β {figures(crowning * 1e6) if crowning > _NONE else 0} µm")
    whole = ", in place of its present lead" if any(one.present) else ""
    gain = f": K_Hβ of the loaded flanks {one.lead.before:.2f} -> {one.lead.after:.2f}" if gained else ""
    return (
        f"lead correction ({' and '.join(amounts)} on the driver{whole}{gain}; estimate, lead-correction computes it)"
    )


def lead_to_compute(one: MeshAtGlance, *, gained: bool = True) -> str:
    """A lead correction without its amounts; if `gained`, with K_Hbeta before and after it."""
    if one.lead is None or gain_of_lead(one) <= WORTH_A_LEAD:
        return "lead correction"
    gain = f"K_Hβ of the loaded flanks {one.lead.before:.2f} -> about {one.lead.after:.2f}; " if gained else ""
    return f"lead correction ({gain}amounts by lead-correction)"


def end_of_slope(slope: float) -> str:
    """The end of the face at which a helix slope, zero at end I, removes more."""
    return f"more removal at end {'II' if slope > 0.0 else 'I'}"


def limit_of(one: MeshAtGlance, safety: Safety) -> tuple[str, str, float, float, float]:
    """Symbol, failure, value and minimum of the safety factor that limits the load, and its power of the load."""
    flank, root = safety.margins
    if flank <= root:
        return "S_H", "pitting", one.contact, one.contact_required, 0.5
    return "S_F", "tooth breakage", one.bending, one.bending_required, 1.0


def least_safe(one: MeshAtGlance, safety: Safety) -> Change:
    """The safety factor with the least margin, and what raises it."""
    symbol, what, value, least, power = limit_of(one, safety)
    if gain_of_lead(one) <= WORTH_A_LEAD:
        wider, told = value * _MORE**power, ""
        remedy = f"{percent(_MORE - 1.0, whole=True)} more face width at equal K factors: {symbol} about {wider:.2f}"
    else:
        remedy, told = (lead + _rated(one, safety) for lead in (levelled_lead(one), lead_to_compute(one)))
    load = f"minimum safety: {percent(one.margin, whole=True)} of the load"
    return Change(
        one.margin, f"pair {one.pair}", f"{symbol} {value:.2f} of {figures(least)} ({what}), {load}", remedy,
        urgent=False, beside=load, told=told,
    )  # fmt: skip


def _rated(one: MeshAtGlance, safety: Safety) -> str:
    """What the rating makes of the lead correction; empty where it does not follow it."""
    if (after := one.levelled) is None:
        return ""
    symbol = limit_of(one, safety)[0]
    value = after.contact if symbol == "S_H" else after.bending
    factors = f"K_Hβ {after.face_load_factor:.2f} in place of {_factor(safety)}"
    return f": {symbol} {value:.2f} at {factors}"


def _factor(safety: Safety) -> str:
    """K_Hbeta in the safety factors, with where it comes from."""
    return f"{safety.face_load_factor:.2f} of the {'loaded flanks' if safety.of_flanks else 'rating'}"


def _against_tilt(one: MeshAtGlance, rated: str = "", *, gained: bool = True) -> tuple[str, str]:
    """What evens out the load of a misaligned mesh, with what the lead correction makes of the rating.

    With the amounts of the lead and without.
    """
    cause = CAUSES[one.main_cause]
    share, every = figures(one.by_cause[one.main_cause] * 1e6), figures(one.over_face * 1e6)
    of_all = f"{CAUSE_WORDS[cause]} {share} µm, all causes {every} µm"
    with_amounts, without = (made(one, gained=gained) for made in (levelled_lead, lead_to_compute))
    others = f"{rated}, or {REMEDIES[cause]} ({of_all})"
    return with_amounts + others, without + others


def _too_weak(one: MeshAtGlance, safety: Safety) -> Change:
    """A safety below its minimum: an even load where that helps, more face width where that does not suffice."""
    symbol, what, value, least, _ = limit_of(one, safety)
    load = f"{percent(one.margin, whole=True)} of the load"
    finding = f"{symbol} {value:.2f} of {figures(least)} ({what}), {load}"
    verdict = f"pair {one.pair} {what} {symbol} {value:.2f} ({figures(least)} required)"
    level = max(_CORRECTED, one.lead.after) if one.lead is not None and gain_of_lead(one) > WORTH_A_LEAD else _CORRECTED
    after = one.levelled
    if after is None and not (safety.face_load_factor > max(_WORTH, level) and one.over_face):
        remedy = _wider(one.margin)
        return Change(
            one.margin, f"pair {one.pair}", finding, remedy, verdict=verdict, brief=_width(one.margin), beside=load
        )
    # without its rating nothing says that a lead correction suffices: manufacturing deviations remain
    (remedy, told), brief, more = _against_tilt(one, _rated(one, safety), gained=False), "lead correction", ""
    left = one.margin if after is None else min(after.margins)
    if after is None:
        more = f", against K_Hβ {_factor(safety)}; or {_wider(left)}"
        brief += f" or {_width(left)}"
    elif left < 1.0:
        more = f"; with the lead correction still {_wider(left)}"
        brief += f" and {_width(left)}"
    return Change(
        one.margin, f"pair {one.pair}", finding, remedy + more, verdict=verdict, brief=brief, beside=load,
        told=told + more,
    )  # fmt: skip


def _wider(margin: float) -> str:
    """What takes the load that a mesh with this margin lacks."""
    return f"{_width(margin)} at equal K factors, or a larger centre distance"


def _width(margin: float) -> str:
    return f"{figures(1.0 / margin, 3)} times the face width"
