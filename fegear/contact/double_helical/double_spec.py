"""What the mechanics needs of a double helical pair: both halves, the gap between them, and how it is held axially."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from fegear.base.effects import SPACING_ERRORS
from fegear.base.errors import InputError
from fegear.contact.double_helical.balance import AxialSeat
from fegear.contact.wide.lines import base_twist
from fegear.geometry.flank_modification import MirroredModification
from fegear.geometry.placed_halves import PlacedHalves

if TYPE_CHECKING:
    from fegear.contact.pair_spec import FlankSpec, PairSpec
    from fegear.geometry.flank_modification import FlankModification
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair, Member

#: End of the pair at which a half is.
End = Literal["I", "II"]
#: Largest difference of what both halves must have in common, as a share of it.
_EQUAL = 1e-9


@dataclass(frozen=True)
class DoubleHelicalSpec(PlacedHalves):
    """Two helical pairs of opposite hand on common shafts.

    Each half's gear bodies deflect by themselves; between the halves shafts twist as far as `twist_compliance` says.

    Parameters
    ----------
    halves : (PairSpec, PairSpec)
        At end I and at end II, each with its own face width, flanks and effects; their loads are not looked at.
    loads : tuple of float
        Of both halves together, along the transverse line of action [N].
    gap : float
        Axial distance between the halves [m]; the halves of a misaligned pair stand apart by it.
    apex_offset : float
        Axial distance of the driver's apex from the driven's, toward end II, as both are mounted [m].
    floating : {"driver", "driven"} or None
        The member that moves along its axis; None for two located members.
    axial_play : float
        How far it moves between its stops in all, half of it to either side [m].
    axial_force : float
        What else pushes the floating member toward end II, of a coupling, say [N].
    stagger : float
        By which share of a pitch the teeth at end II are ahead of those at end I.
    twist_compliance : (float, float)
        What the approach of either half lags per its own load, of shafts that twist between the halves [m/N]: see
        `twist_between`.
    name : str
        For messages.
    """

    halves: tuple[PairSpec, PairSpec]
    loads: tuple[float, ...]
    floating: Member | None = None
    axial_play: float = math.inf
    axial_force: float = 0.0
    twist_compliance: tuple[float, float] = (0.0, 0.0)
    name: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        """Refuse halves that do not go together, and numbers that are none."""
        object.__setattr__(self, "loads", tuple(sorted(set(self.loads))))
        if not self.loads or not all(math.isfinite(load) and load > 0.0 for load in self.loads):
            said = ", ".join(f"{load:.6g} N" for load in self.loads) or "(not given)"
            raise self._wrong("loads", said, "must be positive and finite")
        for key, low in (("gap", 0.0), ("apex_offset", -math.inf), ("axial_force", -math.inf)):
            value = getattr(self, key)
            if not (math.isfinite(value) and value >= low):
                rule = "must be finite" if low < 0.0 else "must be finite and not negative"
                raise self._wrong(key, f"{value}", rule)
        if not self.axial_play >= 0.0:
            raise self._wrong("axial_play", f"{self.axial_play}", "must not be negative")
        if not 0.0 <= self.stagger < 1.0:
            raise self._wrong("stagger", f"{self.stagger:.6g}", "must be at least 0 and below 1 (share of a pitch)")
        if not all(math.isfinite(one) and one >= 0.0 for one in self.twist_compliance):
            said = " and ".join(f"{one:.6g}" for one in self.twist_compliance)
            raise self._wrong("twist_compliance", said, "must be finite and not negative")
        if self.floating is None and (self.axial_force or math.isfinite(self.axial_play)):
            key = "axial_force" if self.axial_force else "axial_play"
            rule = "requires a floating member"
            raise self._wrong(key, f"{getattr(self, key):.6g}", rule, 'set floating = "driver" or "driven"')
        self._check_halves()

    def _wrong(self, key: str, value: str, rule: str, remedy: str = "") -> InputError:
        return InputError(".".join(filter(None, (self.name, key))), value, rule, *filter(None, (remedy,)))

    def _check_halves(self) -> None:
        one, two = (half.pair for half in self.halves)
        for half in self.halves:
            if half.width == "plane" or not half.pair.driver.helix_angle:
                raise self._wrong("halves", f'width "{half.width}"', "must be helical pairs with their face width",
                                  'set width = "slices" or "solid"')  # fmt: skip
            if half.face.errors.shafts.given:
                raise self._wrong("halves", "(on shafts)", "must not be on shafts that bend",
                                  "specify line_error or misalignment")  # fmt: skip
            if self.stagger and half.spacing_errors and half.has_data(SPACING_ERRORS.name):
                raise self._wrong("stagger", f"{self.stagger:.6g}", "is not available with spacing errors",
                                  f"set effects.{SPACING_ERRORS.name} = false or stagger = 0")  # fmt: skip
        if base_twist(one) * base_twist(two) > 0.0:
            raise self._wrong("hand", f"{one.driver.hand} in both halves", "must be opposite",
                              "change the hand of one half")  # fmt: skip
        for key, first, second in (
            ("teeth", one.driver.teeth, two.driver.teeth),
            ("teeth", one.driven.teeth, two.driven.teeth),
            ("base_pitch", one.base_pitch, two.base_pitch),
            ("centre_distance", one.centre_distance, two.centre_distance),
        ):
            if abs(first - second) > _EQUAL * abs(first):
                raise self._wrong(key, f"{first:.9g} and {second:.9g}", "must be equal in both halves")

    @property
    def total_width(self) -> float:
        """Common face width of both halves, without the gap [m]."""
        return sum(half.pair.face_width for half in self.halves)

    @property
    def nominal_parts(self) -> tuple[float, float]:
        """Share of either half where the load is even over the face width."""
        first = self.halves[0].pair.face_width / self.total_width
        return first, 1.0 - first

    @property
    def middles(self) -> tuple[float, float]:
        """Where the middles of the halves' faces stand from that of the gap [m]."""
        return tuple(  # type: ignore[return-value]  # two halves
            side * 0.5 * (self.gap + half.pair.face_width) for side, half in zip((-1.0, 1.0), self.halves, strict=True)
        )

    @property
    def constant_gaps(self) -> tuple[float, float]:
        """What a tilt of the axes, which is counted about the middle of the gap, opens all over either half [m]."""
        first, second = (
            half.face.errors.tilt.in_plane_of_action(half.placed) * z if half.misalignment else 0.0
            for half, z in zip(self.halves, self.middles, strict=True)
        )
        return first, second

    @property
    def seat(self) -> AxialSeat:
        """How the members are held along the axis."""
        first, second = (base_twist(half.placed) for half in self.halves)
        room = 0.0 if self.floating is None else 0.5 * self.axial_play
        sign = -1.0 if self.floating == "driven" else 1.0
        return AxialSeat((first, second), self.apex_offset, room, sign * self.axial_force)

    def of_half(self, number: int) -> PairSpec:
        """The helical pair that a half is, under its even part of every load and under all of it."""
        half, part = self.halves[number], self.nominal_parts[number]
        loads = (*(part * load for load in self.loads), *self.loads)
        return replace(half, loads=loads, nominal=part * self.loads[-1])


def twist_between(pair: GearPair, gap: float, torque_in: End | None, torque_out: End | None) -> tuple[float, float]:
    """Compliances of both halves by the twist of tubes from bore to root circle over the gap [m/N].

    The half away from where the driver is driven lags behind the other one, and so does the half away from where the
    driven gear's torque is taken.

    Parameters
    ----------
    pair : GearPair
        Either half.
    gap : float
        Length of the tubes [m].
    torque_in, torque_out : {"I", "II"} or None
        Ends at which the driver is driven and the driven gear's torque is taken; None for a shaft that does not twist.
    """
    found = [0.0, 0.0]
    for gear, end in ((pair.driver, torque_in), (pair.driven, torque_out)):
        if end is None:
            continue
        material = gear.material
        shear = material.young_modulus / (2.0 * (1.0 + material.poisson_ratio))
        polar = 0.5 * math.pi * abs(gear.root_radius**4 - gear.bore_radius**4)
        found[0 if end == "II" else 1] += gear.base_radius**2 * gap / (shear * polar)
    return found[0], found[1]


def mirrored(half: PairSpec) -> PairSpec:
    """The half at the other end of a pair whose gears mirror themselves at the middle of the gap.

    Flanks and what their cutter leaves are mirrored with the gears; deviations of the axes are those of both halves.

    Raises
    ------
    InputError
        If it has a gap over the face, which is of one half only.
    """
    errors = half.face.errors
    if errors.line_gap.size or errors.shafts.given:
        raise InputError("halves", "(line_error)", "must not have a gap over the face to be mirrored",
                         "specify the deviations of the axes (misalignment), or both halves")  # fmt: skip
    pair = half.pair
    driver, driven = of_other_hand(pair.driver), of_other_hand(pair.driven)
    wide = replace(half.face, cutter=_turned(half.face.cutter), errors=replace(errors, cutting=_turned(errors.cutting)))
    return replace(
        half, pair=replace(pair, driver=driver, driven=driven, axial_offset=-pair.axial_offset), wide=wide,
        driver=_mirrored_flank(half.driver), driven=_mirrored_flank(half.driven),
    )  # fmt: skip


def _mirrored_flank(flank: FlankSpec) -> FlankSpec:
    bias = None if flank.bias is None else replace(flank.bias, amount=-flank.bias.amount)
    return replace(flank, face=_turned(flank.face), bias=bias)


def _turned(parts: tuple[FlankModification, ...]) -> tuple[FlankModification, ...]:
    return tuple(one.of if isinstance(one, MirroredModification) else MirroredModification(one) for one in parts)


def of_other_hand(gear: Gear) -> Gear:
    """The gear that mirrors one at a plane across its axis."""
    hand: Literal["left", "right"] = "left" if gear.hand == "right" else "right"
    return replace(gear, hand=hand)
