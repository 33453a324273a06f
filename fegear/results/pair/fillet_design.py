"""Result ``fillet-design``: the fillet of one gear of a plane pair with the minimum root stress, its gain and proof."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError, shown
from fegear.case.fillet_design import FilletDesignPart
from fegear.case.nearest import nearest
from fegear.design.fillet.fillet_limits import Limits
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solution, solution_of
from fegear.results.pair.fillet_design_data import FilletDesignData, FilletDesignInputs
from fegear.results.pair.fillet_design_sheet import FILLET_DESIGN_SHEET
from fegear.results.pair.loaded_teeth import PLANE, check_teeth, gears_of, loaded_pair, needs_teeth

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.geometry.pair import Member

#: Seconds of a fillet that is tried, how many a wave takes, and of the final solutions.
_TRIED, _BY_WAVE, _FINAL = 0.08, 7.0, 1.5
#: The same of both fillets of asymmetric teeth over that of one.
_BOTH = 4.0


def fillet_part(scene: Scene) -> FilletDesignPart:
    """``[fillet_design]``, or its defaults."""
    return scene.case.fillet_design or FilletDesignPart()


def fillet_pairs(scene: Scene) -> tuple[str, ...]:
    """The pair whose gear gets a fillet: named, or the only plane one."""
    named, plane = fillet_part(scene).pair, tuple(scene.plane_pairs)
    if named is not None:
        return (named,)
    if len(plane) > 1:
        rule = "is required with several plane (2D) pairs"
        raise InputError("fillet_design.pair", "(not given)", rule, f"choose from {', '.join(plane)}")
    return plane or tuple(scene.pairs)


def named_gears(scene: Scene, name: str) -> dict[Member, str]:
    """Gears of a pair by member as the case names them, whichever flank of asymmetric teeth it loads."""
    return {member: scene.written.get(gear, gear) for member, gear in gears_of(scene, name).items()}


def fillet_member(scene: Scene, name: str) -> Member:
    """Driver or driven gear of the pair: named, or the driver."""
    gear, gears = fillet_part(scene).gear, named_gears(scene, name)
    for member in MEMBERS:
        if gear in (None, gears[member]):
            return member
    raise InputError(
        "fillet_design.gear", shown(str(gear)), f"is not a gear of pair {name}",
        nearest(str(gear), tuple(gears.values())),
    )  # fmt: skip


def other_pair(scene: Scene, name: str) -> str | None:
    """The pair that loads the other flanks of the gear that gets a fillet; None where there is no other.

    Raises
    ------
    InputError
        If it is not another pair of the same gear.
    """
    other = fillet_part(scene).other_pair
    if other is None:
        return None
    gear = named_gears(scene, name)[fillet_member(scene, name)]
    key = "fillet_design.other_pair"
    known = [one for one in scene.pairs if one != name and gear in named_gears(scene, one).values()]
    if other not in scene.pairs:
        raise InputError(key, shown(other), "is not a pair of this case", nearest(other, known))
    if other not in known:
        remedy = f"choose from {', '.join(known)}" if known else "remove it, or set fillet_design.gear"
        raise InputError(key, shown(other), f"must be another pair of gear {gear}", remedy)
    return other


def _other_member(scene: Scene, name: str) -> Member | None:
    other = other_pair(scene, name)
    if other is None:
        return None
    gear = named_gears(scene, name)[fillet_member(scene, name)]
    return next(member for member in MEMBERS if named_gears(scene, other)[member] == gear)


def _check(scene: Scene, name: str) -> None:
    for one in (name, other_pair(scene, name)):
        if one is not None:
            _check_pair(scene, one)
    gear = named_gears(scene, name)[fillet_member(scene, name)]
    _check_flanks(scene, name, gear)
    if (mesh := scene.case.gear[gear].tooth_mesh) is not None:
        raise InputError(
            f"gear.{gear}.tooth_mesh", shown(str(mesh)), "contradicts fillet design, which meshes every fillet anew",
            "remove tooth_mesh",
        )  # fmt: skip
    if scene.gears[gear].tooth.internal and fillet_part(scene).generated:
        raise InputError(
            "fillet_design.generated", "true", f"requires a gear cut by a rack, and gear {gear} is internal",
            "set generated = false",
        )  # fmt: skip


def _check_flanks(scene: Scene, name: str, gear: str) -> None:
    """Refuse loads on one flank of asymmetric teeth where those on both are needed."""
    made, other = scene.gears[gear], other_pair(scene, name)
    if not made.asymmetric:
        return
    if other is None and fillet_part(scene).objective == "alternating":
        raise InputError(
            "fillet_design.other_pair", "(not given)",
            f"is required for alternating stress of gear {gear} (asymmetric teeth)",
            "name a pair that loads the coast flanks, as of the same gears with driver and driven exchanged",
        )  # fmt: skip
    beside = _other_member(scene, name)
    if other is None or beside is None:
        return
    flank, second = (
        scene.gears[gears_of(scene, one)[member]].tooth.working_flank
        for one, member in ((name, fillet_member(scene, name)), (other, beside))
    )
    if flank == second:
        raise InputError(
            "fillet_design.other_pair", shown(other), f"loads the {flank} flanks of gear {gear} as pair {name} does",
            "name a pair that loads the other flanks, or remove it",
        )  # fmt: skip


def _check_pair(scene: Scene, name: str) -> None:
    if name not in scene.plane_pairs:
        raise InputError(
            f"pair.{name}.width", f'"{scene.width_of(name)}"', "is not available for fillet design (plane teeth)",
            f'set pair.{name}.width = "plane"',
        )  # fmt: skip
    check_teeth(scene, name)
    source = scene.case.pair[name].compliance.source
    if source != "fe":
        raise InputError(
            f"pair.{name}.compliance.source", f'"{source}"', "has no root stress; fillet design requires FE",
            f'set pair.{name}.compliance.source = "fe"',
        )  # fmt: skip


def _inputs(scene: Scene, name: str) -> FilletDesignInputs:
    gears, member = named_gears(scene, name), fillet_member(scene, name)
    part, module, usual = fillet_part(scene), scene.pairs[name].driver.module, Limits()
    other = other_pair(scene, name)
    limits = Limits(
        usual.clearance if part.clearance is None else part.clearance / module,
        usual.smallest_radius if part.minimum_radius is None else part.minimum_radius / module,
        part.generated,
        usual.smallest_tool_radius if part.minimum_tool_radius is None else part.minimum_tool_radius / module,
    )
    return FilletDesignInputs(
        part.objective, limits, part.waves, part.searches, member, gears["driver"] == gears["driven"],
        scene.case.accuracy.tolerance, _other_member(scene, name), name, gears, gears_of(scene, name), other or "",
        gears_of(scene, other) if other else {},
    )  # fmt: skip


def _compute(asked: FilletDesignInputs, upstream: Upstream, work: Work) -> FilletDesignData:
    from fegear.design.fillet.fillet_design import LoadedSolved, design_fillet

    def of(name: str, gears: Mapping[Member, str], member: Member, *, alike: bool) -> LoadedSolved:
        loaded = loaded_pair(upstream, name)
        solved = solution_of(upstream, gears["driver"]), solution_of(upstream, gears["driven"])
        return LoadedSolved(loaded, loaded.spec, solved, member, alike)

    pair, other = of(asked.name, asked.solved, asked.member, alike=asked.alike), None
    if asked.other_member is not None:
        other = of(asked.other, asked.other_gears, asked.other_member, alike=False)
    design = design_fillet(
        pair, asked.limits, asked.objective, asked.tolerance, work.progress, asked.searches, asked.waves, other
    )
    return FilletDesignData(pair.loaded.pair, pair.loaded.nominal, design)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    found: list[Task] = []
    for one in (name, other_pair(scene, name)):
        if one is not None:
            gears = gears_of(scene, one)
            found += [*needs_teeth(scene, one), *needs_solution(gears["driver"], gears["driven"])]
    return tuple(dict.fromkeys(found))


def _forecast(scene: Scene, name: str) -> Forecast:
    part = fillet_part(scene)
    tried = round(part.searches * _BY_WAVE * (part.waves + 1))
    asymmetric = scene.gears[gears_of(scene, name)[fillet_member(scene, name)]].asymmetric
    solved = _BOTH if asymmetric and part.other_pair is not None else 1.0  # fillets of twice as many waves, each twice
    return Forecast({"searches": part.searches, "waves": part.waves}, _FINAL + _TRIED * solved * tried)


FILLET_DESIGN = Stage(
    subjects=fillet_pairs,
    inputs=_inputs,
    compute=_compute,
    present=FILLET_DESIGN_SHEET.present,
    needs=_needs,
    check=_check,
    effects_of=lambda _scene, _name: PLANE.effects,
    cites=citing(*RING, Citation("mark", "root stress history of a tooth in mesh", "section 3, Appendix B")),
    forecast=_forecast,
)
