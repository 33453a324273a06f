"""What a case neglects: the size of each effect that is off, compared with the case's tolerance, and the remedy."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import AT_REST, CORNER_CONTACT, EFFECTS
from fegear.base.notes import neglecting
from fegear.base.printed import figures, percent
from fegear.base.tally import note
from fegear.case.effects import EffectsPart
from fegear.design.tip_relief.tip_tolerance import NOTHING
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from fegear.base.solution_cache import SolutionCache
    from fegear.contact.loaded_teeth import Answer, Change, Neglected
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.plane.engagement import Engagement
    from fegear.design.relief_design import DesignTask
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.geometry.relief import Shape


#: Unit of an answer, its factor, and what a share is of.
_SAID: dict[Answer, tuple[str, float, str]] = {
    "transmission error": (" um", 1e6, "its mean"),
    "load on a tooth pair": (" N", 1.0, "the load"),
    "root tension": (" MPa", 1e-6, "its maximum"),
    "mean transmission error": (" um", 1e6, "it"),
    "K_Hbeta": ("", 1.0, "it"),
}


#: Tip reliefs that leave so little more than the best are as good.
_EQUALLY_GOOD = 0.01
#: Contact ratios nearer to a whole number than this leave transmission error a spike of almost no width.
_NEAR_WHOLE = 1e-3


def remark(who: str, effects: EffectsPart, tolerance: float, effect: str, sizes: Iterable[str]) -> str:
    """Say which effect is off, how much it would change, for which tolerance, and what to write to have it."""
    now = 'is "linear"' if effects.is_on(effect) else "is off"
    return neglecting(
        f"{who}: {effect} {now}; including it changes {', '.join(sizes)} (tolerance {100.0 * tolerance:g} %). "
        f"{remedy(effects, effect)}"
    )


def remedy(effects: EffectsPart, effect: str) -> str:
    """The line that switches an effect on, and what has to go for it."""
    line = f"Set {effect} = {effects.example(effect)} under [effects]"
    in_the_way = [other for other in EFFECTS[effect].excludes if effects.is_on(other)]
    if in_the_way:
        return f"{line} and switch {in_the_way[0]} off: {in_the_way[0]} requires uncoupled tooth pairs."
    return f"{line}."


def including(effects: Iterable[str], part: EffectsPart) -> str:
    """What switches several effects on, a clause; empty for none."""
    lines = [f"{effect} = {part.example(effect)}" for effect in effects]
    return f"set {' and '.join(lines)} under [effects]" if lines else ""


def neglected_remarks(
    name: str, found: Neglected, effects: EffectsPart, tolerance: float, nominal: float,
    load_words: Callable[[float], str] | None = None,
) -> tuple[str, ...]:  # fmt: skip
    """Effects of load sharing that are off and would change the wanted answers by more than the tolerance.

    `load_words` says what a load is called; by default by the force.
    """
    said: list[str] = [
        neglecting(f"Pair {name}: {effect} is off; its influence cannot be estimated from the data specified: {error}")
        for effect, error in found.wrong.items()
    ]
    for effect, parts in found.changes.items():
        sizes = [_size(change, nominal, load_words) for change in parts if change.share > tolerance]
        if sizes:
            said.append(remark(f"Pair {name}", effects, tolerance, effect, sizes))
    return tuple(said)


def whole_ratio_remarks(name: str, engagement: Engagement, effects: EffectsPart) -> tuple[str, ...]:
    """What a contact ratio next to a whole number does to the peak to peak where tip corners do not touch."""
    ratio = engagement.pair.contact_ratio
    off = ratio - round(ratio)
    if engagement.corner_contact or abs(off) >= _NEAR_WHOLE:
        return ()
    said = neglecting(
        f"Pair {name}: the contact ratio is {ratio:.9g}, within {_NEAR_WHOLE:g} of an integer, and corner_contact is "
        f"off: one tooth pair {'more' if off >= 0.0 else 'less'} is in contact over only "
        f"{abs(off) * engagement.pair.base_pitch * 1e6:.3g} um of the base pitch, which gives a very narrow spike in "
        "transmission error and stiffness. The peak-to-peak value is discontinuous at an integer contact ratio, and "
        f"so is any optimum based on it. {remedy(effects, CORNER_CONTACT.name)} With it both are continuous."
    )
    return (said,)


def neglected_in_design(
    spec: PairSpec,
    designed: Engagement,
    ground: tuple[Shape, TipReliefPair] | None,
    task: DesignTask,
    tolerance: float,
    cache: SolutionCache | None = None,
) -> dict[str, tuple[str, ...]]:
    """What an effect that is off does to a designed relief, and to what it leaves, where that exceeds the tolerance.

    Where tip corners may touch, other tip reliefs may be the best to grind, in another valley of the search: `ground`,
    the best shape and what was found of it, is searched for again.

    Returns
    -------
    dict of str to tuple of str
        By the effect, its sizes in words.
    """
    from fegear.contact.plane.neglected_effects import COUNTED, changes, effects_off, with_effect
    from fegear.design.excitation_relief import MinimumExcitationRelief

    load = task.load
    found: dict[str, tuple[str, ...]] = {}
    for effect in effects_off(spec, AT_REST):
        other = with_effect(spec, designed, effect)
        if other is None:
            continue
        note(COUNTED)
        sizes = []
        if effect == CORNER_CONTACT.name:
            change = changes(designed, {effect: other}, [load], ("transmission error",))[effect][0]
            sizes = [_size(change, load)] if change.share > tolerance else []
        for member in MEMBERS if effect != CORNER_CONTACT.name else ():
            relief = designed.driver_relief if member == "driver" else designed.driven_relief
            if isinstance(relief, MinimumExcitationRelief):
                x = np.linspace(designed.pair.x_start, designed.pair.x_end, 25)
                now, then = relief.at(x), replace(relief, compliance=other.compliance).at(x)
                at, largest = int(np.argmax(np.abs(then - now))), float(now.max())
                size = float(then[at] - now[at])
                if abs(size) > tolerance * largest:
                    share = percent(abs(size) / largest)
                    where = f"{share} of its maximum, at x = {x[at] * 1e3:.4g} mm"
                    sizes.append(f"the {member}'s relief by {figures(size * 1e6, signed=True)} um ({where})")
        if effect == CORNER_CONTACT.name and ground is not None:
            shape, best = ground
            other_best = task.grind_on(other, shape, cache)
            if abs(other_best.objective - best.objective) > max(tolerance, _EQUALLY_GOOD) * best.objective:
                to_grind = f"{_to_grind(other_best)}, instead of {_to_grind(best)}"
                sizes.append(f"the best {shape} tip relief to grind: {to_grind}")
        if sizes:
            found[effect] = tuple(sizes)
    return found


def _to_grind(found: TipReliefPair) -> str:
    """Amounts, starts and what is left, in words."""
    each = [
        f"{relief.amount * 1e6:.3g} um from {np.degrees(relief.start):.4g} deg on the {member}"
        for member, relief in (("driver", found.driver), ("driven gear", found.driven))
        if relief.amount > NOTHING
    ]
    return f"{' and '.join(each) or 'none'}, remaining transmission error {found.objective * 1e6:.3g} um"


def design_remarks(
    name: str, found: Mapping[str, tuple[str, ...]], effects: EffectsPart, tolerance: float
) -> tuple[str, ...]:
    """Sentences on what `neglected_in_design` found."""
    return tuple(
        remark(f"Pair {name}, designed relief", effects, tolerance, effect, sizes) for effect, sizes in found.items()
    )


def _size(change: Change, nominal: float, load_words: Callable[[float], str] | None = None) -> str:
    unit, factor, scale = _SAID[change.answer]
    what = {"root tension": "the maximum root stress (tension side)", "K_Hbeta": "K_Hbeta"}.get(
        change.answer, f"the {change.answer}"
    )
    where = "" if np.isnan(change.x) else f", at x = {change.x * 1e3:.4g} mm"
    said = load_words(change.load) if load_words else f"{figures(change.load, 5)} N"
    load = "" if change.load == nominal else f" under {said}"
    size = figures(change.size * factor, signed=True)
    return f"{what} by {size}{unit} ({percent(change.share)} of {scale}{where}{load})"
