"""Stage ``loaded-pair``: compliances, modifications and errors of a pair, for the stages that load it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from fegear.base.effects import AT_REST
from fegear.case.built.neglected_effects import whole_ratio_remarks
from fegear.case.built.pair_checks import check_plane_pair
from fegear.case.built.pair_notes import pair_notes
from fegear.case.built.pair_spec import pair_spec
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.forecasts import CLOSED_FORM_COMPLIANCES, HERTZ, PATCH, RING
from fegear.results.gear.solved_gear import needs_teeth_of, teeth_of
from fegear.results.pair.loaded_teeth import AskedOfTeeth, plane_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import Answer
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.citation import Citation


def _inputs(scene: Scene, name: str) -> AskedOfTeeth:
    spec = pair_spec(scene, name)
    return AskedOfTeeth.of(scene, spec, pair_notes(scene, spec))


def _for_readers(asked: AskedOfTeeth, readers: Sequence[Stage]) -> AskedOfTeeth:
    """The same with what the results stand on that read the pair."""
    spec = asked.spec
    answers = dict.fromkeys(cast("Answer", answer) for reader in readers for answer in reader.answers)
    if spec.compliance != "fe":  # knows no root stress: that of formulas follows the tooth's own load
        answers = dict.fromkeys("load on a tooth pair" if a == "root tension" else a for a in answers)
    every = any(reader.every_load for reader in readers if reader.answers)
    loads = (spec.loads[0], spec.nominal, spec.loads[-1]) if every else (spec.nominal,)
    return replace(asked, answers=tuple(answers), loads=tuple(sorted(set(loads))))


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    part = scene.case.pair[name]
    return needs_teeth_of(scene, part.driver, part.driven) if part.compliance.source == "fe" else ()


def _compute(asked: AskedOfTeeth, upstream: Upstream, work: Work) -> LoadedPair:
    from fegear.contact.plane.maker import load_plane

    spec = asked.spec
    solved = tuple(teeth_of(upstream, gear) for gear in spec.gears) if upstream else ()
    pair = load_plane(spec, solved, cache=work.cache, estimates=asked.estimates)
    return replace(pair, neglected=pair.neglects(asked.answers, asked.loads)) if asked.neglected else pair


def _remarks(seen: Seen) -> Iterator[str]:
    """What was assumed, and what is neglected."""
    pair, asked = seen.data, seen.asked
    yield from asked.notes
    yield from whole_ratio_remarks(seen.name, pair.engagement, asked.effects)
    yield from asked.neglected_notes(pair)


def settings(seen: Seen) -> dict[str, object]:
    """Sources, effects and loads of a pair."""
    pair, spec = seen.data, seen.asked.spec
    return {
        "compliance": "; ".join(pair.sources),
        **{effect: getattr(spec, effect) for effect in AT_REST},
        "face_width": pair.engagement.compliance.face_width,
        "nominal_load": pair.nominal,
        "loads": list(pair.loads),
    }


_SHEET = Sheet(remarks=(_remarks,), settings=settings)


#: Seconds of a loaded pair on finite elements, with the square of the pairs that share the load; by a formula.
_FE, _FORMULA = 0.05, 0.12


def forecast(scene: Scene, name: str) -> Forecast:
    """Tables over the flank, from the influence functions of both gears or from closed forms."""
    source = scene.case.pair[name].compliance.source
    pairs = math.ceil(scene.pairs[name].contact_ratio)
    return Forecast({"compliance": source}, _FE * pairs**2 if source == "fe" else _FORMULA)


def cites(scene: Scene, name: str) -> Iterator[Citation]:
    """Where compliances and contact come from."""
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
    check=check_plane_pair,
    cites=cites,
    forecast=forecast,
)
