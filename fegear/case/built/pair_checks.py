"""What makes a pair of a case impossible to load as the case asks, and effects without data."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.effects import ODD_TEETH
from fegear.base.errors import InputError
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.root_stress_sources import refuse_formulas
from fegear.case.built.shafts import check_heights, on_shafts
from fegear.case.built.solid_influence import check_solid_gear, check_source
from fegear.contact.load import refuse_unloaded
from fegear.contact.pair_spec import PairSpec
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.case.reading import Scene

#: Formulas of compliance that have cracked and pitted teeth.
WITH_ODD_TEETH = ("potential-energy", "potential-energy-simplified")


def _bare(scene: Scene, name: str, *, over_face: bool = False) -> PairSpec:
    """A pair and its loads, before any file is read; `over_face` as in `pair_spec`."""
    part, pair, width = scene.case.pair[name], scene.pairs[name], scene.width_of(name)
    corners = scene.case.effects.corner_contact
    return PairSpec(
        pair, part.all_loads(pair), width="solid" if over_face and width == "plane" else width,
        corner_contact=corners, name=name, load_key=part.load_key(pair),
    )  # fmt: skip


def check_plane_pair(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded as the case asks, and effects without data or data against an effect."""
    part, effects = scene.case.pair[name], scene.case.effects
    pair, key = scene.pairs[name], f"pair.{name}"
    refuse_unloaded(_bare(scene, name))
    source = part.compliance.source
    refuse_formulas(scene, name)
    if source not in ("fe", "table"):
        _check_closed_forms(scene, name)
    if effects.neighbour_coupling and source != "fe":
        raise InputError(
            "effects.neighbour_coupling", "true", f'is not available with {key}.compliance source = "{source}"',
            f'set {key}.compliance.source = "fe", or switch the effect off',
        )  # fmt: skip
    if source == "table" and effects.hertz != "none":
        raise InputError(
            "effects.hertz", f'"{effects.hertz}"', f"has no effect: the compliance table of {key} already includes "
            "the contact deformation",
            'set effects.hertz = "none"',
        )  # fmt: skip
    if source == "table" and part.compliance.of != "pair" and pair.driver.base_radius != pair.driven.base_radius:
        raise InputError(
            f"{key}.compliance.of", '"tooth"', "uses one tooth compliance for both gears, but the gears differ",
            'specify the compliance of the tooth pair and set of = "pair"',
        )  # fmt: skip
    if effects.spacing_errors and all(gear.spacing_errors is None for gear in scene.case.gear.values()):
        raise InputError(
            "effects.spacing_errors", "true", "has no effect: no gear of this case has spacing_errors",
            f"specify gear.{part.driver}.spacing_errors, or switch the effect off",
        )  # fmt: skip
    _check_profiles(pair_spec(scene, name))


def _check_closed_forms(scene: Scene, name: str) -> None:
    """Refuse a formula of tooth compliance outside the range of teeth and bodies that it is made for."""
    from fegear.formulas.sources import refuse_gear

    source = scene.case.pair[name].compliance.source
    for member in MEMBERS:
        try:
            refuse_gear(source, scene.pairs[name].gear(member))
        except InputError as error:
            key, gear = f"pair.{name}.compliance.source", gear_name(scene, name, member)
            raise InputError(
                key,
                f'"{source}"',
                f"requires another gear {gear}: {error.key} = {error.value} {error.rule}",
                error.remedy,
            ) from None


def _check_profiles(spec: PairSpec) -> None:
    """Refuse reliefs that do not fit the teeth, before anything is solved."""
    for member, flank in zip(MEMBERS, spec.both, strict=True) if spec.relief else ():
        flank.profile(spec.pair, member, 0.0)  # what is given in Welbourn's Delta is looked at when that is known


def check_odd_teeth(scene: Scene, name: str) -> None:
    """Refuse the effect odd_teeth where no gear of the case has odd teeth, and compliances that have none.

    Raises
    ------
    InputError
    """
    part, effects = scene.case.pair[name], scene.case.effects
    if not effects.odd_teeth:
        return
    key, source = f"effects.{ODD_TEETH.name}", part.compliance.source
    if not any(gear.odd_tooth for gear in scene.case.gear.values()):
        raise InputError(
            key, "true", "has no effect: no gear of this case has odd_tooth",
            f"describe [[gear.{part.driver}.odd_tooth]], or switch the effect off",
        )  # fmt: skip
    odd = [(gear, n, tooth) for gear in dict.fromkeys((part.driver, part.driven))
           for n, tooth in enumerate(scene.case.gear[gear].odd_tooth)]  # fmt: skip
    if source == "fe" or not odd:
        return
    if source not in WITH_ODD_TEETH:
        among = ", ".join(f'"{one}"' for one in WITH_ODD_TEETH)
        raise InputError(
            key, "true", f'is not available with pair.{name}.compliance.source = "{source}"',
            f'set pair.{name}.compliance.source = "fe" or one of {among}, or switch the effect off',
        )  # fmt: skip
    for gear, n, tooth in odd:
        for other in ("hole", "keyway"):
            if getattr(tooth, other) is not None:
                raise InputError(
                    f"gear.{gear}.odd_tooth[{n}].{other}", "(given)",
                    f'is not available with pair.{name}.compliance.source = "{source}", which has no such gear body',
                    f'set pair.{name}.compliance.source = "fe", or remove it',
                )  # fmt: skip


def check_relief(scene: Scene, name: str) -> None:
    """Refuse the effect relief where no gear of the case has any: other pairs may do without."""
    part, effects = scene.case.pair[name], scene.case.effects
    gears = scene.case.gear.values()
    own = effects.odd_teeth and any(tooth.profiled for gear in gears for tooth in gear.odd_tooth)
    if effects.relief and not own and not any(gear.relieved for gear in gears):
        raise InputError(
            "effects.relief", "true", "has no effect: no gear of this case has a relief",
            f"specify gear.{part.driver}.relief, or switch the effect off",
        )  # fmt: skip


def _check_misalignment(scene: Scene, name: str) -> None:
    part = scene.case.pair[name]
    if on_shafts(scene, name):
        if scene.pairs[name].driver.tooth.internal:
            raise InputError(
                f"pair.{name}.driver", f'"{part.driver}"', "is an internal gear: misalignment from shafts is not "
                "available for 3D flanks", "make the planet the driver, or specify the misalignment of the pair",
            )  # fmt: skip
        check_heights(scene, name)
    elif part.line_error is None and part.misalignment is None:
        raise InputError(
            "effects.misalignment", "true", "has no effect: no misalignment or gap over the face width of pair "
            f"{name} is specified",
            f'specify pair.{name}.misalignment = {{ driven = {{ out_of_plane = "10 um" }} }} or shafts for both '
            "gears, or switch the effect off",
        )  # fmt: skip


def check_wide_pair(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded with their width, and effects without data.

    Raises
    ------
    InputError
    """
    from fegear.contact.wide.flanks import open_gaps

    part, effects = scene.case.pair[name], scene.case.effects
    for gear in (part.driver, part.driven):
        check_solid_gear(scene, gear)
        check_source(scene, gear, f"pair.{name}.width", "slices" if part.width == "slices" else "solid")
    refuse_unloaded(_bare(scene, name, over_face=True))
    if effects.misalignment:
        _check_misalignment(scene, name)
    spec = pair_spec(scene, name, over_face=True)
    gears = scene.case.gear.values()
    own = effects.odd_teeth and any(tooth.profiled for gear in gears for tooth in gear.odd_tooth)
    if effects.relief and not (own or spec.face.cutter or any(gear.relieved or gear.over_face for gear in gears)):
        raise InputError(
            "effects.relief", "true", "has no effect: no gear of this case has relief, lead, bias or topography",
            f"specify gear.{part.driver}.relief or lead, or switch the effect off",
        )  # fmt: skip
    if effects.spacing_errors and all(gear.spacing_errors is None for gear in gears):
        raise InputError(
            "effects.spacing_errors", "true", "has no effect: no gear of this case has spacing_errors",
            f"specify gear.{part.driver}.spacing_errors, or switch the effect off",
        )  # fmt: skip
    for flank in spec.both:
        if effects.relief and flank.wants_delta:
            raise InputError(
                f"gear.{flank.gear}.relief", "amount_over_delta", "is defined for the plane (2D) model only",
                "specify the amount as a length for 3D gears",
            )  # fmt: skip
    open_gaps(spec)
