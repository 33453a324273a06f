"""Two gears under load, of a spec and of the solved gears: the maker of `LoadedTeeth`, plane or with their width."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from fegear.base.errors import InputError
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS
from fegear.geometry.plausible_flanks import refuse_load

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.base.solution_cache import SolutionCache
    from fegear.contact.loaded_teeth import LoadedTeeth
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.plane.compliance import GearCompliance
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence
    from fegear.fem.solid.influence import SolidInfluence


def load(
    spec: PairSpec,
    gears: Sequence[GearInfluence | OddGearInfluence | GearCompliance | SolidInfluence] = (),
    *,
    cache: SolutionCache | None = None,
    progress: Callable[[float], None] | None = None,
    estimates: bool = True,
) -> LoadedTeeth:
    """Load a pair of gears.

    Parameters
    ----------
    spec : PairSpec
    gears : sequence
        Driver and driven: `fegear.fem.plane.solution.solve_gear` of each for plane teeth, of one with cracked teeth
        `fegear.fem.plane.odd.odd_solution.solve_cracked_gear`, or any sources of compliance; none where the spec's
        compliances are those of a formula or of a table. For teeth with a width,
        `fegear.fem.solid.influence.SolidInfluence` of each.
    cache : SolutionCache, optional
        Where what a load or a relief does not change is recalled from and kept.
    progress : callable, optional
        Takes the fraction that is done.
    estimates : bool
        Whether errors are estimated.

    Returns
    -------
    LoadedTeeth
        Plane teeth have `engagement`, teeth with a width `flanks` besides. Its `neglects` tells what the effects that
        are off would change.

    Raises
    ------
    InputError
        If the spec has no load, or one that teeth cannot carry; if a relief or a table does not fit the gears; if no
        teeth are in contact at some roll position.
    """
    _refuse_gears(spec, gears)
    refuse_unloaded(spec)
    if spec.width == "plane":
        from fegear.contact.plane.maker import load_plane

        return load_plane(spec, cast("Sequence[GearInfluence]", gears), cache=cache, estimates=estimates)
    from fegear.contact.wide.maker import load_wide

    solids = cast("Sequence[SolidInfluence]", gears)
    return load_wide(spec, solids, cache=cache, progress=progress, estimates=estimates)


def _refuse_gears(spec: PairSpec, gears: Sequence[object]) -> None:
    """Refuse what is not the solved gears of a pair."""
    unsolved = [gear for gear in gears if isinstance(gear, Gear)]
    if unsolved:
        how = "solve_gear(gear)" if spec.width == "plane" else "SolidInfluence of each gear"
        raise InputError("gears", f"gear with {unsolved[0].teeth} teeth", "is not solved", f"give {how}")
    if spec.width != "plane" and len(gears) != len(MEMBERS):
        raise InputError(
            "gears", f"{len(gears)} given", "must be both solved gears, driver and driven",
            "give a SolidInfluence of each gear",
        )  # fmt: skip


def refuse_unloaded(spec: PairSpec) -> None:
    """Refuse pairs without a load or with one that teeth cannot carry, and roll positions without contact.

    Raises
    ------
    InputError
    """
    key, pair = spec.prefix or "pair", spec.pair
    plane = spec.width == "plane"
    if not spec.loads:
        what, ways = ("load sharing", "load, loads or torque") if plane else ("the load distribution", "load or torque")
        raise InputError(f"{key}.load", "(not given)", f"is required for {what}", f"specify {ways}")
    if plane:
        from fegear.contact.plane.meshing import refuse_gaps

        refuse_gaps(pair, key, corner_contact=spec.corner_contact)
    try:
        refuse_load(pair, max(spec.loads), spec.load_key)
    except InputError as error:
        raise error.under(key) from None
    if not plane and pair.total_contact_ratio < 1.0 and not spec.corner_contact:
        raise InputError(
            key, f"total contact ratio {pair.total_contact_ratio:.4f}",
            "is below 1: no tooth pair is in contact at some roll positions",
            "increase tooth depth, face width or number of teeth, or set effects.corner_contact = true",
        )  # fmt: skip
