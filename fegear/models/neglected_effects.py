"""What a scene leaves out: the estimated size of each effect that is off, the case's tolerance, and the remedy."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import InputError
from fegear.models.loaded_pair import MEMBERS, gear_name, relieved, spaced, wants_delta
from fegear.tally import tallying

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fegear.case.reading import Scene
    from fegear.contact import Engagement
    from fegear.contact.left_out import Answer, Change
    from fegear.models.loaded_pair import LoadedPair

_UNITS = {"transmission error": ("um", 1e6), "load on a tooth pair": ("N", 1.0), "root tension": ("MPa", 1e-6)}
_SCALES = {"transmission error": "its mean", "load on a tooth pair": "the load", "root tension": "its largest value"}


#: What the results that load a pair stand on; those of the train stand on its transmission error.
_ANSWERS: dict[str, Answer] = {
    "load-sharing": "load on a tooth pair",
    "root-stress-history": "root tension",
    **dict.fromkeys(
        (
            "transmission-error", "relief-chart", "gear-train", "natural-modes", "campbell", "dynamic-increments",
            "mesh-force-spectrum", "tooth-force", "dynamic-root-stress", "dynamic-factor", "design-chart",
        ),
        "transmission error",
    ),
}  # fmt: skip
#: The effects of load sharing, in the order in which they are told.
LOAD_SHARING = ("corner_contact", "neighbour_coupling", "hertz", "relief", "spacing_errors")


def percent(share: float) -> str:
    """A share with two or three figures."""
    return f"{100.0 * share:.{0 if share >= 0.1 else 1 if share >= 0.01 else 2}f} %"


def remark(who: str, scene: Scene, effect: str, sizes: Iterable[str]) -> str:
    """Say which effect is off, how much it would change, beside what tolerance, and what to write to have it."""
    now = 'is "linear"' if scene.case.effects.is_on(effect) else "is off"
    return (
        f"{who}: {effect} {now}; it would change {', '.join(sizes)}. "
        f"The tolerance is {scene.case.accuracy.tolerance:.2g}. {remedy(scene, effect)}"
    )


def remedy(scene: Scene, effect: str) -> str:
    """The line that switches an effect on, and what has to go for it."""
    effects = scene.case.effects
    line = f"Write {effect} = {effects.example(effect)} under [effects]"
    if effect in ("corner_contact", "neighbour_coupling") and effects.friction:
        return f"{line}, without friction, which needs tooth pairs that stand alone."
    return f"{line}."


def wanted_answers(scene: Scene) -> tuple[Answer, ...]:
    """What the wanted results tell of a pair as it is: not what a designed relief will make of it."""
    asked = dict.fromkeys(_ANSWERS[result] for result in scene.case.results if result in _ANSWERS)
    return tuple(asked)


def told_loads(scene: Scene, pair: LoadedPair) -> tuple[float, ...]:
    """Smallest, nominal and largest load, where the results are for all of them."""
    for_all = {"load-sharing", "transmission-error", "root-stress-history", "relief", "relief-chart"}
    if not for_all & set(scene.case.results):
        return (pair.nominal,)
    return tuple(sorted({pair.loads[0], pair.nominal, pair.loads[-1]}))


def with_effect(scene: Scene, name: str, engagement: Engagement, effect: str) -> Engagement | None:
    """The engagement with one effect more; None where there is nothing that it could change."""
    compliance = engagement.compliance
    sources = (compliance.driver, compliance.driven)
    parts = [scene.case.gear[gear_name(scene, name, member)] for member in MEMBERS]
    if effect == "relief":
        return relieved(scene, name, engagement) if any(part.relief for part in parts) else None
    if effect == "corner_contact":
        other = replace(engagement, corner_contact=True)
        changes_something = any(corner.exists for corner in other.meshing.corners)
    elif effect == "neighbour_coupling":
        other = replace(engagement, compliance=replace(compliance, coupling=True))
        changes_something = any(source.reach > 0 for source in sources)
    elif effect == "hertz":
        other = replace(engagement, compliance=replace(compliance, hertz="load-dependent"))
        changes_something = any(source.log_slope > 0.0 or source.power > 0.0 for source in sources)
    else:
        changes_something = any(part.spacing_errors for part in parts)
        other = spaced(scene, name, engagement) if changes_something else engagement
    if not changes_something:
        return None
    # An amount of relief that counts in deflections changes with them.
    again = scene.case.effects.relief and any(wants_delta(part.relief) for part in parts)
    return relieved(scene, name, other) if again else other


def pair_changes(
    scene: Scene, pair: LoadedPair, loads: Sequence[float] | None = None
) -> tuple[dict[str, tuple[Change, ...]], tuple[str, ...]]:
    """What each effect of load sharing that the scene leaves out would change, and those that cannot be had.

    Parameters
    ----------
    scene : Scene
    pair : LoadedPair
    loads : sequence of float, optional
        [N]; by default the smallest, the nominal and the largest of the case.
    """
    from fegear.contact.left_out import changes

    effects, e, answers = scene.case.effects, pair.engagement, wanted_answers(scene)
    if not answers:
        return {}, ()
    off = [effect for effect in LOAD_SHARING if not effects.is_on(effect)]
    if effects.hertz == "linear":
        off.append("hertz")
    others: dict[str, Engagement] = {}
    wrong: list[str] = []
    for effect in off:
        try:
            other = with_effect(scene, pair.name, e, effect)
        except InputError as error:  # data that nothing uses may be wrong: the run goes on without its size
            wrong.append(f"Pair {pair.name}: {effect} is off, and could not be had as it is given: {error}")
            continue
        if other is not None:
            others[effect] = other
    if not others:
        return {}, tuple(wrong)
    cycle = _uneven(others["spacing_errors"]) if "spacing_errors" in others else 0
    found = changes(e, others, loads or told_loads(scene, pair), answers, cycle)
    return found, tuple(wrong)


def pair_remarks(scene: Scene, pair: LoadedPair) -> tuple[str, ...]:
    """Effects of load sharing that are left out and would change the wanted answers by more than the tolerance."""
    with tallying():  # what the estimate runs is no part of the scene's own work
        found, wrong = pair_changes(scene, pair)
    told = list(wrong)
    for effect, parts in found.items():
        sizes = [_size(change, pair.nominal) for change in parts if change.share > scene.case.accuracy.tolerance]
        if sizes:
            told.append(remark(f"Pair {pair.name}", scene, effect, sizes))
    return tuple(told)


def design_remarks(scene: Scene, name: str, designed: Engagement, load: float) -> tuple[str, ...]:
    """The same for a designed relief: what an effect that is off does to the relief, and to what it leaves."""
    with tallying():
        return _design_remarks(scene, name, designed, load)


def _design_remarks(scene: Scene, name: str, designed: Engagement, load: float) -> tuple[str, ...]:
    from fegear.contact.left_out import changes
    from fegear.design import MinimumExcitationRelief

    effects, tolerance = scene.case.effects, scene.case.accuracy.tolerance
    told = []
    off = [effect for effect in ("corner_contact", "neighbour_coupling", "hertz") if not effects.is_on(effect)]
    for effect in [*off, *(["hertz"] if effects.hertz == "linear" else [])]:
        other = with_effect(scene, name, designed, effect)
        if other is None:
            continue
        sizes = []
        if effect == "corner_contact":
            change = changes(designed, {effect: other}, [load], ("transmission error",))[effect][0]
            sizes = [_size(change, load)] if change.share > tolerance else []
        for member in MEMBERS if effect != "corner_contact" else ():
            relief = designed.driver_relief if member == "driver" else designed.driven_relief
            if isinstance(relief, MinimumExcitationRelief):
                x = np.linspace(designed.pair.x_start, designed.pair.x_end, 25)
                now, then = relief.at(x), replace(relief, compliance=other.compliance).at(x)
                at, largest = int(np.argmax(np.abs(then - now))), float(now.max())
                size = float(then[at] - now[at])
                if abs(size) > tolerance * largest:
                    share = percent(abs(size) / largest)
                    where = f"{share} of its largest value, at x = {x[at] * 1e3:.4g} mm"
                    sizes.append(f"the {member}'s relief by {size * 1e6:+.3g} um ({where})")
        if sizes:
            told.append(remark(f"Pair {name}, designed relief", scene, effect, sizes))
    return tuple(told)


def _size(change: Change, nominal: float) -> str:
    unit, factor = _UNITS[change.answer]
    largest = "largest root tension" if change.answer == "root tension" else change.answer
    where = "" if np.isnan(change.x) else f", at x = {change.x * 1e3:.4g} mm"
    load = "" if change.load == nominal else f" under {change.load:.5g} N"
    return (
        f"the {largest} by {change.size * factor:+.3g} {unit} "
        f"({percent(change.share)} of {_SCALES[change.answer]}{where}{load})"
    )


def _uneven(engagement: Engagement) -> int:
    """The base pitch in which the pair that comes into contact has the largest spacing error."""
    sizes = [errors.size for errors in (engagement.driver_spacing, engagement.driven_spacing) if errors.size]
    cycles = np.arange(max(sizes))
    total = np.zeros(cycles.size)
    for errors in (engagement.driver_spacing, engagement.driven_spacing):
        if errors.size:
            total += errors[cycles % errors.size]
    return int(np.argmax(np.abs(total - np.median(total))))
