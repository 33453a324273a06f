"""Stage ``sizing``: from a requirement to a design.

A funnel: all variants by formulas (limits, ISO 6336), their Pareto front, transmission error of some by coarse finite
elements, the front with it, the best verified by finite elements with estimated errors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.case.sizing import SizingPart
from fegear.design.sizing.front import best_by_fronts, pareto_front, rounded_costs
from fegear.design.sizing.funnel import BY_FE, LARGER_IS_BETTER, Lives, costs_of, reasons_of_rating, sieve
from fegear.design.sizing.limits import SizingLimits, broken, masses
from fegear.design.sizing.rated import SizingDuty, safeties
from fegear.design.sizing.space import SizingSpace, variant_of
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.sizing.basis import duty_of, limits_of, present_pair, requirement_of, sizing_of, space_of
from fegear.results.sizing.by_fe import FromFE, by_finite_elements
from fegear.results.sizing.sizing_data import Excluded, Placed, PresentPlaced, SizedVariant, SizingData
from fegear.results.sizing.sizing_sheet import SIZING_SHEET

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.design.sizing.space import Variant
    from fegear.engine.progress import Progress
    from fegear.geometry.many_pairs import ManyGearPairs

#: Variants that a front by formulas only shows at most.
_MOST_SHOWN = 500
#: Significant digits in which criteria differ when variants are put in order: ties are decided by the rule.
_DIGITS_OF_FE, _DIGITS = 2, 3
#: Criteria that stand in where none of the wanted ones is given by formulas.
_STAND_IN = ("mass", "safety")
#: Criterion by which variants are chosen for finite elements: transmission errors fall with the total contact ratio.
_FOR_FE = "contact-ratio"
#: Units in which criteria are read, and their size in SI.
UNITS = {"transmission-error": ("um", 1e-6), "centre-distance": ("mm", 1e-3), "module": ("mm", 1e-3)}


@dataclass(frozen=True)
class SizingInputs:
    """What a sizing depends on.

    Parameters
    ----------
    part : SizingPart
    space, limits, duty
        What may vary, limits, what every variant is rated for.
    asked : mapping
        What the cases of variants have from the requirement, numbers in SI.
    folder : str
        Where files that the case names are looked for.
    said : tuple of str
        What had to be assumed.
    """

    part: SizingPart
    space: SizingSpace
    limits: SizingLimits
    duty: SizingDuty
    asked: Mapping[str, Any]
    folder: str = field(compare=False)
    said: tuple[str, ...] = field(compare=False, default=())

    @property
    def by_formulas(self) -> tuple[str, ...]:
        """Criteria that formulas give; the contact ratio stands for the transmission error until it is known."""
        names = tuple(name for name in self.part.criteria if name not in BY_FE) or _STAND_IN
        return (*names, _FOR_FE) if self.with_fe and _FOR_FE not in names else names

    @property
    def with_fe(self) -> bool:
        """Whether a criterion is given by finite elements, and variants are asked of them."""
        return bool(BY_FE & set(self.part.criteria)) and self.part.screened > 0


def _inputs(scene: Scene, _subject: str) -> SizingInputs:
    part = sizing_of(scene)
    asked = requirement_of(part)
    duty, said = duty_of(part, asked, scene.folder)
    limits = limits_of(part, duty.material.density)
    return SizingInputs(part, space_of(part), limits, duty, asked, str(Path(scene.folder).absolute()), said)


def _check(scene: Scene, _subject: str) -> None:
    space_of(sizing_of(scene)).refuse_none_or_too_many()


def _compute(asked: SizingInputs, _upstream: Upstream, work: Work) -> SizingData:
    part, space = asked.part, asked.space
    share = 0.1 if asked.with_fe or part.verified else 1.0
    lives = sieve(space, asked.limits, asked.duty, asked.by_formulas, lambda part: work.progress(share * part))
    front = pareto_front(lives.criteria)
    if asked.with_fe:
        places = best_by_fronts(lives.criteria, part.screened)
    else:
        places = best_by_fronts(lives.criteria[front], min(front.size, _MOST_SHOWN))
        places = front[places]
    chosen = [_sized(asked, int(n), space.pairs(np.array([n]))) for n in lives.numbers[places]]
    own = None if part.present is None else _sized(asked, None, present_pair(part, part.present))
    everyone = [*chosen, *([own] if own is not None else [])]
    if asked.with_fe:
        found = _fe(asked, everyone, work, (share, 0.6))
        everyone = [replace(one, estimate=by) for one, by in zip(everyone, found, strict=True)]
        everyone = [replace(one, costs=_costs(asked, one)) for one in everyone]
    chosen, own = everyone[: len(chosen)], everyone[-1] if own is not None else None
    chosen = _in_order(asked, chosen)
    failed = [(one.number, one.estimate.reason) for one in chosen if one.estimate and one.estimate.reason]
    best = [one for one in chosen if one.place][: part.verified]
    if best:
        again = [*best, *([own] if own is not None else [])]
        checked = _fe(asked, again, work, (0.6, 1.0), (part.verified_width, part.tolerance))
        by_number = {one.number: replace(one, verified=by) for one, by in zip(again, checked, strict=True)}
        failed += [(one.number, by.reason) for one, by in zip(again, checked, strict=True) if by.reason]
        chosen = [by_number.get(one.number, one) for one in chosen]
        own = None if own is None else by_number[0]
        if asked.with_fe:
            chosen = [replace(one, costs=_costs(asked, one)) for one in chosen]
            own = None if own is None else replace(own, costs=_costs(asked, own))
            chosen = _in_order(asked, chosen)
    reasons = tuple(Excluded(words, n) for words, n in lives.reasons.items())
    present = None if own is None else _place(asked, own, chosen, lives)
    return SizingData(lives.count, lives.numbers.size, int(front.size), reasons, tuple(chosen), present, tuple(failed))


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
    return tuple(found.get(name, math.nan) for name in asked.part.criteria)


def criteria_of(asked: SizingInputs) -> tuple[str, ...]:
    """Criteria by which the variants that are shown are compared."""
    return tuple(asked.part.criteria) if asked.with_fe else asked.by_formulas


def _costs(asked: SizingInputs, one: SizedVariant) -> tuple[float, ...]:
    """Costs with what finite elements give."""
    return tuple(
        one.te if name == "transmission-error" else cost
        for name, cost in zip(asked.part.criteria, one.costs, strict=True)
    )


def _fe(
    asked: SizingInputs, variants: Sequence[SizedVariant], work: Work, span: tuple[float, float],
    verified: tuple[str, float] | None = None,
) -> tuple[FromFE, ...]:  # fmt: skip
    low, high = span
    progress: Progress = lambda part: work.progress(low + (high - low) * part)  # noqa: E731
    pairs: list[Variant] = [one.variant for one in variants]
    return by_finite_elements(asked.asked, pairs, work, asked.folder, progress, verified=verified)


def _in_order(asked: SizingInputs, chosen: Sequence[SizedVariant]) -> list[SizedVariant]:
    """The front first: by the criteria in their order, ties by mass, larger module, fewer teeth, smaller beta, x_1."""
    known = [one for one in chosen if all(map(math.isfinite, one.costs))]
    unknown = [one for one in chosen if not all(map(math.isfinite, one.costs))]
    costs = np.array([one.costs for one in known]).reshape(len(known), len(criteria_of(asked)))
    on = set(pareto_front(costs).tolist())
    digits = [_DIGITS_OF_FE if name in BY_FE else _DIGITS for name in criteria_of(asked)]
    rounded = [rounded_costs(costs[:, k], n) for k, n in enumerate(digits)]

    def key(i: int) -> tuple[float, ...]:
        one = known[i]
        rule = (one.mass, -one.module, one.teeth_1 + one.teeth_2, one.helix_angle, one.shift_1, one.number)
        return (i not in on, *(float(column[i]) for column in rounded), *rule)

    order = sorted(range(len(known)), key=key)
    found = [replace(known[i], place=k + 1 if i in on else 0) for k, i in enumerate(order)]
    return [*found, *(replace(one, place=0) for one in unknown)]


def _place(asked: SizingInputs, own: SizedVariant, chosen: Sequence[SizedVariant], lives: Lives) -> PresentPlaced:
    """The present design among the variants."""
    pairs = present_pair(asked.part, asked.part.present)  # type: ignore[arg-type]
    with np.errstate(invalid="ignore", divide="ignore"):
        rating, margin = reasons_of_rating(pairs, asked.duty)
        found = (*broken(pairs, asked.limits), *rating)
        cost = costs_of(asked.by_formulas, pairs, margin, asked.duty.material.density)[0]
    off = abs(own.teeth_2 / own.teeth_1 / asked.part.ratio - 1.0) > asked.part.ratio_tolerance + 1e-9
    reasons = (*(("ratio",) if off else ()), *(words for words, mask in found if mask[0]))
    worse = (lives.criteria <= cost).all(axis=1) & (lives.criteria < cost).any(axis=1)
    placed = []
    for k, name in enumerate(criteria_of(asked)):
        unit, size = UNITS.get(name, ("kg" if name == "mass" else "", 1.0))
        sign = -1.0 if name in LARGER_IS_BETTER else 1.0
        if name in asked.by_formulas:
            others = lives.criteria[:, asked.by_formulas.index(name)]
        else:
            others = np.array([one.costs[k] for one in chosen])
        others = others[np.isfinite(others)]
        best = sign * float(others.min()) / size if others.size else math.nan
        placed.append(
            Placed(name, sign * own.costs[k] / size, best, int((others < own.costs[k]).sum()), others.size, unit)
        )
    costs = np.array(own.costs)
    better = next(
        (one for one in chosen if (np.array(one.costs) <= costs).all() and (np.array(one.costs) < costs).any()), None
    )
    return PresentPlaced(own, reasons, tuple(placed), int(worse.sum()), better)


def _forecast(scene: Scene, _subject: str) -> Forecast:
    part = sizing_of(scene)
    space = space_of(part)
    spur = all(beta == 0.0 for beta in part.chosen_helix_angles)
    screened = part.screened if BY_FE & set(part.criteria) else 0
    slow = 4.0 if part.verified_width == "slices" else 40.0
    seconds = forecasts.LIBRARIES + 3e-6 * space.count + screened * (0.6 if spur else 4.0)
    return Forecast(
        {"variants": space.count, "screened": screened, "verified": part.verified},
        seconds + part.verified * (2.0 if spur else slow),
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
