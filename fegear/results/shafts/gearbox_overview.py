"""Result ``gearbox``: meshes and bearings at a glance, the weakest first, what to change first, and a drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import NoteClass, class_of, exceeding, neglecting, ordered
from fegear.case.built.bearing_room import seats_of
from fegear.case.built.pair_checks import check_wide_pair
from fegear.case.built.shafts import mesh_places
from fegear.contact.wide.on_shafts import FlankForces
from fegear.design.flanks.lead_correction import level_lead
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import DeferredFigure
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import check_teeth, loaded_pairs
from fegear.results.rating.rated_methods import methods
from fegear.results.rating.rating_data import RatingData
from fegear.results.shafts.at_glance import (
    BearingAtGlance,
    MeshAtGlance,
    Safety,
    bearings_at_glance,
    meshes_in_order,
    safeties,
)
from fegear.results.shafts.checked_shafts import ShaftChecks, checked_shafts, checks_of, said_of_checks
from fegear.results.shafts.drawn_gearbox import drawn_gearbox
from fegear.results.shafts.gearbox_changes import CAUSE_WORDS
from fegear.results.shafts.gearbox_data import GearboxData
from fegear.results.shafts.gearbox_scheme import scheme
from fegear.results.shafts.gearbox_sentences import sentences
from fegear.results.shafts.loaded_shafts import (
    LOADED_SHAFTS_TASK,
    inputs_of_shafts,
    loaded_shafts,
    mesh_forces,
    needs_gears_of_meshes,
    shafts_of,
)
from fegear.results.shafts.other_direction import other_direction, shares_of_life
from fegear.results.shafts.rated_lead import SafetyOfLead, present_lead, rated_lead, rated_with
from fegear.results.shafts.shaft_deflection import overlooked
from fegear.results.shafts.shaft_speeds import against, speeds_of_shafts
from fegear.shafts.designations import designation_of
from fegear.shafts.gearbox import CAUSES

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.base.notes import Note
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.reading import Scene
    from fegear.case.shaft import BearingPart
    from fegear.contact.wide.on_shafts import LoadedShafts
    from fegear.design.flanks.lead_correction import LevelLead
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.results.pair.transmission_error import TransmissionErrorData
    from fegear.results.shafts.drawn_gearbox import DrawnGearbox
    from fegear.results.shafts.loaded_shafts import LoadedShaftsInputs
    from fegear.results.shafts.other_direction import OtherDirection
    from fegear.results.shafts.rated_lead import RatedLead
    from fegear.shafts.bearing_seat import BearingSeat
    from fegear.shafts.gearbox import MeshState
    from fegear.shafts.life import LifeRating
    from fegear.shafts.static_safety import StaticRating


#: A cause with less of the sum of all is none: seats that are rigid leave round-off.
_ROUND_OFF = 1e-12


@dataclass(frozen=True)
class GearboxInputs:
    """What the result reads of the case.

    Parameters
    ----------
    shafts : LoadedShaftsInputs
    drawn : DrawnGearbox
    rated : tuple of PairToRate or None
        Of every mesh; None where the case lacks what a rating needs.
    releaded : tuple of RatedLead or None
        Of every mesh, to rate it with another lead of its driver.
    leads : tuple of tuple of float
        Present slope and crowning of the driver of every mesh [m].
    wide, loaded : tuple of bool
        Of every mesh, whether its flanks are loaded over the face, and whether it has a transmission error.
    lives, speeds, designations : tuple of tuple
        Of every bearing by shafts: its rating, the speed of its rings against each other [rad/s], its designation,
        empty without one.
    checks : ShaftChecks
    required : float
        Longest life that pairs are rated for [s]; NaN where none is given.
    seats : tuple of tuple of BearingSeat
        Of every bearing by shafts.
    why : tuple of str
        Why something is missing.
    statics : tuple of tuple of StaticRating or None
    other : OtherDirection or None
        With the other direction of rotation.
    """

    shafts: LoadedShaftsInputs
    drawn: DrawnGearbox
    rated: tuple[PairToRate | None, ...]
    releaded: tuple[RatedLead | None, ...]
    leads: tuple[tuple[float, float], ...]
    wide: tuple[bool, ...]
    loaded: tuple[bool, ...]
    lives: tuple[tuple[LifeRating | None, ...], ...]
    speeds: tuple[tuple[float, ...], ...]
    designations: tuple[tuple[str, ...], ...]
    checks: ShaftChecks
    required: float
    seats: tuple[tuple[BearingSeat, ...], ...]
    why: tuple[str, ...]
    statics: tuple[tuple[StaticRating | None, ...], ...] | None = None
    other: OtherDirection | None = None


def _refused(check: object, scene: Scene, pair: str) -> str:
    """Why something cannot be had of a pair; empty where it can."""
    try:
        check(scene, pair)  # type: ignore[operator]  # functions of several signatures
    except InputError as error:
        return f"{error.key} {error.rule}" if error.value == "(not given)" else str(error)
    return ""


def _why_not_rated(scene: Scene, pair: str) -> str:
    from fegear.case.built.rated_pair import pair_to_rate
    from fegear.results.rating.rating import RATING

    return _refused(RATING.check, scene, pair) or _refused(pair_to_rate, scene, pair)


def _has_error(scene: Scene, pair: str) -> bool:
    """Whether its transmission error is cheap or made anyway: of a pair loaded over the face."""
    return _is_wide(scene, pair) and pair in loaded_pairs(scene) and not _refused(check_teeth, scene, pair)


def _is_wide(scene: Scene, pair: str) -> bool:
    return pair in scene.wide_pairs and not _refused(check_wide_pair, scene, pair)


def _inputs(scene: Scene, name: str) -> GearboxInputs:
    from fegear.case.built.rated_pair import pair_to_rate

    meshes = [mesh.pair for mesh in mesh_places(scene)]
    reasons = {pair: _why_not_rated(scene, pair) for pair in meshes}
    part = scene.case.bearing
    shafts = scene.case.shaft
    names = tuple(tuple(place.bearing for place in one.bearings) for one in shafts.values())
    lives = tuple(tuple(part[one].rating for one in row) for row in names)
    spins = speeds_of_shafts(scene)
    speeds = tuple(tuple(against(spins, name, place.around) for place in one.bearings) for name, one in shafts.items())
    required = max((life for pair in meshes if (life := scene.case.pair[pair].operation.life)), default=math.nan)
    plane = [pair for pair in meshes if not _is_wide(scene, pair)]
    why = [f"pair {pair} is not rated: {reason}" for pair, reason in reasons.items() if reason]
    if plane:
        why.append(
            f"K_Hbeta and transmission error of {', '.join(plane)} are not computed for plane (2D) teeth: set "
            'width = "slices" or "solid"'
        )
    return GearboxInputs(
        inputs_of_shafts(scene, name), drawn_gearbox(scene),
        tuple(None if reasons[pair] else pair_to_rate(scene, pair) for pair in meshes),
        tuple(None if reasons[pair] else rated_lead(scene, pair) for pair in meshes),
        tuple(present_lead(scene, pair) for pair in meshes),
        tuple(_is_wide(scene, pair) for pair in meshes), tuple(_has_error(scene, pair) for pair in meshes),
        lives, speeds, tuple(tuple(_designation(part[one]) for one in row) for row in names), checks_of(scene),
        required, seats_of(scene), tuple(why),
        tuple(tuple(part[one].static for one in row) for row in names), other_direction(scene),
    )  # fmt: skip


def _designation(part: BearingPart) -> str:
    """That of the case, otherwise one with the dimensions of its catalogue; empty where none is known."""
    if part.designation is not None:
        return part.designation
    if (printed := part.printed) is None:
        return ""
    return designation_of(printed.kind, printed.bore, printed.outside_diameter, printed.width, printed.given_angle)


def _compute(inputs: GearboxInputs, upstream: Upstream, work: Work) -> GearboxData:
    shafts = loaded_shafts(upstream)
    states = shafts.gearbox.misalignment(shafts.nominal.bent, shafts.nominal.forces)
    leads = _leads(inputs, upstream, shafts, work)
    found = [replace(_mesh(inputs, upstream, shafts, n, state), lead=leads[n]) for n, state in enumerate(states)]
    meshes = [
        replace(one, levelled=_levelled(one, releaded)) for one, releaded in zip(found, inputs.releaded, strict=True)
    ]
    bearings = bearings_at_glance(
        shafts,
        inputs.lives,
        inputs.speeds,
        inputs.designations,
        inputs.checks,
        inputs.required,
        inputs.seats,
        shares_of_life(inputs.shafts.gearbox, inputs.other, inputs.lives),
        inputs.statics,
    )
    checked = checked_shafts(inputs.checks, shafts.nominal.bent)
    return GearboxData(
        shafts,
        inputs.drawn,
        meshes_in_order(meshes),
        bearings,
        inputs.required,
        _failures(inputs),
        checked,
        () if inputs.other is None else inputs.other.changes,
    )


def _failures(inputs: GearboxInputs) -> tuple[Note, ...]:
    """What is said of shafts, gears and bearings that fails, the least margin first; the same of several as one."""
    return ordered(one for one in inputs.shafts.said if class_of(one) is NoteClass.FAILS)


def _leads(inputs: GearboxInputs, upstream: Upstream, shafts: LoadedShafts, work: Work) -> list[LevelLead | None]:
    """Of every mesh whose flanks are loaded with the shafts, the helix slope against their tilt."""
    meshes = mesh_forces(inputs.shafts, upstream, work)
    return [
        level_lead(one, shafts.gaps_of(mesh.pair), mesh.load) if isinstance(one, FlankForces) else None
        for one, mesh in zip(meshes, inputs.shafts.gearbox.meshes, strict=True)
    ]


def _levelled(one: MeshAtGlance, releaded: RatedLead | None) -> Safety | None:
    """Safeties with the slope and crowning against the shafts in addition to the present lead of the driver.

    None where K_Hbeta of the rating does not change: given in the case, or by the same row of the standard's table.
    """
    if one.safety is None or one.lead is None or releaded is None:
        return None
    slope, crowning = one.present[0] + one.lead.slope, one.present[1] + one.lead.crowning
    found = rated_with(releaded, SafetyOfLead(one.pair, "", slope, crowning, one.lead.after))
    factor = max(found.factor, found.flanks)
    if not factor < one.safety.face_load_factor:
        return None
    return Safety(found.contact, found.bending, one.safety.required, factor)


def _mesh(inputs: GearboxInputs, upstream: Upstream, shafts: LoadedShafts, n: int, state: MeshState) -> MeshAtGlance:
    from fegear.contact.wide.load_factors import straight_gap

    pair, none = shafts.gearbox.meshes[n].pair, math.nan
    every, *by_cause = (float(one) for one in state[0].over_face)
    least = _ROUND_OFF * sum(map(abs, by_cause))
    by_cause = [one if abs(one) > least else 0.0 for one in by_cause]
    factor = factor_error = peak = swing = swing_error = remaining = none
    if inputs.wide[n]:
        teeth = loaded_flanks(upstream, pair)
        factor, factor_error = (float(of.face_load_factor[teeth.at]) for of in (teeth.stated, teeth.error))
        remaining = straight_gap(teeth.pair, teeth.gaps.under(teeth.nominal))
        peak = _peak(teeth.found.cells, teeth.found.mean_over_face[:, teeth.at])
    if inputs.loaded[n]:
        found = cast("TransmissionErrorData", upstream[Task("transmission-error", pair)]).found
        swing = float(found.te_peak_to_peak[found.at])
        swing_error = none if found.shift is None else float(found.shift.peak_to_peak)
    safety = _safety(inputs.rated[n], upstream, pair)
    if safety is not None:
        safety = safety.on_flanks(factor)
    contact, bending = (none, none) if safety is None else (safety.contact, safety.bending)
    required = (none, none) if safety is None else safety.required
    margin = none if safety is None else min(safety.margins)
    return MeshAtGlance(
        safety, factor_error, swing_error, peak, pair, every, tuple(by_cause), factor, contact, required[0], bending,
        required[1], swing, margin, rated=none if safety is None else safety.face_load_factor, remaining=remaining,
        present=inputs.leads[n],
    )  # fmt: skip


def _peak(cells: Array, load: Array) -> float:
    """Middle of the cell with the largest load, over half the face width."""
    z = 0.5 * (cells[1:] + cells[:-1])
    return float((2.0 * z[np.argmax(load)] - cells[0] - cells[-1]) / (cells[-1] - cells[0]))


def _safety(asked: PairToRate | None, upstream: Upstream, pair: str) -> Safety | None:
    """By ISO 6336, under the load spectrum where there is one; None where a pair is not rated."""
    found = None if asked is None else upstream[Task("rating", pair)]
    if asked is None or not isinstance(found, RatingData):
        return None
    ending = "_spectrum" if found.spectrum is not None else ""
    known = safeties(methods(found, asked), ending)
    return Safety(*known, asked.conditions.required, found.formula["K_Hbeta"].value)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    found = [LOADED_SHAFTS_TASK, *needs_gears_of_meshes(scene, name)]
    for mesh in mesh_places(scene):
        if not _why_not_rated(scene, mesh.pair):
            found.append(Task("rating", mesh.pair))
        if _is_wide(scene, mesh.pair):
            found.append(Task("loaded-flanks", mesh.pair))
        if _has_error(scene, mesh.pair):
            found.append(Task("transmission-error", mesh.pair))
    return tuple(found)


def _check(scene: Scene, _name: str) -> None:
    if not mesh_places(scene):
        raise InputError("shaft", "(no pair)", "has no mesh to evaluate", "mount both gears of a pair on shafts")


def _by_cause(n: int, cause: str) -> Cell:
    return Cell(
        "by_cause", lambda seen: [one.by_cause[n] for one in seen.data.meshes], name=f"misalignment_{cause}",
        meaning=f"share by {CAUSE_WORDS[cause]}",
    )  # fmt: skip


def _known(key: str, of: str = "meshes") -> Cell:
    """A column that is there where one of its numbers is known."""

    def numbers(seen: Seen) -> list[float] | None:
        found = [getattr(one, key) for one in getattr(seen.data, of)]
        return found if np.isfinite(found).any() else None

    return Cell(key, numbers)


def _with_error(key: str, error: str) -> Cell:
    return replace(_known(key), error=lambda seen: [getattr(one, error) for one in seen.data.meshes])


def _said_of_flanks(meshes: tuple[MeshAtGlance, ...]) -> list[Note]:
    """Meshes whose rating has less K_Hbeta than their loaded flanks."""
    return [
        exceeding(
            f"Pair {one.pair}: K_Hbeta {one.safety.face_load_factor:.2f} of the loaded flanks exceeds "
            f"{one.safety.formula:.2f} of the rating, of which S_H and S_F are non-conservative; those of the gearbox "
            f"contain {one.safety.face_load_factor:.2f}. Correct the lead for this load (lead-correction)."
        )
        for one in meshes
        if one.safety is not None and one.safety.of_flanks
    ]


def _changes_to(bearings: tuple[BearingAtGlance, ...]) -> list[str] | None:
    found = [one.larger for one in bearings]
    return found if any(found) else None


#: Which of two leads of one mesh is to be ground.
_ESTIMATED = (
    "Gearbox: K_Hbeta and safety factors after a lead correction are estimates under nominal load; request "
    "lead-correction for the amounts to grind, computed for all loads."
)
#: What the safety of shafts lacks.
_NOTCHES = (
    "Gearbox: fatigue of the shafts and notch effects (steps, keyways, fits; DIN 743) are not evaluated; multiply the "
    "nominal stresses of shaft-deflection by your stress concentration factors (bending alternates with the rotation)."
)


_SHEET = Sheet(
    answer=Answer(
        sentences, figure="gearbox",
        covers=("misalignment", "shaft-deflection", "load-distribution", "rating", "transmission-error"),
        tables=("gearbox_changes", "gearbox_meshes", "gearbox_bearings", "gearbox_shafts"),
    ),
    name=lambda _asked: "",
    tables=(
        Rows(
            "gearbox_meshes", "Meshes of the gearbox, the weakest first",
            (
                "pair",
                *map(_known, ("margin", "contact", "contact_required", "bending", "bending_required", "rated")),
                _with_error("face_load_factor", "face_load_factor_error"), "over_face",
                *(_by_cause(n, cause) for n, cause in enumerate(CAUSES)), _with_error("te_peak_to_peak", "te_error"),
            ),
            of="meshes",
        ),
        Rows(
            "gearbox_bearings", "Bearings of the gearbox, the weakest first",
            (
                "bearing", "shaft", "radial", "axial",
                *(
                    _known(key, "bearings")
                    for key in ("life", "duration", "other", "margin", "static", "tilt", "permissible")
                ),
                Cell("larger", lambda seen: _changes_to(seen.data.bearings)),
            ),
            of="bearings", when="bearings",
        ),
        Rows(
            "gearbox_shafts", "Shafts of the gearbox, the weakest first",
            (
                "shaft", "margin", "safety", "required", "strength", "equivalent", "bending", "torsion", "axial", "at",
                "diameter",
            ),
            of="checked",
        ),
        Rows(
            "gearbox_changes", "What to change first",
            (
                "part", "finding",
                Cell("remedy", lambda seen: [one.told or one.remedy for one in seen.data.changes]),
            ),
            of="changes", when="changes",
        ),
    ),
    figures=(lambda seen: (DeferredFigure("gearbox", "Gearbox under load", lambda: scheme(seen.data)),),),
    remarks=(
        lambda seen: [f"Gearbox: {one}." for one in seen.asked.why],
        lambda seen: _said_of_flanks(seen.data.meshes),
        lambda _seen: [neglecting(_NOTCHES)],
        lambda seen: [_ESTIMATED] if any(one.lead is not None for one in seen.data.meshes) else [],
        lambda seen: said_of_checks(seen.asked.checks, seen.data.shafts.nominal.bent),
        lambda seen: seen.data.said_of_lives(),
        lambda seen: overlooked(seen.asked.checks.bearings, seen.asked.lives, seen.data.shafts.nominal.bent),
    ),
)  # fmt: skip


GEARBOX = Stage(
    subjects=shafts_of,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    needs=_needs,
    check=_check,
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    forecast=lambda _scene, _name: forecasts.constant(0.01),
)
