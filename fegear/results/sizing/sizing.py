"""Stage ``sizing``: from a requirement to a design.

In steps: all variants by formulas (limits, ISO 6336), the transmission error of all feasible ones by an atlas of solved
gears, or of some by coarse finite elements (helical ones in the order of thin slices), the Pareto front, the best
verified by finite elements.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.atlas.shipped import SHIPPED
from fegear.base.errors import InputError
from fegear.base.extras import absent
from fegear.base.notes import neglecting
from fegear.design.sizing.by_atlas import AtlasDuty, may_hold
from fegear.design.sizing.feasible import BARE, BY_FE, RELIEVED, ROOT, costs_of, sieve
from fegear.design.sizing.front import pareto_front
from fegear.design.sizing.limits import masses
from fegear.design.sizing.rated import safeties
from fegear.design.sizing.space import variant_of
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.sizing.basis import (
    duty_of,
    limits_of,
    present_pair,
    requirement_of,
    said_of_present,
    sizing_of,
    space_of,
)
from fegear.results.sizing.by_fe import FromFE, by_finite_elements
from fegear.results.sizing.estimated import Estimated, estimated, of_one, screened_rows, shown_rows
from fegear.results.sizing.placed import in_order, placed_present, with_shown
from fegear.results.sizing.sizing_data import Excluded, SizedVariant, SizingData
from fegear.results.sizing.sizing_inputs import SizingInputs
from fegear.results.sizing.sizing_sheet import SIZING_SHEET

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.sizing import SizingPart
    from fegear.design.sizing.feasible import Lives
    from fegear.design.sizing.rated import SizingDuty
    from fegear.design.sizing.space import SizingSpace, Variant
    from fegear.engine.progress import Progress
    from fegear.geometry.many_pairs import ManyGearPairs

#: Shares of the time until all variants are enumerated, looked up in the atlas, and estimated by finite elements.
_SIEVED, _LOOKED_UP, _SCREENED = 0.1, 0.5, 0.7

#: Poisson's ratio of steel, for forecasts; seconds of a look-up of half the variants, of one with root stress, of a
#: search for a relief, and of thin slices.
_POISSON, _LOOK_UP, _ROOT_STRESS, _SEARCH, _SLICES = 0.3, 1.5e-4, 3e-4, 8e-3, 1e-4


def _inputs(scene: Scene, _subject: str) -> SizingInputs:
    part = sizing_of(scene)
    asked = requirement_of(part)
    duty, said = duty_of(part, asked, scene.folder)
    limits, space = limits_of(part, duty.material.density), space_of(part)
    said = (*said_of_present(part), *said)
    if BY_FE & set(part.criteria) and absent("motion") and _asks(space, duty.material.poisson_ratio):
        said = (neglecting("Sizing: atlas of solved gears not used (pip install 'fegear[motion]')."), *said)
    if len(part.tolerances.states) > 1 and not any(space.betas):
        said = (neglecting("Sizing: tolerances apply to helical variants only; all variants are spur."), *said)
    return SizingInputs(
        part, space, limits, duty, asked, _atlas_duty(part, space, duty), str(Path(scene.folder).absolute()), said
    )


def _asks(space: SizingSpace, poisson_ratio: float) -> bool:
    """Whether an atlas says anything of a variant, as a spur pair or by slices."""
    return may_hold(space, poisson_ratio) or may_hold(space, poisson_ratio, helical=True)


def _atlas_duty(part: SizingPart, space: SizingSpace, duty: SizingDuty) -> AtlasDuty | None:
    """What variants are looked up for; arrays need numba."""
    material = duty.material
    wanted = BY_FE & set(part.criteria) and part.estimated > 0
    if not wanted or not _asks(space, material.poisson_ratio) or absent("motion"):
        return None
    torques = (duty.pinion_torque,) if part.torques is None else tuple(part.torques.in_order.tolist())
    root = duty.pinion_torque if ROOT in part.criteria else 0.0
    return AtlasDuty(torques, material.young_modulus, material.poisson_ratio, root)


def _check(scene: Scene, _subject: str) -> None:
    part = sizing_of(scene)
    space_of(part).refuse_none_or_too_many()
    if RELIEVED in part.criteria and (any(part.chosen_helix_angles) or _inputs(scene, "").atlas is None):
        raise InputError(
            "sizing.criteria", f'"{RELIEVED}"',
            f"requires spur gears of steel, 20 deg, by a rack with an atlas (ISO 53 {', '.join(SHIPPED)}), and numba",
            f'set criteria = ["{BARE}", ...] and design the relief of a variant by fegear apply --variant',
        )  # fmt: skip


def _compute(asked: SizingInputs, _upstream: Upstream, work: Work) -> SizingData:
    part, space = asked.part, asked.space
    share = _SIEVED if asked.with_fe or part.verified_count else 1.0
    lives = sieve(space, asked.limits, asked.duty, asked.by_formulas, _span(work, 0.0, share))
    known = estimated(
        space, lives, asked.criteria, asked.atlas, (part.estimated, part.relieved), work,
        _span(work, _SIEVED, _LOOKED_UP),
    )  # fmt: skip
    chosen = _chosen(asked, lives, known)
    own = None if part.present is None else _present(asked)
    chosen, own = _screened(asked, chosen, own, work)
    chosen = in_order(asked.criteria, chosen)
    filled = with_shown(known.costs, chosen, lives) if chosen else known.costs
    on_front = pareto_front(filled[np.isfinite(filled).all(axis=1)]).size
    failed = [(one.number, one.estimate.reason) for one in chosen if one.estimate and one.estimate.reason]
    best = [one for one in chosen if one.place][: part.verified_count]
    if best:
        everyone = [*best, *([own] if own is not None else [])]
        checked = _verified(asked, everyone, work)
        failed += [(one.number, by.reason) for one in checked for by in (one.verified, one.verified_relieved)
                   if by is not None and by.reason]  # fmt: skip
        by_number = {one.number: one for one in checked}
        chosen = [by_number.get(one.number, one) for one in chosen]
        own = None if own is None else by_number[0]
        if asked.with_fe:
            chosen = in_order(asked.criteria, [replace(one, costs=_costs(asked, one)) for one in chosen])
            own = None if own is None else replace(own, costs=_costs(asked, own))
    reasons = tuple(Excluded(words, n) for words, n in lives.reasons.items())
    present = None
    if own is not None:
        present = placed_present(asked, own, chosen, lives, with_shown(filled, chosen, lives))
    looked_up = int(np.isfinite(known.bare.te).sum())
    by_fe = sum(one.estimated_by == "FE" and math.isfinite(one.te_estimated) for one in chosen)
    return SizingData(
        lives.count, lives.numbers.size, on_front, looked_up + by_fe, looked_up > 0, int(known.rows.size), reasons,
        tuple(chosen), present, tuple(failed),
    )  # fmt: skip


def _span(work: Work, low: float, high: float) -> Progress:
    return lambda part: work.progress(low + (high - low) * part)


def _chosen(asked: SizingInputs, lives: Lives, known: Estimated) -> list[SizedVariant]:
    """Variants that are shown: those on the front, others to compare, and those that finite elements estimate."""
    part = asked.part
    shown = shown_rows(known.costs, known.known, max(part.verified_count, 1), compared=asked.with_fe)
    if asked.with_fe and not asked.relieved and part.screened:
        shown = np.concatenate([shown, screened_rows(lives, known, asked.criteria, part.screened)])
    return [_one_of_lives(asked, lives, known, int(row)) for row in np.unique(shown)]


def _one_of_lives(asked: SizingInputs, lives: Lives, known: Estimated, row: int) -> SizedVariant:
    number = int(lives.numbers[row])
    one = _sized(asked, number, asked.space.pairs(np.array([number])))
    one = replace(
        one, estimate=known.estimate(row), relief=known.relief(row), on_bounds=(*one.on_bounds, *known.at_limit(row))
    )
    return replace(one, costs=_costs(asked, one)) if asked.with_fe else one


def _present(asked: SizingInputs) -> SizedVariant:
    """The present design, with what the atlas says of it."""
    pairs = present_pair(asked.part, asked.part.present)  # type: ignore[arg-type]  # where there is a present design
    one = _sized(asked, None, pairs)
    if asked.atlas is None:
        return one
    estimate, relief = of_one(pairs, asked.atlas, relieved=asked.relieved)
    one = replace(one, estimate=estimate, relief=relief)
    return replace(one, costs=_costs(asked, one))


def _screened(
    asked: SizingInputs, chosen: list[SizedVariant], own: SizedVariant | None, work: Work
) -> tuple[list[SizedVariant], SizedVariant | None]:
    """Estimates by coarse finite elements of those that no atlas contains."""
    if not asked.with_fe or asked.relieved:
        return chosen, own
    everyone = [*chosen, *([own] if own is not None else [])]
    unknown = [one for one in everyone if one.estimate is None]
    found = _fe(asked, [one.variant for one in unknown], work, (_LOOKED_UP, _SCREENED)) if unknown else ()
    by_number = {one.number: replace(one, estimate=by) for one, by in zip(unknown, found, strict=True)}
    everyone = [by_number.get(one.number, one) for one in everyone]
    everyone = [replace(one, costs=_costs(asked, one)) for one in everyone]
    return everyone[: len(chosen)], everyone[-1] if own is not None else None


def _verified(asked: SizingInputs, variants: Sequence[SizedVariant], work: Work) -> list[SizedVariant]:
    """Variants with what finite elements say of them, unmodified and with their reliefs, as the criteria want."""
    width = (asked.part.verified_width, asked.part.tolerance)
    bare = [one.variant for one in variants] if asked.bare else []
    reliefs = [one for one in variants if one.relief is not None] if asked.relieved else []
    jobs = [*bare, *(one.relieved_variant for one in reliefs)]
    found = _fe(asked, jobs, work, (_SCREENED, 1.0), width)
    relieved = {one.number: by for one, by in zip(reliefs, found[len(bare) :], strict=True)}
    plain: Sequence[FromFE | None] = found[: len(bare)] if bare else [None] * len(variants)
    return [
        replace(one, verified=by, verified_relieved=relieved.get(one.number))
        for one, by in zip(variants, plain, strict=True)
    ]


def _sized(asked: SizingInputs, number: int | None, pairs: ManyGearPairs) -> SizedVariant:
    """The numbers of a variant by formulas; the present design has none and is shown as 0, others count from 1."""
    one = variant_of(pairs, 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        safe = safeties(pairs, asked.duty)
        margin = safe.margin(asked.duty.required)
        sliding = float(pairs.specific_sliding.min())
        costs = _formula_costs(asked, pairs, margin)
    return SizedVariant(
        0 if number is None else number + 1, 0, *one.teeth, one.module, one.helix_angle, one.pressure_angle,
        *one.profile_shift, one.addendum, one.centre_distance, one.face_width, *one.tip_diameter,
        float(pairs.contact_ratio[0]), float(pairs.overlap_ratio[0]),
        float(masses(pairs, asked.duty.material.density)[0]), float(pairs.tooth_loss_factor[0]), sliding,
        float(safe.contact.min()), float(safe.bending.min()), float(margin[0]),
        variant=one, costs=costs, on_bounds=() if number is None else asked.space.on_bounds(number),
    )  # fmt: skip


def _formula_costs(asked: SizingInputs, pairs: ManyGearPairs, margin: Array) -> tuple[float, ...]:
    names = asked.by_formulas
    found = dict(zip(names, costs_of(names, pairs, margin, asked.duty.material.density)[0].tolist(), strict=True))
    if not asked.with_fe:
        return tuple(found.values())
    return tuple(found.get(name, math.nan) for name in asked.criteria)


def _costs(asked: SizingInputs, one: SizedVariant) -> tuple[float, ...]:
    """Costs with what the atlas or finite elements give."""
    by_fe = {BARE: one.te, RELIEVED: one.te_relieved, ROOT: one.root_stress}
    return tuple(by_fe.get(name, cost) for name, cost in zip(asked.criteria, one.costs, strict=True))


def _fe(
    asked: SizingInputs, variants: Sequence[Variant], work: Work, span: tuple[float, float],
    verified: tuple[str, float] | None = None,
) -> tuple[FromFE, ...]:  # fmt: skip
    return by_finite_elements(
        asked.asked, variants, work, asked.folder, _span(work, *span), verified=verified,
        states=asked.part.tolerances.states,
    )  # fmt: skip


def _forecast(scene: Scene, _subject: str) -> Forecast:
    part, space = sizing_of(scene), space_of(sizing_of(scene))
    spur = all(beta == 0.0 for beta in part.chosen_helix_angles)
    wanted = BY_FE & set(part.criteria)
    looked_up = 0
    if wanted and part.estimated and may_hold(space, _POISSON) and not absent("motion"):
        looked_up = min(space.count, part.estimated)
    sliced = 0
    if BARE in wanted and part.estimated and may_hold(space, _POISSON, helical=True) and not absent("motion"):
        sliced = min(space.count, part.estimated)
    screened = part.screened if wanted and RELIEVED not in wanted else 0
    relieved = min(looked_up, part.relieved) if RELIEVED in part.criteria else 0
    slow = 4.0 if part.verified_width == "slices" else 40.0
    loads = 1 if part.torques is None else part.torques.in_order.size
    states = len(part.tolerances.states)
    seconds = forecasts.LIBRARIES + 3e-6 * space.count + screened * (0.6 if spur else 4.0 * states)
    seconds += (
        (_ROOT_STRESS * looked_up if ROOT in part.criteria else 0.0)
        + loads * (_LOOK_UP * looked_up + _SEARCH * relieved + _SLICES * sliced)
        + part.verified_count * (2.0 if spur else slow * states)
    )
    return Forecast(
        {"variants": space.count, "by_atlas": looked_up, "screened": screened, "verified": part.verified_count}, seconds
    )


SIZING = Stage(
    subjects=lambda scene: ("",) if scene.case.sizing is not None else (),
    inputs=_inputs,
    compute=_compute,
    present=SIZING_SHEET.present,
    check=_check,
    cites=citing(forecasts.INVOLUTE, Citation("iso-6336-1", "limits of load: safety factors of every variant")),
    forecast=_forecast,
    in_points=True,
)
