"""The solid solution of a gear with a width, once for every stage that needs it."""

from __future__ import annotations

import math
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from fegear.base.errors import InputError, RangeError
from fegear.base.printed import percent
from fegear.case.built.tooth_influence import given_settings, planets_taken_alone, teeth_on_pins_differ
from fegear.case.part import at

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fegear.base.solution_cache import SolutionCache
    from fegear.case.accuracy import AccuracyPart
    from fegear.case.gear_body import GearBodyPart
    from fegear.case.reading import Scene
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.solid.uneven_teeth import UnevenTeeth
    from fegear.geometry.gear import Gear
    from fegear.geometry.gear_body import WebHoles
    from fegear.geometry.involute_side import InvoluteSide

#: Tolerance that the usual settings are for, how edges and wavelengths follow another and how far; from the last on
#: elements of order 4 are taken, as fine as a case asks for.
_USUAL_TOLERANCE, _FOLLOWS, _COARSEST, _FINE_TOLERANCE = 1e-2, 0.25, 1.25, 3e-3
#: Processor seconds of a solid gear with the usual settings and its error estimate: those of a narrow gear, what the
#: width [modules] to a power adds, the power (measured from 4 to 24 modules), and that of one over the edge length, or
#: of the elements' order, with which both grow.
_SECONDS, _BY_WIDTH, _WIDER, _GROWTH = 1.1, 0.0078, 2.4, 4.0
#: The share of what the width adds that is left where motions that mirror at the middle of the face are solved apart.
_APART = 0.35
#: Of one in slices.
_SECONDS_OF_SLICES = 0.6
#: How many times as long one on a web takes.
_ON_A_WEB = 3.0
#: And on one with holes.
_HOLED = 1.4
#: And a ring whose rim is not held.
_RIM_FREE = 1.8


@dataclass(frozen=True)
class SolidGearToSolve:
    """All that the solid influence functions of a gear depend on.

    Parameters
    ----------
    gear : Gear
    settings : SolidSettings
    tolerance : float
        What estimated errors are compared with.
    reach : int
        K: neighbours -K..K.
    name : str
        Of the gear, for messages.
    cut : bool
        Whether its teeth are cut into a shaft, for messages: its bore is no rim.
    """

    gear: Gear
    settings: SolidSettings
    tolerance: float
    reach: int
    name: str = field(default="", compare=False)
    cut: bool = field(default=False, compare=False)


def settings_of_case(accuracy: AccuracyPart) -> SolidSettings:
    """Settings of a solid gear for a tolerance; edge lengths and order that the case gives hold for its section."""
    from fegear.fem.solid.settings import SolidSettings, solid_settings

    if accuracy.tolerance <= _FINE_TOLERANCE:
        chosen = solid_settings(_FINE_TOLERANCE)
    else:
        factor = min((accuracy.tolerance / _USUAL_TOLERANCE) ** _FOLLOWS, _COARSEST)
        chosen = SolidSettings().scaled(factor)
    # The half-width of the bands is the solid's own.
    given = {key: value for key, value in given_settings(accuracy).items() if key != "patch_half_width"}
    return replace(chosen, section=replace(chosen.section, solver=accuracy.solver, **given))


def solid_settings_of(scene: Scene, name: str) -> SolidSettings:
    """Settings of a solid gear: those for the case's tolerance, as a solid or in slices."""
    return replace(settings_of_case(scene.case.accuracy), source=_source(scene, name))


def _source(scene: Scene, name: str) -> Literal["solid", "slices"]:
    """Solid or slices, as the gear's pairs have it; as the table over its face, where none of them is wide.

    Raises
    ------
    InputError
        If its pairs want both.
    """
    wanted = {f"pair.{key}.width": width for key, width in _widths(scene, name).items()}
    if len(set(wanted.values())) > 1:
        one = next(key for key, value in wanted.items() if value == "slices")
        other = next(key for key, value in wanted.items() if value == "solid")
        raise InputError(
            one, '"slices"', f"contradicts {other}: gear {name} must use the same width model (\"solid\" or "
                             "\"slices\") throughout the case",
            "set the same width model for both, or use a separate case",
        )  # fmt: skip
    table = scene.case.stiffness
    tabled = table.face_positions is not None and table.gear in (None, name)
    usual = table.source if tabled or not _pairs_of(scene, name, flank_pairs(scene)) else "solid"
    return next(iter(wanted.values()), usual)


def _pairs_of(scene: Scene, name: str, pairs: Iterable[str]) -> list[str]:
    """Those of some pairs that a gear is in, at end II of a double helical one, too."""
    return [key for key in pairs if name in scene.case.pair[key].gears]


def _widths(scene: Scene, name: str) -> dict[str, Literal["solid", "slices"]]:
    """As what a gear's pairs with a width have it solved, by the name of the pair."""
    pairs = _pairs_of(scene, name, _wide_pairs(scene))
    return {key: "slices" if scene.case.pair[key].width == "slices" else "solid" for key in pairs}


def check_source(scene: Scene, name: str, key: str, source: str) -> None:
    """Refuse a key that wants a gear solved in another way than it is.

    Raises
    ------
    InputError
    """
    if source == _source(scene, name):
        return
    other = next((f"pair.{pair}.width" for pair in _widths(scene, name)), "stiffness.source")
    raise InputError(
        key, f'"{source}"', f"contradicts {other}: gear {name} must use the same width model (\"solid\" or "
                            "\"slices\") throughout the case",
        "set the same width model for both, or use a separate case",
    )  # fmt: skip


def flank_pairs(scene: Scene) -> tuple[str, ...]:
    """The pairs with a load that may be loaded with their width.

    ``load-distribution`` is for every pair that is not plane by its key, other results for those with a width.
    """
    loaded = (key for key, pair in scene.pairs.items() if scene.case.pair[key].normal_load(pair) is not None)
    return tuple(key for key in loaded if scene.case.pair[key].width != "plane")


def _wide_pairs(scene: Scene) -> list[str]:
    """Those of them that every result loads with their width."""
    return [key for key in flank_pairs(scene) if key in scene.wide_pairs]


def solid_gear_to_solve(scene: Scene, name: str) -> SolidGearToSolve:
    """What the case asks of the solid influence functions of a gear."""
    accuracy, reach = scene.case.accuracy, 1
    for key in _pairs_of(scene, name, flank_pairs(scene)):
        # As far as two pairs of one mesh can stand apart.
        reach = max(reach, math.ceil(scene.pairs[key].total_contact_ratio))
    if scene.case.rack:
        from fegear.case.built.rack import is_wide_rack, rack_inputs  # late: few cases have racks

        for key, rack in scene.case.rack.items():
            if rack.pinion == name and is_wide_rack(scene, key):
                reach = max(reach, math.ceil(rack_inputs(scene, key).pair.total_contact_ratio))
    from fegear.case.built.teeth_in_shafts import cut_into

    settings, cut = solid_settings_of(scene, name), cut_into(scene, name) is not None
    return SolidGearToSolve(scene.gears[name], settings, accuracy.tolerance, reach, name, cut)


def check_solid_gear(scene: Scene, name: str) -> None:
    """Refuse gears whose width is not given, or whose teeth are a mesh of the user's own.

    Raises
    ------
    InputError
    """
    part, sliced = scene.case.gear[name], _source(scene, name) == "slices"
    if sliced and part.internal:
        raise InputError(
            f"gear.{name}.internal", "true", 'is not available with width = "slices" (external gears only)',
            'set width = "solid"',
        )  # fmt: skip
    if sliced and part.body is not None:
        raise InputError(
            f"gear.{name}.body", "(a table)", 'is not available with width = "slices" (solid disc only)',
            'set width = "solid", or remove body',
        )  # fmt: skip
    check_ends(scene, name, _wide_pairs(scene))
    if part.face_width is None:
        raise InputError(
            f"gear.{name}.face_width", "(none)", "is required for 3D gears",
            'set face_width = "20 mm", or remove face_positions',
        )  # fmt: skip
    if part.tooth_mesh is not None:
        raise InputError(
            f"gear.{name}.tooth_mesh", f'"{part.tooth_mesh}"', "is a 2D mesh and cannot be used for a 3D gear",
            "remove tooth_mesh or face_positions",
        )  # fmt: skip
    from fegear.fem.solid.settings import check_solid

    with keys_of_the_case(name):
        check_solid(*parts_in_modules(scene.gears[name]), solid_settings_of(scene, name), None, 0)


def check_ends(scene: Scene, name: str, pairs: Iterable[str]) -> None:
    """Refuse uneven bodies of gears that are driven in one of some loaded pairs and drive in another.

    So are holes over which one tooth is taken: in the other mesh its other flank is loaded, which stands differently.

    Raises
    ------
    InputError
    """
    body, part = scene.gears[name].body, scene.case.gear[name].body
    if body is None or part is None:
        return
    tooth = None if body.holes is None else body.holes.tooth
    if body.even and tooth is None:
        return
    meshes = [(key, scene.case.pair[key]) for key in pairs]
    driven = next((key for key, one in meshes if one.driven == name), None)
    drives = next((key for key, one in meshes if one.driver == name), None)
    if driven is not None and drives is not None and body.even:
        raise InputError(
            f"gear.{name}.body.holes.tooth", tooth,
            f"refers to the flank loaded in pair {driven}; pair {drives} loads the other flank",
            "remove tooth (mean of all teeth), or use one case for each pair; in one of them angle changes sign and "
            "the teeth are counted in the other direction",
        )  # fmt: skip
    if driven is not None and drives is not None:
        key, value = _uneven(part)
        raise InputError(
            f"gear.{name}.body.{key}", value,
            f"is ambiguous for idler {name}: end II is at opposite ends in pairs {driven} and {drives}",
            "use one case for each pair; in one of them web_offset, web_inclination and hub_offset change sign",
        )  # fmt: skip


def _uneven(part: GearBodyPart) -> tuple[str, str]:
    """The first key of a body by which its two ends differ, and its value."""
    if part.web_inclination:
        return "web_inclination", f"{math.degrees(part.web_inclination):.6g} deg"
    key = "web_offset" if part.web_offset else "hub_offset"
    return key, f"{getattr(part, key) * 1e3:.6g} mm"


def parts_in_modules(gear: Gear) -> tuple[InvoluteSide, float, float, float]:
    """Tooth, twist, width and Poisson's ratio of a gear of module 1, what its solid is made of."""
    tau, width = gear.flank_twist * gear.module, gear.face_width / gear.module
    return gear.tooth, tau, width, gear.material.poisson_ratio


@contextmanager
def keys_of_the_case(name: str) -> Iterator[None]:
    """What the solid of a gear refuses, under the gear's keys."""
    try:
        yield
    except RangeError as error:
        raise at(f"gear.{name}", error, {"poisson_ratio": "material.poisson_ratio"}) from None


def solve_solid_influence(asked: SolidGearToSolve, cache: SolutionCache | None = None) -> SolidInfluence:
    """Solve a gear with its width, or recall its shape from a cache.

    Raises
    ------
    RangeError
        If it cannot be meshed, under the key of the case.
    """
    from fegear.base.solution_cache import SolutionCache
    from fegear.fem.solid.influence import solid_influence

    gear, cache = asked.gear, cache or SolutionCache()
    with keys_of_the_case(asked.name):
        found = solid_influence(
            *parts_in_modules(gear),
            gear.bore_radius / gear.module,
            asked.settings,
            reach=asked.reach,
            body=gear.body_in_modules,
            support=gear.support_in_modules,
            cache=cache,
        )
    return found.with_error(cache)


def seconds_of_solid_gear(
    settings: SolidSettings,
    width: float,
    *,
    apart: bool = False,
    on_a_web: bool = False,
    rim_free: bool = False,
    holed: bool = False,
) -> float:
    """About how many seconds a solid gear takes, with its error estimate; `width` in modules.

    Less where motions that mirror at the middle of the face are solved `apart`.
    """
    from fegear.fem.solid.settings import SolidSettings

    usual, section = SolidSettings().section, settings.section
    finer = usual.root_edge_length / section.root_edge_length * section.order / usual.order
    by_width = _BY_WIDTH * width**_WIDER * (_APART if apart else 1.0)
    alone = _SECONDS_OF_SLICES if settings.source == "slices" else _SECONDS + by_width
    return (
        alone
        * finer**_GROWTH
        * (_ON_A_WEB if on_a_web else _RIM_FREE if rim_free else 1.0)
        * (_HOLED if holed else 1.0)
    )


def solid_support_remarks(name: str, influence: SolidInfluence, tooth: int | None = None) -> tuple[str, ...]:
    """How teeth on pins or over holes differ, and what a ring that is not held all round leaves out."""
    support, teeth, body = influence.fine.support, influence.fine.uneven, influence.fine.body
    if body is not None and body.holes is not None and teeth is not None:
        return (_over_holes(name, body.holes, teeth, tooth),)
    if support is None:
        return ()
    if teeth is None:
        return (planets_taken_alone(name),)
    spread = teeth_on_pins_differ(
        name, support.pins, "at half tooth height, mid-face", teeth.deflection, teeth.root_tension
    )
    return spread, planets_taken_alone(name)


def _over_holes(name: str, holes: WebHoles, teeth: UnevenTeeth, tooth: int | None) -> str:
    """How far teeth over holes depart from their mean, and which of them most."""
    c, tension, count = teeth.deflection, teeth.root_tension, holes.count
    what = f"the {count} web holes" if count > 1 else "the web hole"
    if c.size == 1:
        return f"Gear {name}: all teeth are identical relative to {what}; stress at the hole edges is not computed."
    off, under = c / c.mean() - 1.0, tension / tension.mean() - 1.0
    stiff, soft, low, high = (int(i) for i in (off.argmin(), off.argmax(), under.argmin(), under.argmax()))
    taken = "mean compliance and stress of all teeth"
    if tooth is not None:
        taken = f"those of tooth {tooth} for all teeth"
    return (
        f"Gear {name}: compliance varies over {c.size} consecutive teeth because of {what}. Load at half tooth "
        f"height, mid-face: c_self of tooth {stiff} (stiffest) {percent(off[stiff], signed=True)}, of tooth {soft} "
        f"(most compliant) {percent(off[soft], signed=True)} from the mean; root stress, tension side, "
        f"{percent(under[low], signed=True)} (tooth {low}) to {percent(under[high], signed=True)} (tooth {high}). "
        f"Tables, pairs and planetary sets use {taken}; hole-order transmission error and stress at the hole edges "
        "are neglected."
    )


def solid_solution_settings(influence: SolidInfluence) -> dict[str, object]:
    """Settings of a solid solution and what they cost, for the summary."""
    return {
        **asdict(influence.settings),
        "degree_along_the_face": influence.settings.degree(influence.width),
        "unknowns": influence.fine.unknowns,
        "estimated_error": {key: float(f"{error:.3g}") for key, error in influence.error.items()},
        "seconds": {key: round(seconds, 6) for key, seconds in influence.seconds.items()},
    }
