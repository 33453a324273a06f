"""Stage ``odd-pair``: a loaded pair with the odd teeth of its gears."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.notes import assuming, neglecting
from fegear.case.built.odd_gears import odd_gears_of, reshaped_gears
from fegear.case.built.odd_teeth import check_left_contact, check_odd_gear, check_plane_pits, odd_teeth_in
from fegear.case.built.pair_checks import check_odd_teeth, check_plane_pair
from fegear.case.built.pair_spec import pair_spec
from fegear.contact.odd_flank import OddFlank
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results.gear.odd_gear import needs_odd_solution_in
from fegear.results.gear.solved_gear import needs_solution
from fegear.results.pair.loaded_pair import cites, forecast, settings
from fegear.results.pair.loaded_teeth import AskedOfTeeth, plane_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.plane.odd_formula_compliance import GearByFormula
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.pair import Member


@dataclass(frozen=True)
class AskedOfOddTeeth(AskedOfTeeth):
    """A pair with odd teeth that is to be loaded.

    Parameters
    ----------
    tips : tuple of tuple of (int, (float, float))
        Tips of the cracks of driver and driven gear for a formula, as of `OddTeeth.crack_tips`.
    """

    tips: tuple[tuple[tuple[int, tuple[float, float]], ...], ...] = ((), ())


def _pairs(scene: Scene) -> tuple[str, ...]:
    return tuple(name for name in plane_pairs(scene) if odd_gears_of(scene, name))


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    part, reshaped = scene.case.pair[name], reshaped_gears(scene)
    if part.compliance.source != "fe":
        return ()
    odd = tuple(gear for gear in odd_gears_of(scene, name) if gear in reshaped)
    return (
        *needs_odd_solution_in(scene, name, *odd),
        *needs_solution(*(gear for gear in (part.driver, part.driven) if gear not in odd)),
    )


def _inputs(scene: Scene, name: str) -> AskedOfOddTeeth:
    spec, odd = pair_spec(scene, name), odd_gears_of(scene, name)
    known = {gear: odd_teeth_in(scene, name, gear) for gear in odd}
    driver, driven = (
        replace(flank, odd=known[flank.gear].flanks, profiles=known[flank.gear].profiles)
        if flank.gear in odd
        else flank
        for flank in spec.both
    )
    asked = AskedOfOddTeeth.of(scene, replace(spec, driver=driver, driven=driven), ())
    if spec.compliance == "fe":
        return replace(asked, neglected=False)
    tips = tuple(
        tuple(sorted(known[gear].crack_tips(spec.pair.gear(member).teeth).items())) if gear in odd else ()
        for member, gear in zip(MEMBERS, spec.gears, strict=True)
    )
    return replace(asked, neglected=False, tips=tips)


def _compute(asked: AskedOfOddTeeth, upstream: Upstream, work: Work) -> LoadedPair:
    from fegear.contact.plane.maker import load_plane

    spec = asked.spec
    if spec.compliance != "fe":
        return load_plane(spec, _by_formula(asked), estimates=asked.estimates)  # a formula is no content of a key
    solved = {task.subject: gear for task, gear in upstream.items()}
    gears = tuple(solved[gear] for gear in asked.spec.gears)
    return load_plane(asked.spec, gears, cache=work.cache, estimates=asked.estimates)


def _by_formula(asked: AskedOfOddTeeth) -> tuple[GearByFormula, ...]:
    """Both gears by the formula of their pair.

    Raises
    ------
    InputError
        Under the key of the gear, if a crack leaves nothing of a section.
    """
    from fegear.contact.plane.odd_formula_compliance import odd_formula_compliance  # late: all formulas

    found = []
    for member, flank, tips in zip(MEMBERS, asked.spec.both, asked.tips, strict=True):
        try:
            found.append(odd_formula_compliance(asked.spec.pair.gear(member), asked.spec.compliance, dict(tips)))
        except InputError as error:
            raise error.under(f"{flank.prefix}.odd_tooth") from None
    return tuple(found)


def _check(scene: Scene, name: str) -> None:
    check_odd_teeth(scene, name)
    check_plane_pair(scene, name)
    for gear in odd_gears_of(scene, name):
        check_odd_gear(scene, gear)
    check_left_contact(scene, name)
    check_plane_pits(scene, name)
    if scene.case.pair[name].compliance.source != "fe":
        _by_formula(_inputs(scene, name))
    if scene.case.effects.relief:
        for gear in odd_gears_of(scene, name):
            member: Member = "driver" if gear == scene.case.pair[name].driver else "driven"
            for _, profile in odd_teeth_in(scene, name, gear).profiles:
                profile.built_on(OddFlank(), scene.pairs[name], member, 0.0)  # Welbourn's Delta is not known yet


def _remarks(seen: Seen) -> Iterator[str]:
    """Profiles of single teeth that do not count, and what is assumed of pits."""
    spec = seen.asked.spec
    for flank in spec.both:
        teeth = [tooth for tooth, one in flank.odd if any(pit.face_share < 1.0 for pit in one.pits)]
        if teeth:
            yield neglecting(
                f"Gear {flank.gear}: pits of {'tooth' if len(teeth) == 1 else 'teeth'} {', '.join(map(str, teeth))} "
                "change the contact only: tooth body as without pits, uniform load over the remaining face. Set "
                'width = "solid" of the pair for pits beside mid-face.'
            )
    if spec.compliance != "fe" and any(seen.asked.tips):
        yield assuming(
            f"Pair {seen.name}: cracked teeth by {spec.compliance}: open crack faces, gear body as without a crack, "
            "no coupling of neighbouring teeth."
        )
    for flank in spec.both if not spec.relief else ():
        if flank.profiles:
            yield neglecting(f"Gear {flank.gear}: profiles of single teeth ignored because effects.relief is off.")


#: A pair of which a gear has odd teeth: results over a revolution read it, all others the ordinary one.
ODD_PAIR = Stage(
    subjects=_pairs,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=Sheet(remarks=(_remarks,), settings=settings).present,
    check=_check,
    cites=cites,
    forecast=forecast,
)
