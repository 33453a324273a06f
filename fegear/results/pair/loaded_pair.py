"""Stage ``loaded-pair``: compliances, modifications and errors of a pair, for the stages that load it.

Stage ``odd-pair``: the same with the odd teeth of its gears.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from fegear.base.effects import AT_REST
from fegear.base.notes import neglecting
from fegear.case.built.neglected_effects import whole_ratio_remarks
from fegear.case.built.odd_teeth import check_left_contact, check_odd_gear, odd_gears_of, odd_teeth_in, reshaped_gears
from fegear.case.built.pair_checks import check_odd_teeth, check_plane_pair
from fegear.case.built.pair_notes import pair_notes
from fegear.case.built.pair_spec import pair_spec
from fegear.contact.odd_flank import OddFlank
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.forecasts import CLOSED_FORM_COMPLIANCES, HERTZ, PATCH, RING
from fegear.results.gear.odd_gear import needs_odd_solution_in
from fegear.results.gear.solved_gear import needs_solution, needs_teeth_of, teeth_of
from fegear.results.pair.loaded_teeth import AskedOfTeeth, plane_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import Answer
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.citation import Citation
    from fegear.geometry.pair import Member


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


def _settings(seen: Seen) -> dict[str, object]:
    pair, spec = seen.data, seen.asked.spec
    return {
        "compliance": "; ".join(pair.sources),
        **{effect: getattr(spec, effect) for effect in AT_REST},
        "face_width": pair.engagement.compliance.face_width,
        "nominal_load": pair.nominal,
        "loads": list(pair.loads),
    }


_SHEET = Sheet(remarks=(_remarks,), settings=_settings)


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
    check=check_plane_pair,
    cites=_cites,
    forecast=_forecast,
)


def _odd_pairs(scene: Scene) -> tuple[str, ...]:
    return tuple(name for name in plane_pairs(scene) if odd_gears_of(scene, name))


def _odd_needs(scene: Scene, name: str) -> tuple[Task, ...]:
    part, reshaped = scene.case.pair[name], reshaped_gears(scene)
    odd = tuple(gear for gear in odd_gears_of(scene, name) if gear in reshaped)
    return (
        *needs_odd_solution_in(scene, name, *odd),
        *needs_solution(*(gear for gear in (part.driver, part.driven) if gear not in odd)),
    )


def _odd_inputs(scene: Scene, name: str) -> AskedOfTeeth:
    spec, odd = pair_spec(scene, name), odd_gears_of(scene, name)
    known = {gear: odd_teeth_in(scene, name, gear) for gear in odd}
    driver, driven = (
        replace(flank, odd=known[flank.gear].flanks, profiles=known[flank.gear].profiles)
        if flank.gear in odd
        else flank
        for flank in spec.both
    )
    return replace(AskedOfTeeth.of(scene, replace(spec, driver=driver, driven=driven), ()), neglected=False)


def _compute_odd(asked: AskedOfTeeth, upstream: Upstream, work: Work) -> LoadedPair:
    from fegear.contact.plane.maker import load_plane

    solved = {task.subject: one for task, one in upstream.items()}
    gears = tuple(solved[gear] for gear in asked.spec.gears)
    return load_plane(asked.spec, gears, cache=work.cache, estimates=asked.estimates)


def _check_odd(scene: Scene, name: str) -> None:
    check_odd_teeth(scene, name)
    check_plane_pair(scene, name)
    for gear in odd_gears_of(scene, name):
        check_odd_gear(scene, gear)
    check_left_contact(scene, name)
    if scene.case.effects.relief:
        for gear in odd_gears_of(scene, name):
            member: Member = "driver" if gear == scene.case.pair[name].driver else "driven"
            for _, profile in odd_teeth_in(scene, name, gear).profiles:
                profile.built_on(OddFlank(), scene.pairs[name], member, 0.0)  # Welbourn's Delta is not known yet


def _odd_remarks(seen: Seen) -> Iterator[str]:
    """Profiles of single teeth that do not count."""
    spec = seen.asked.spec
    for flank in spec.both if not spec.relief else ():
        if flank.profiles:
            yield neglecting(f"Gear {flank.gear}: profiles of single teeth ignored because effects.relief is off.")


#: A pair of which a gear has odd teeth: results over a revolution read it, all others the ordinary one.
ODD_PAIR = Stage(
    subjects=_odd_pairs,
    needs=_odd_needs,
    inputs=_odd_inputs,
    compute=_compute_odd,
    present=Sheet(remarks=(_odd_remarks,), settings=_settings).present,
    check=_check_odd,
    cites=_cites,
    forecast=_forecast,
)
