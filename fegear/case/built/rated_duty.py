"""How fast, how long and under which loads a pair runs, for a rating by ISO 6336: load cycles and load spectrum.

What a rating assumes where a case says nothing, and what of a pair lies outside ISO 6336, in words.

Assumed defaults: what a run assumes for keys that a case does not give and its answer depends on, in words.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, RangeError
from fegear.base.notes import assuming, neglecting
from fegear.geometry.gear import USUAL_RING_RIM, Gear
from fegear.geometry.pair import MEMBERS, GearPair

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.case.operation import SpectrumPart
    from fegear.case.pair import PairPart
    from fegear.case.reading import Scene
    from fegear.formulas.iso6336.rated import Both


#: Load cycles that are taken where a case says nothing.
UNLIMITED = 1e10


#: Pitch line velocity above which there is no gear, five times that of the fastest turbo gears [m/s].
_FASTEST = 1000.0


@dataclass(frozen=True)
class Level:
    """One level of a load spectrum.

    Parameters
    ----------
    tangential : float
        F_t at the reference circle [N], 0 for idling.
    speed : float
        Of the pinion [rad/s].
    share : float
        Of the life.
    cycles : (float, float)
        Load cycles of pinion and wheel over the life.
    """

    tangential: float
    speed: float
    share: float
    cycles: Both

    def __post_init__(self) -> None:
        """Refuse loads, speeds, shares and load cycles below zero."""
        for name, values in (
            ("load", (self.tangential,)), ("speed", (self.speed,)), ("share", (self.share,)),
            ("load cycles", self.cycles),
        ):  # fmt: skip
            for value in values:
                if value < 0.0:
                    raise RangeError(f"{name} of a level", value, "must not be negative")


def in_order(values: Both, *, first: bool) -> Both:
    """Of driver and driven as of pinion and wheel."""
    return values if first else (values[1], values[0])


def mates_of(contacts: Sequence[int], *, first: bool) -> tuple[int, int]:
    """With how many mates pinion and wheel mesh: each loads a flank once per revolution."""
    one, other = contacts
    return (one, other) if first else (other, one)


def load_cycles(part: PairPart, pair: GearPair, said: list[str], name: str) -> Both:
    """N_L of driver and driven over the life."""
    operation, speed = part.operation, part.speed or math.nan
    one, other = operation.loaded_per_turn
    ratio = pair.driver.teeth / pair.driven.teeth
    if operation.load_cycles is not None:
        return operation.load_cycles, operation.load_cycles / one * ratio * other
    life = operation.life
    if life is None and operation.spectrum and operation.spectrum[0].time is not None:
        life = sum(level.time or 0.0 for level in operation.spectrum)
    if life is None:
        if not operation.spectrum:
            said.append(
                assuming(
                    f"Pair {name}: required life not specified; rated for {UNLIMITED:g} load cycles (operation.life)."
                )
            )
        return UNLIMITED, UNLIMITED
    turns = life * speed / (2.0 * math.pi)
    if max(turns * one, turns * ratio * other) < 1.0:
        raise InputError(
            f"pair.{name}.operation.life", f"{life:.4g} s", "ends before the first load cycle", "check its unit"
        )
    return turns * one, turns * ratio * other


def refuse_fast(part: PairPart, pair: GearPair, name: str) -> None:
    """Refuse speeds at which any gear has burst; the formulas know no limit."""
    bins = part.operation.spectrum or []
    for key, speed in (
        ("speed", part.speed),
        *((f"operation.spectrum[{i}].speed", b.speed) for i, b in enumerate(bins)),
    ):
        velocity = (speed or 0.0) * pair.driver.pitch_radius
        if velocity > _FASTEST:
            raise InputError(
                f"pair.{name}.{key}", f"{(speed or 0.0) * 30.0 / math.pi:.4g} rpm",
                f"gives a pitch line velocity of {velocity:.4g} m/s, above the burst limit of {_FASTEST:g} m/s",
                "check its unit",
            )  # fmt: skip


def spectrum_levels(
    scene: Scene, name: str, tangential: float, speed: float, *, first: bool
) -> tuple[tuple[Level, ...], float | None]:
    """Levels of the spectrum and its life [s]."""
    part, pair = scene.case.pair[name], scene.pairs[name]
    operation = part.operation
    bins = operation.spectrum
    if not bins:
        return (), None
    times = [level.time for level in bins]
    total = sum(time or 0.0 for time in times)
    life = operation.life or (total or None)
    if life is None:
        rule = "is required with a load spectrum given as shares"
        raise InputError(f"pair.{name}.operation.life", "(not given)", rule, 'set life = "20000 h"')
    shares = sum(level.share or 0.0 for level in bins)
    one, other = operation.loaded_per_turn
    ratio = pair.driver.teeth / pair.driven.teeth
    found = []
    for level in bins:
        share = level.time / total if level.time is not None else (level.share or 0.0) / shares
        turning = part.speed or math.nan if level.speed is None else level.speed
        turns = share * life * turning / (2.0 * math.pi)
        found.append(
            Level(
                _tangential(level, part, pair, tangential), speed * turning / (part.speed or math.nan), share,
                in_order((turns * one, turns * ratio * other), first=first),
            )
        )  # fmt: skip
    if not any(level.tangential > 0.0 and level.share > 0.0 for level in found):
        raise InputError(
            f"pair.{name}.operation.spectrum",
            "(a list)",
            "must have at least one level with a load and a share of the time",
        )
    return tuple(found), life


def _tangential(level: SpectrumPart, part: PairPart, pair: GearPair, nominal: float) -> float:
    """F_t of a level [N], of a half of a double helical pair."""
    if level.torque is not None:
        return level.torque / pair.driver.pitch_radius / part.halves
    return (level.load_factor or 0.0) * nominal


def assumed_of_pair(scene: Scene, name: str, said: list[str]) -> None:
    """Name what was assumed of a pair and its gears; sentences go to `said`."""
    part, pair = scene.case.pair[name], scene.pairs[name]
    operation = part.operation
    if "application_factor" not in operation.model_fields_set and not operation.spectrum:
        said.append(assuming(f"Pair {name}: K_A = 1 assumed (operation.application_factor)."))
    for gear in dict.fromkeys((part.driver, part.driven)):
        _assumed_of_gear(scene, gear, said)
    for member, gear in zip(MEMBERS, (part.driver, part.driven), strict=True):
        made = pair.gear(member)
        if made.tooth.undercut and (made.shaped or not made.external_tooth.rack.residual_undercut):
            said.append(
                f"Gear {gear}: undercut up to diameter {2e3 * made.form_radius:.5g} mm; ISO 6336 applies to gears "
                "without undercut and includes it in the contact ratio only (profile_shift)."
            )
    if pair.normal_backlash < 0.0:
        said.append(
            assuming(
                f"Pair {name}: without thickness allowance the backlash is negative by "
                f"{-pair.normal_backlash * 1e6:.2g} um along the line of action "
                "(rounded profile shifts); rated with zero backlash."
            )
        )


def _assumed_of_gear(scene: Scene, gear: str, said: list[str]) -> None:
    part, made = scene.case.gear[gear], scene.gears[gear]
    found = []
    if (
        not part.internal
        and part.rack.profile is None
        and None in (part.rack.addendum, part.rack.dedendum, part.rack.tip_radius)
    ):
        found.append(("basic rack ISO 53 C for values not specified", "rack"))
    if "young_modulus" not in part.material.model_fields_set:
        found.append((f"E = {made.material.young_modulus * 1e-9:.4g} GPa", "material.young_modulus"))
    strength = part.strength
    own = strength is not None and strength.contact and (strength.bending or strength.bending_allowable)
    if strength is not None and not own and "quality" not in strength.model_fields_set:
        found.append((f"quality {strength.quality}", "strength.quality"))
    if found:
        what, keys = (", ".join(one) for one in zip(*found, strict=True))
        said.append(assuming(f"Gear {gear}: {what} assumed ({keys})."))
    said += bore_remarks(scene, gear)


def bore_remarks(scene: Scene, gear: str) -> tuple[str, ...]:
    """Where the body of a gear is held fast, if the case does not say."""
    part, bore = scene.case.gear[gear], scene.gears[gear].bore_radius * 1e3
    if part.internal:
        if part.outer_radius is not None or part.rim_thickness is not None:
            return ()
        held = f"fixed outside a rim of {USUAL_RING_RIM:g} modules, at radius {bore:.6g} mm"
        return (assuming(f"Gear {gear}: outer_radius or rim_thickness not specified; gear body {held}."),)
    if part.body is not None and part.face_width is not None:
        plane = neglecting(
            f"Gear {gear}: plane (2D) results use a solid disc; rim, web and hub are included in 3D results only."
        )
        return (plane, *thin_rim_remarks(gear, scene.gears[gear]))
    if part.bore is not None:
        from fegear.case.built.teeth_in_shafts import cut_into

        solid = scene.gears[gear].support is not None or cut_into(scene, gear) is not None
        return () if solid else thin_rim_remarks(gear, scene.gears[gear])
    held = f"fixed at half the root radius, {bore:.6g} mm"
    return (assuming(f"Gear {gear}: bore_radius not specified; gear body {held}."),)


def thin_rim_remarks(gear: str, made: Gear) -> tuple[str, ...]:
    """What a thin rim on a bore that is fixed all round leaves out, and what to do."""
    from fegear.geometry.checks import LEAST_RIM

    backup = (made.root_radius - made.bore_radius) / (made.tip_radius - made.root_radius)
    if made.tooth.internal or backup >= LEAST_RIM:
        return ()
    said = neglecting(
        f"Gear {gear}: rim of {backup:.2g} tooth depths (below {LEAST_RIM:g}) fixed around the bore; root stress and "
        "deflection are underestimated. Specify rim_support (plane gears: web, pins, free arc), or rim and web in body "
        '(rim_thickness, web_thickness) and set width = "solid" for its pairs.'
    )
    return (said,)


def width_remarks(scene: Scene, gear: str) -> tuple[str, ...]:
    """On which width a gear carries its load, if the case does not say."""
    if scene.case.gear[gear].face_width is not None:
        return ()
    remedy = f"Specify gear.{gear}.face_width."
    return (assuming(f"Gear {gear}: face_width not specified, 1 mm assumed. {remedy}"),)
