"""A gearbox at a glance: its meshes and bearings, each with the load that it could take, and what to change first."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fegear.base.notes import Note, failing
from fegear.base.printed import figures, percent
from fegear.base.shown import shown
from fegear.contact.wide.on_shafts import LoadedShafts
from fegear.design.flanks.lead_correction import LevelLead
from fegear.results.shafts.checked_shafts import STRAIGHTER, CheckedShaft, ShaftChecks, TiltedBearing, tilted_bearings
from fegear.results.shafts.drawn_gearbox import DrawnGearbox
from fegear.shafts.bearing_seat import BearingSeat
from fegear.shafts.designations import KNOWN, plain_designation
from fegear.shafts.gearbox import CAUSES
from fegear.shafts.larger_bearing import BearingChange, LargerBearing, larger_bearing
from fegear.shafts.life import EXPONENT, LifeRating

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
#: Parts that are to be changed first.
_FIRST = 3
#: Dimensions that differ by less are one [m].
_SAME = 1e-6
#: Gain of K_Hbeta from which a lead correction is named, and what a part of the usual size more is worth.
_GAIN, _MORE = 1.02, 1.1


@dataclass(frozen=True)
class Safety:
    """Lower safety factors of both gears by ISO 6336, the required ones, and the K_Hbeta that they contain."""

    contact: float
    bending: float
    required: tuple[float, float]
    face_load_factor: float

    @property
    def margins(self) -> tuple[float, float]:
        """Load that flanks and roots could take over the present one, at equal load factors."""
        return (self.contact / self.required[0]) ** 2, self.bending / self.required[1]


@dataclass(frozen=True)
class MeshAtGlance:
    """One mesh: misalignment by cause, load factor, safeties, transmission error; NaN where not computed.

    Parameters
    ----------
    safety : Safety or None
    face_load_factor_error, te_error : float
        Estimated.
    peak : float
        Where the load over the face is largest: -1 at end I, 0 at mid-face, 1 at end II.
    lead : LevelLead or None
        Helix slope and crowning against the shafts, besides the present ones, and what they are worth; None where
        nothing gains.
    levelled : Safety or None
        As `safety` with `lead` in addition to the present lead; None where the rating does not follow it.
    remaining : float
        Linear part of the gap with the modifications of both flanks, as `over_face` without [m].
    present : tuple of float
        Present slope and crowning of the driver [m].
    """

    safety: Safety | None
    face_load_factor_error: float
    te_error: float
    peak: float
    pair: str = shown("", "gear pair")
    over_face: float = shown("um", "misalignment over the face, all causes together", name="misalignment")
    by_cause: tuple[float, ...] = shown("um", "share of the misalignment", name="misalignment")
    face_load_factor: float = shown("", "computed face load factor K_Hbeta", name="K_Hbeta")
    contact: float = shown("", "lower safety factor against pitting, ISO 6336", name="S_H")
    contact_required: float = shown("", "its minimum", name="S_H_min")
    bending: float = shown("", "lower safety factor against tooth breakage, ISO 6336", name="S_F")
    bending_required: float = shown("", "its minimum", name="S_F_min")
    te_peak_to_peak: float = shown("um", "peak-to-peak transmission error", name="te_peak_to_peak")
    margin: float = shown("", "load at the minimum safety factors over the present one", name="load_margin")
    lead: LevelLead | None = None
    levelled: Safety | None = None
    remaining: float = math.nan
    present: tuple[float, float] = (0.0, 0.0)

    @property
    def main_cause(self) -> int:
        """Number of the cause with the largest share in the direction of the sum."""
        return int(np.argmax(np.array(self.by_cause) * math.copysign(1.0, self.over_face)))


@dataclass(frozen=True)
class BearingAtGlance:
    """One bearing: its forces and its life; NaN where no rating or no speed is known."""

    bearing: str = shown("", "name")
    shaft: str = shown("", "shaft on which it sits")
    radial: float = shown("N", "radial bearing force", name="force_radial")
    axial: float = shown("N", "axial bearing force", name="force_axial")
    life: float = shown("", "basic rating life L_10, in revolutions (ISO 281)", name="life")
    duration: float = shown("h", "basic rating life L_10h at the speed of its shaft", name="life_hours")
    margin: float = shown("", "load at the required life over the present one", name="load_margin")
    exponent: float = math.nan
    tilt: float = shown("arcmin", "tilt of the inner ring in the outer one", default=math.nan)
    permissible: float = shown("arcmin", "permissible tilt: as given, or maximum guide value of its kind",
                               name="tilt_permissible", default=math.nan)  # fmt: skip
    tilted: TiltedBearing | None = None
    designation: str = shown("", "designation", default="")
    larger: str = shown("", "bearing that reaches the required life, with its bore", name="change_to", default="")
    change: BearingChange | None = None
    seat: BearingSeat = field(default_factory=BearingSeat)

    @property
    def least(self) -> float:
        """Load that life and tilt permit over the present one; infinite where neither is known."""
        tilt = math.inf if self.tilted is None else self.tilted.margin
        return min(_last(self.margin), tilt)


@dataclass(frozen=True)
class Change:
    """Something to change, with why and what it brings; urgent where it falls short or wastes load capacity."""

    margin: float
    part: str = shown("", "pair or bearing")
    finding: str = shown("", "what is found")
    remedy: str = shown("", "what would help")
    urgent: bool = True


@dataclass(frozen=True)
class GearboxData:
    """What the result found; meshes and bearings the weakest first.

    Parameters
    ----------
    shafts : LoadedShafts
    drawn : DrawnGearbox
    meshes : tuple of MeshAtGlance
    bearings : tuple of BearingAtGlance
    required_hours : float
        Largest life that a pair is rated for [s]; NaN where none is.
    failures : tuple of Note
        Why the gearbox cannot be built, the worst first: bodies that cut each other, bores that are not their shaft's.
    checked : tuple of CheckedShaft
        Shafts against yielding, the weakest first.
    """

    shafts: LoadedShafts
    drawn: DrawnGearbox
    meshes: tuple[MeshAtGlance, ...]
    bearings: tuple[BearingAtGlance, ...]
    required_hours: float
    failures: tuple[Note, ...] = ()
    checked: tuple[CheckedShaft, ...] = ()

    @cached_property
    def changes(self) -> tuple[Change, ...]:
        """At most three, the most urgent first: what cannot be built or fails, what wastes load, then the weakest.

        Of what fails, the weakest mesh, shaft and bearing come before a second one of their kind: three short-lived
        bearings would hide what a mesh needs.
        """
        of_bearings = (*map(_of_tilt, self.bearings), *map(self._of_bearing, self.bearings))
        kinds = [_in_order(kind) for kind in (map(_of_mesh, self.meshes), map(_of_shaft, self.checked), of_bearings)]
        ranked = [(one.margin >= 1.0, n, one) for kind in kinds for n, one in enumerate(kind)]
        urgent = [one for _, _, one in sorted(ranked, key=lambda found: (found[0], found[1], found[2].margin))]
        named = {one.part for one in urgent}
        found = [*map(_of_failure, self.failures), *urgent]
        for one in self._improvements():
            if one.part not in named:
                found.append(one)
                named.add(one.part)
        return tuple(found[:_FIRST])

    def said_of_lives(self) -> Iterator[Note]:
        """Bearings whose life is too short, the least margin first, with what to change."""
        for one in self.bearings:
            if (change := self._of_bearing(one)) is not None:
                finding = f"basic rating {change.finding} required on shaft {one.shaft}"
                yield failing(f"Bearing {one.bearing}: {finding}; {change.remedy}.", one.margin)

    def _improvements(self) -> Iterator[Change]:
        """What limits the load although it suffices: least safety, shortest life, and loads over the face to even."""
        rated = [one for one in self.meshes if math.isfinite(one.margin) and one.safety is not None]
        yield from (_least_safe(one, one.safety) for one in rated[:1] if one.safety is not None)
        lasting = [one for one in self.bearings if math.isfinite(one.margin)]
        yield from (self._shortest(one) for one in lasting[:1])
        levelled = [one for one in self.meshes if _gain(one) > _GAIN]
        for one in sorted(levelled, key=_gain, reverse=True):
            yield Change(
                one.margin, f"pair {one.pair}", f"K_Hβ {one.face_load_factor:.2f}, {_place(one)}", _levelled(one),
                urgent=False,
            )  # fmt: skip

    def _shortest(self, one: BearingAtGlance) -> Change:
        hours = one.duration / 3600.0
        longer = figures(hours * _MORE**one.exponent)
        remedy = f"{percent(_MORE - 1.0, whole=True)} more dynamic load rating C: {longer} h"
        if one.change is not None and one.change.fitting is not None:
            remedy = _changed_to(one, one.change.fitting)
        return Change(
            one.margin, f"bearing {one.bearing} of shaft {one.shaft}",
            f"life {figures(hours)} h, required {figures(self.required_hours / 3600.0)} h: minimum reserve of bearings",
            remedy, urgent=False,
        )  # fmt: skip

    def _of_bearing(self, one: BearingAtGlance) -> Change | None:
        if not one.margin < 1.0:
            return None
        remedy = f"a dynamic load rating C {_times(one.margin)} times as large"
        if one.change is not None:
            remedy = f"{_advised(one, one.change)}, or C {_times(one.margin)} times as large"
        return Change(
            one.margin, f"bearing {one.bearing} of shaft {one.shaft}",
            f"life {figures(one.duration / 3600.0)} h of {figures(self.required_hours / 3600.0)} h", remedy,
        )  # fmt: skip


def _in_order(changes: Iterable[Change | None]) -> list[Change]:
    """Those that are necessary, the least margin first."""
    return sorted((one for one in changes if one is not None), key=lambda one: one.margin)


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


def _of_shaft(one: CheckedShaft) -> Change | None:
    """A shaft that yields."""
    if not one.margin < 1.0:
        return None
    needed = figures(one.strength * 1e-6 / one.margin)
    return Change(
        one.margin, f"shaft {one.shaft}", one.found,
        f"a diameter of {figures(one.needed * 1e3)} mm there, or a yield strength of {needed} MPa",
    )  # fmt: skip


def _of_tilt(one: BearingAtGlance) -> Change | None:
    """A bearing that is tilted more than its kind permits."""
    if one.tilted is None or not one.tilted.margin < 1.0:
        return None
    return Change(one.tilted.margin, f"bearing {one.bearing} of shaft {one.shaft}", one.tilted.found, STRAIGHTER)


def _of_failure(note: Note) -> Change:
    """What cannot be built; its sentence ends with what to do."""
    finding, _, remedy = note.rpartition("; ")
    return Change(note.margin, "assembly", finding, remedy)


def _of_mesh(one: MeshAtGlance) -> Change | None:
    """What is wrong with a mesh: a safety below its minimum, else load that is far from even."""
    if one.margin < 1.0 and one.safety is not None:
        return _too_weak(one, one.safety)
    uneven = one.face_load_factor if math.isfinite(one.face_load_factor) else 1.0
    if uneven <= _WORTH:
        return None
    middle = abs(one.peak) < _MIDDLE
    return Change(
        1.0 + 1.0 / uneven, f"pair {one.pair}", f"K_Hβ {uneven:.2f}, {_place(one)}",
        "less lead crowning C_β" if middle else _against_tilt(one),
    )  # fmt: skip


def _place(one: MeshAtGlance) -> str:
    """Where the load over the face is largest."""
    return "largest load at " + ("mid-face" if abs(one.peak) < _MIDDLE else "end II" if one.peak > 0.0 else "end I")


def _gain(one: MeshAtGlance) -> float:
    """K_Hbeta over that with the shafts' tilt ground away."""
    return 1.0 if one.lead is None else one.lead.before / one.lead.after


def _levelled(one: MeshAtGlance, *, gained: bool = True) -> str:
    """The whole lead against tilt and sag of the shafts; if `gained`, with K_Hbeta before and after it."""
    if one.lead is None or _gain(one) <= _GAIN:
        return "lead correction"
    slope, crowning = one.present[0] + one.lead.slope, one.present[1] + one.lead.crowning
    amounts = [f"helix slope C_Hβ {figures(slope * 1e6)} µm with {end_of_slope(slope)}"] if abs(slope) > _NONE else []
    if crowning > _NONE or one.present[1] or not amounts:
        amounts.append(f"crowning C_β {figures(crowning * 1e6) if crowning > _NONE else 0} µm")
    whole = ", in place of its present lead" if any(one.present) else ""
    gain = f": K_Hβ of the loaded flanks {one.lead.before:.2f} -> {one.lead.after:.2f}" if gained else ""
    return (
        f"lead correction ({' and '.join(amounts)} on the driver{whole}{gain}; estimate, grind that of lead-correction)"
    )


def end_of_slope(slope: float) -> str:
    """The end of the face at which a helix slope, zero at end I, removes more."""
    return f"more removal at end {'II' if slope > 0.0 else 'I'}"


def _limit(one: MeshAtGlance, safety: Safety) -> tuple[str, str, float, float, float]:
    """Symbol, failure, value and minimum of the safety factor that limits the load, and its power of the load."""
    flank, root = safety.margins
    if flank <= root:
        return "S_H", "pitting", one.contact, one.contact_required, 0.5
    return "S_F", "tooth breakage", one.bending, one.bending_required, 1.0


def _least_safe(one: MeshAtGlance, safety: Safety) -> Change:
    """The safety factor with the least margin, and what raises it."""
    symbol, what, value, least, power = _limit(one, safety)
    if _gain(one) <= _GAIN:
        wider = value * _MORE**power
        remedy = f"{percent(_MORE - 1.0, whole=True)} more face width at equal K factors: {symbol} about {wider:.2f}"
    else:
        remedy = _levelled(one) + _rated(one, safety)
    return Change(
        one.margin, f"pair {one.pair}",
        f"{symbol} {value:.2f} of {figures(least)} ({what}), minimum safety: {percent(one.margin, whole=True)} of the "
        "load",
        remedy, urgent=False,
    )  # fmt: skip


def _rated(one: MeshAtGlance, safety: Safety) -> str:
    """What the rating makes of the lead correction; empty where it does not follow it."""
    if (after := one.levelled) is None:
        return ""
    symbol = _limit(one, safety)[0]
    value = after.contact if symbol == "S_H" else after.bending
    factors = f"K_Hβ {after.face_load_factor:.2f} in place of {safety.face_load_factor:.2f} of the rating"
    return f": {symbol} {value:.2f} at {factors}"


def _against_tilt(one: MeshAtGlance, rated: str = "", *, gained: bool = True) -> str:
    """What evens out the load of a misaligned mesh, with what the lead correction makes of the rating."""
    cause = CAUSES[one.main_cause]
    share, every = figures(one.by_cause[one.main_cause] * 1e6), figures(one.over_face * 1e6)
    of_all = f"{CAUSE_WORDS[cause]} {share} µm, all causes {every} µm"
    return f"{_levelled(one, gained=gained)}{rated}, or {REMEDIES[cause]} ({of_all})"


def _too_weak(one: MeshAtGlance, safety: Safety) -> Change:
    """A safety below its minimum: an even load where that helps, more face width where that does not suffice."""
    symbol, what, value, least, _ = _limit(one, safety)
    finding = f"{symbol} {value:.2f} of {figures(least)} ({what}), {percent(one.margin, whole=True)} of the load"
    level = max(_CORRECTED, one.lead.after) if one.lead is not None and _gain(one) > _GAIN else _CORRECTED
    after = one.levelled
    if after is None and not (safety.face_load_factor > max(_WORTH, level) and one.over_face):
        return Change(one.margin, f"pair {one.pair}", finding, _wider(one.margin))
    # without its rating nothing says that a lead correction suffices: manufacturing deviations remain
    remedy = _against_tilt(one, _rated(one, safety), gained=False)
    left = one.margin if after is None else min(after.margins)
    if after is None:
        remedy += f", against K_Hβ {safety.face_load_factor:.2f} of the rating; or {_wider(left)}"
    elif left < 1.0:
        remedy += f"; with the lead correction still {_wider(left)}"
    return Change(one.margin, f"pair {one.pair}", finding, remedy)


def _wider(margin: float) -> str:
    """What takes the load that a mesh with this margin lacks."""
    return f"{figures(1.0 / margin, 3)} times the face width at equal K factors, or a larger centre distance"


def safeties(found: Iterator[tuple[object, dict[str, tuple[float, float]]]], ending: str) -> tuple[float, float]:
    """Lower S_H and S_F of both gears by the method with this ending."""
    for method, known in found:
        if getattr(method, "ending", None) == ending:
            return min(known["contact_safety"]), min(known["bending_safety"])
    return math.nan, math.nan


def bearings_at_glance(
    data: LoadedShafts,
    lives: Sequence[Sequence[LifeRating | None]],
    speeds: Sequence[Sequence[float]],
    designations: Sequence[Sequence[str]],
    checks: ShaftChecks,
    required: float,
    seats: Sequence[Sequence[BearingSeat]],
) -> tuple[BearingAtGlance, ...]:
    """Every bearing, the least load margin first, then the shortest life.

    Parameters
    ----------
    data : LoadedShafts
    lives, speeds, designations : sequence of sequence
        Of every bearing by shafts: its rating, the speed of its rings against each other [rad/s], its designation.
    checks : ShaftChecks
    required : float
        Life [s].
    seats : sequence of sequence of BearingSeat
    """
    found = []
    tilts = tilted_bearings(checks, data.nominal.bent)
    every = zip(data.nominal.bent, lives, speeds, designations, tilts, seats, strict=True)
    for bent, of_lives, of_speeds, of_designations, of_tilts, of_seats in every:
        loads = bent.bearing_loads(tuple(of_lives))
        for k, tilted in enumerate(of_tilts):
            rating = of_lives[k]
            duration = float(loads.life[k]) * 2.0 * math.pi / of_speeds[k] if of_speeds[k] > 0.0 else math.nan
            exponent = math.nan if rating is None else EXPONENT[rating.kind]
            margin = (duration / required) ** (1.0 / exponent)
            radial, axial = float(loads.force_radial[k]), abs(float(loads.force_axial[k]))
            permissible = math.nan if tilted.permissible is None else tilted.permissible.high
            found.append(BearingAtGlance(
                tilted.bearing, tilted.shaft, radial, axial, float(loads.life[k]), duration, margin, exponent,
                tilted.tilt, permissible, tilted, of_designations[k], seat=of_seats[k],
            ))  # fmt: skip
    ordered = sorted(found, key=lambda one: (one.least, _last(one.margin), _last(one.duration), _last(one.life)))
    first = next((one for one in ordered if math.isfinite(one.margin)), None)
    return tuple(_with_larger(one, improved=one is first) for one in ordered)


def _with_larger(one: BearingAtGlance, *, improved: bool) -> BearingAtGlance:
    """With the bearing to change to where its life is too short, or `improved`: one with more of it."""
    if not one.designation or not math.isfinite(one.margin) or not (one.margin < 1.0 or improved):
        return one
    wanted = one.life * (one.margin**-one.exponent if one.margin < 1.0 else 1.0)
    change = larger_bearing(one.designation, one.radial, one.axial, wanted, one.seat)
    if change is None or change.fitting is None or one.margin >= 1.0:
        return replace(one, change=change)
    found = change.fitting
    return replace(one, change=change, larger=f"{found.said} (bore {figures(found.bore * 1e3, 4)} mm)")


def meshes_in_order(meshes: Sequence[MeshAtGlance]) -> tuple[MeshAtGlance, ...]:
    """The least load margin first, then the largest K_Hbeta, then the largest misalignment."""
    return tuple(sorted(meshes, key=lambda one: (_last(one.margin), _last(-one.face_load_factor), -abs(one.over_face))))


def _last(value: float) -> float:
    return math.inf if math.isnan(value) else value
