"""Meshes and bearings of a gearbox at a glance: each with the load that it could take, the weakest first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.contact.wide.on_shafts import LoadedShafts
from fegear.design.flanks.lead_correction import LevelLead
from fegear.results.shafts.checked_shafts import ShaftChecks, TiltedBearing, tilted_bearings
from fegear.shafts.bearing_seat import BearingSeat
from fegear.shafts.larger_bearing import BearingChange, larger_bearing
from fegear.shafts.life import EXPONENT, LifeRating
from fegear.shafts.static_safety import StaticRating


@dataclass(frozen=True)
class Safety:
    """Lower safety factors of both gears by ISO 6336, the required ones, and the K_Hbeta that they contain.

    That is the larger one of ISO 6336-1 and of the loaded flanks; `formula` is the former where it is exceeded,
    otherwise NaN.
    """

    contact: float
    bending: float
    required: tuple[float, float]
    face_load_factor: float
    formula: float = math.nan

    @property
    def of_flanks(self) -> bool:
        """Whether K_Hbeta of the loaded flanks exceeds that of ISO 6336-1."""
        return math.isfinite(self.formula)

    def on_flanks(self, face_load_factor: float) -> Safety:
        """With at least this K_Hbeta of the loaded flanks; itself where that is not known (NaN)."""
        contact, bending = safeties_on_flanks(self.contact, self.bending, self.face_load_factor, face_load_factor)
        if not face_load_factor > self.face_load_factor:
            return self
        return Safety(contact, bending, self.required, face_load_factor, self.face_load_factor)

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
    rated: float = shown("", "K_Hbeta in S_H and S_F: the larger one of ISO 6336-1, with manufacturing deviations, "
                         "and of the loaded flanks",
                         name="K_Hbeta_rated", default=math.nan)  # fmt: skip
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
    other: float = shown("h", "basic rating life L_10h in the other direction of rotation (coast flanks loaded)",
                         name="life_hours_reverse", default=math.nan)  # fmt: skip
    seat: BearingSeat = field(default_factory=BearingSeat)
    static: float = shown("", "static safety factor C_0/P_0 under this load, ISO 76 (C_0 of `catalogue`, otherwise "
                          "estimated from the dimensions)", name="s_0", default=math.nan)  # fmt: skip

    @property
    def least(self) -> float:
        """Load that life and tilt permit over the present one; infinite where neither is known."""
        tilt = math.inf if self.tilted is None else self.tilted.margin
        return min(last_of(self.margin), tilt)


def safeties(found: Iterator[tuple[object, dict[str, tuple[float, float]]]], ending: str) -> tuple[float, float]:
    """Lower S_H and S_F of both gears by the method with this ending."""
    for method, known in found:
        if getattr(method, "ending", None) == ending:
            return min(known["contact_safety"]), min(known["bending_safety"])
    return math.nan, math.nan


def safeties_on_flanks(contact: float, bending: float, formula: float, flanks: float) -> tuple[float, float]:
    """S_H and S_F at the larger K_Hbeta: that of the formula, which they contain, or that of the loaded flanks.

    ISO 6336-1 takes a helix correction as one that compensates the shafts, whatever its amount and sign; loaded flanks
    show what it leaves. sigma_H grows with the root of K_Hbeta, sigma_F with K_Fbeta = K_Hbeta^N_F; N_F is at most 1,
    which is taken.
    """
    share = formula / flanks
    return (contact * math.sqrt(share), bending * share) if share < 1.0 else (contact, bending)


def bearings_at_glance(
    data: LoadedShafts,
    lives: Sequence[Sequence[LifeRating | None]],
    speeds: Sequence[Sequence[float]],
    designations: Sequence[Sequence[str]],
    checks: ShaftChecks,
    required: float,
    seats: Sequence[Sequence[BearingSeat]],
    others: Sequence[Sequence[float]] | None = None,
    statics: Sequence[Sequence[StaticRating | None]] | None = None,
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
    others : sequence of sequence of float, optional
        Life in the other direction of rotation over that in this one.
    statics : sequence of sequence of StaticRating or None, optional
        What the static safety of every bearing follows from.
    """
    found = []
    if statics is None:
        statics = [[None] * len(row) for row in lives]
    if others is None:
        others = [[math.nan] * len(row) for row in lives]
    tilts = tilted_bearings(checks, data.nominal.bent)
    every = zip(data.nominal.bent, lives, speeds, designations, tilts, seats, others, statics, strict=True)
    for bent, of_lives, of_speeds, of_designations, of_tilts, of_seats, of_others, of_statics in every:
        loads = bent.bearing_loads(tuple(of_lives))
        for k, tilted in enumerate(of_tilts):
            rating = of_lives[k]
            duration = float(loads.life[k]) * 2.0 * math.pi / of_speeds[k] if of_speeds[k] > 0.0 else math.nan
            exponent = math.nan if rating is None else EXPONENT[rating.kind]
            margin = (duration / required) ** (1.0 / exponent)
            radial, axial = float(loads.force_radial[k]), abs(float(loads.force_axial[k]))
            permissible = math.nan if tilted.permissible is None else tilted.permissible.high
            static = of_statics[k]
            found.append(BearingAtGlance(
                tilted.bearing, tilted.shaft, radial, axial, float(loads.life[k]), duration, margin, exponent,
                tilted.tilt, permissible, tilted, of_designations[k], other=duration * of_others[k],
                seat=of_seats[k], static=math.nan if static is None else static.safety(radial, axial),
            ))  # fmt: skip
    ordered = sorted(found, key=lambda one: (one.least, last_of(one.margin), last_of(one.duration), last_of(one.life)))
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
    return tuple(
        sorted(meshes, key=lambda one: (last_of(one.margin), last_of(-one.face_load_factor), -abs(one.over_face)))
    )


def last_of(value: float) -> float:
    """A number to sort by: unknown ones come last."""
    return math.inf if math.isnan(value) else value
