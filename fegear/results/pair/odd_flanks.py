"""Stage ``odd-flanks``: a pair of solid gears, with their odd teeth, ready to be followed over a revolution."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

from fegear.base.notes import neglecting
from fegear.case.built.members import gear_name
from fegear.case.built.odd_gears import odd_gears_in, reshaped_solid_gears
from fegear.case.built.odd_solid_teeth import check_odd_wide_pair
from fegear.case.built.odd_teeth import odd_teeth_of
from fegear.case.built.pair_checks import check_odd_teeth, check_wide_pair
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.shafts import on_shafts
from fegear.contact.odd_flank import OddFlank
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results.gear.odd_solid_gear import needs_odd_solid, odd_solid_of
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_flanks import SHAFTS, cites
from fegear.results.pair.loaded_teeth import AskedOfTeeth, solid_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.wide.on_shafts import LoadedShafts
    from fegear.contact.wide.over_revolution import RevolvingFlanks
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.fem.solid.odd.odd_solid_influence import OddSolidInfluence


def _reshaped(scene: Scene, name: str) -> tuple[str, ...]:
    reshaped = reshaped_solid_gears(scene)
    return tuple(gear for gear in odd_gears_in(scene, name) if gear in reshaped)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    odd = _reshaped(scene, name)
    gears = [gear_name(scene, name, member) for member in MEMBERS]
    found = (*needs_odd_solid(*odd), *needs_solid_solution(*(gear for gear in gears if gear not in odd)))
    return (*found, SHAFTS) if scene.case.effects.misalignment and on_shafts(scene, name) else found


def _inputs(scene: Scene, name: str) -> AskedOfTeeth:
    spec, odd = pair_spec(scene, name), odd_gears_in(scene, name)
    known = {gear: odd_teeth_of(scene, gear) for gear in odd}
    driver, driven = (
        replace(flank, odd=known[flank.gear].flanks, profiles=known[flank.gear].profiles)
        if flank.gear in odd
        else flank
        for flank in spec.both
    )
    return replace(AskedOfTeeth.of(scene, replace(spec, driver=driver, driven=driven), ()), neglected=False)


def _compute(asked: AskedOfTeeth, upstream: Upstream, work: Work) -> RevolvingFlanks:
    from fegear.contact.wide.over_revolution import revolving_flanks

    spec = asked.spec
    if SHAFTS in upstream:
        spec = spec.on(cast("LoadedShafts", upstream[SHAFTS]).gaps_of(spec.name))
    solved: dict[str, SolidInfluence | OddSolidInfluence] = {
        task.subject: odd_solid_of(upstream, task.subject)
        if task in needs_odd_solid(task.subject)
        else solid_solution_of(upstream, task.subject)
        for task in upstream
        if task != SHAFTS
    }
    gears = [solved[gear] for gear in spec.gears]
    fine = {member: one.fine for member, one in zip(MEMBERS, gears, strict=True)}
    coarse = {member: one.coarse or one.fine for member, one in zip(MEMBERS, gears, strict=True)}
    return revolving_flanks(spec, fine, coarse if asked.estimates else None, work.cache)


def _check(scene: Scene, name: str) -> None:
    check_odd_teeth(scene, name)
    check_wide_pair(scene, name)
    check_odd_wide_pair(scene, name)
    if scene.case.effects.relief:
        for member in MEMBERS:
            gear = gear_name(scene, name, member)
            for _, profile in odd_teeth_of(scene, gear).profiles if gear in odd_gears_in(scene, name) else ():
                profile.built_on(OddFlank(), scene.pairs[name], member)


def _remarks(seen: Seen) -> Iterator[str]:
    """Profiles of single teeth that do not count."""
    spec = seen.asked.spec
    for flank in spec.both if not spec.relief else ():
        if flank.profiles:
            yield neglecting(f"Gear {flank.gear}: profiles of single teeth ignored because effects.relief is off.")


#: Results over a revolution read it; all others take the teeth of 3D pairs alike.
ODD_FLANKS = Stage(
    subjects=solid_pairs,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=Sheet(remarks=(_remarks,)).present,
    check=_check,
    cites=cites,
    forecast=lambda _scene, _name: Forecast(seconds=0.01),
)
