"""Stage ``loaded-pair``: compliances, modifications and errors of a pair, for the stages that load it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, cast

from fegear.case.built.loaded_pair import (
    build_loaded_pair,
    check_pair,
    compliance_sources,
    engagement_at_rest,
    shifted_sources,
)
from fegear.case.built.neglected_effects import neglected_effects, neglected_remarks, whole_ratio_remarks
from fegear.case.built.pair_inputs import PairInputs, pair_inputs
from fegear.case.effects import AT_REST, EffectsPart
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.forecasts import CLOSED_FORM_COMPLIANCES, HERTZ, PATCH, RING
from fegear.results.gear.solved_gear import needs_solution, solution_of
from fegear.results.pair.loaded_teeth import plane_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import Answer
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.citation import Citation
    from fegear.fem.plane.gear import GearInfluence


@dataclass(frozen=True)
class LoadedPairInputs:
    """What this stage reads.

    Parameters
    ----------
    asked : PairInputs
    tolerance : float
        That the sizes of neglected effects are compared with.
    effects : EffectsPart
        All of the case, for the remedies.
    estimates, neglected : bool
        Whether errors and neglected effects are estimated.
    answers : tuple of str
        What the results stand on that read the pair: these sizes are of it.
    loads : tuple of float
        For which they are estimated [N].
    """

    asked: PairInputs
    tolerance: float = field(compare=False)
    effects: EffectsPart = field(compare=False)
    estimates: bool = True
    neglected: bool = True
    answers: tuple[Answer, ...] = ()
    loads: tuple[float, ...] = ()


def _inputs(scene: Scene, name: str) -> LoadedPairInputs:
    asked = pair_inputs(scene, name)
    return LoadedPairInputs(
        asked, scene.case.accuracy.tolerance, scene.case.effects, scene.estimates, scene.sizes_neglected
    )


def _for_readers(inputs: LoadedPairInputs, readers: Sequence[Stage]) -> LoadedPairInputs:
    """The same with what the results stand on that read the pair."""
    asked = inputs.asked
    answers = dict.fromkeys(cast("Answer", answer) for reader in readers for answer in reader.answers)
    if asked.compliance.source != "fe":  # knows no root stress: that of formulas follows the tooth's own load
        answers = dict.fromkeys("load on a tooth pair" if a == "root tension" else a for a in answers)
    every = any(reader.every_load for reader in readers if reader.answers)
    loads = (asked.loads[0], asked.nominal, asked.loads[-1]) if every else (asked.nominal,)
    return replace(inputs, answers=tuple(answers), loads=tuple(sorted(set(loads))))


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    part = scene.case.pair[name]
    return needs_solution(part.driver, part.driven) if part.compliance.source == "fe" else ()


def _at_rest(asked: PairInputs, upstream: Upstream, work: Work) -> Engagement:
    """The pair without modifications, the same one for every load and relief: it keeps what they do not change."""
    solved = tuple(solution_of(upstream, gear) for gear in asked.gears) if upstream else ()
    return work.cache.call(_engagement, asked.at_rest, solved).value


def _engagement(asked: PairInputs, solved: tuple[GearInfluence, ...]) -> Engagement:
    return engagement_at_rest(asked, compliance_sources(asked, dict(zip(asked.gears, solved, strict=False))))


def _compute(inputs: LoadedPairInputs, upstream: Upstream, work: Work) -> LoadedPair:
    asked = inputs.asked
    at_rest = _at_rest(asked, upstream, work)
    shifted = shifted_sources(asked, (at_rest.compliance.driver, at_rest.compliance.driven)) if inputs.estimates else ()
    pair = build_loaded_pair(asked, at_rest, shifted)
    if not inputs.estimates:
        return replace(pair, exact=False)
    if not inputs.neglected:
        return pair
    return replace(pair, neglected=neglected_effects(asked, pair, inputs.answers, inputs.loads))


def _remarks(seen: Seen) -> Iterator[str]:
    """What was assumed, and what is neglected."""
    pair, inputs = seen.data, seen.asked
    yield from inputs.asked.assumed
    yield from whole_ratio_remarks(seen.name, pair.engagement, inputs.effects)
    yield from neglected_remarks(seen.name, pair.neglected, inputs.effects, inputs.tolerance, pair.nominal)


def _settings(seen: Seen) -> dict[str, object]:
    pair, effects = seen.data, seen.asked.asked.effects
    return {
        "compliance": "; ".join(pair.sources),
        **{effect: getattr(effects, effect) for effect in AT_REST},
        "face_width": pair.engagement.compliance.face_width,
        "nominal_load": pair.nominal,
        "loads": list(pair.loads),
    }


_SHEET = Sheet(name=lambda inputs: inputs.asked.name, remarks=(_remarks,), settings=_settings)


#: Seconds of a loaded pair on finite elements, with the square of the pairs that share the load; by a formula.
_FE, _FORMULA = 0.05, 0.12


def _forecast(scene: Scene, name: str) -> Forecast:
    """Tables over the flank, from the influence functions of both gears or from closed forms."""
    source = scene.case.pair[name].compliance.source
    pairs = math.ceil(scene.pairs[name].contact_ratio)
    return Forecast({"compliance": source}, _FE * pairs**2 if source == "fe" else _FORMULA)


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    source = scene.case.pair[name].compliance.source
    if source == "fe":
        yield from RING
    yield from CLOSED_FORM_COMPLIANCES.get(source, ())
    if scene.case.effects.hertz != "none":
        yield HERTZ
        yield PATCH


LOADED_PAIR = Stage(
    subjects=plane_pairs,
    needs=_needs,
    inputs=_inputs,
    for_readers=_for_readers,
    compute=_compute,
    present=_SHEET.present,
    check=check_pair,
    cites=_cites,
    forecast=_forecast,
)
