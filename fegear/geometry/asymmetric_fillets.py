"""A tooth with two different flanks whose fillets, one or both, are other curves than the tool's.

Both fillets of a tooth space meet at one root circle. Where one of them ends there, the other one may go on up to it:
the lowest line of the space need not be the middle of what the tool makes. As of generated teeth the centre line of the
tooth is chosen so that the middle of the root land that both leave lies half a pitch beside it; a fillet is given from
the centre line of the tooth as its tool makes it, and the tooth is turned by half the difference of both root lands.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, cast

from fegear.base.errors import GeometryError
from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalSide, AsymmetricInternalTooth
from fegear.geometry.asymmetric_tooth import AsymmetricSide, AsymmetricTooth
from fegear.geometry.fillet_curves import turned_curve
from fegear.geometry.fillet_shapes import EllipseOnSpace, FilletShape
from fegear.geometry.flank_above import FlankAbove, Foot
from fegear.geometry.involute_side import FLANKS, Flank, InvoluteSide, TakenOver
from fegear.geometry.shaped_side import FilletKey, ShapedSide
from fegear.geometry.two_flanks import OneOfTwoFlanks, TwoFlanks

#: Keys by which the fillets of both sides are given.
FILLET_KEYS: dict[Flank, FilletKey] = {"drive": "fillet", "coast": "coast_fillet"}


@dataclass(frozen=True)
class AsymmetricFilletsTooth(TakenOver, TwoFlanks["AsymmetricFilletSide"]):
    """A tooth with a flank for driving and another one for coasting, and fillets of its own.

    Parameters
    ----------
    generated : AsymmetricTooth or AsymmetricInternalTooth
        The tooth as its tool makes it.
    drive_fillet, coast_fillet : FilletShape, optional
        Fillet below either flank, in the frame of `generated`; by default that of the tool.

    Raises
    ------
    GeometryError
        If a fillet does not join root circle and flank, both overlap or end at different root circles, or leave no
        tooth; keys begin with "fillet", of the coast side with "coast_fillet".
    """

    generated: AsymmetricTooth | AsymmetricInternalTooth
    drive_fillet: FilletShape | None = None
    coast_fillet: FilletShape | None = None

    def __post_init__(self) -> None:
        """Take over what the tool decides, and refuse fillets of no tooth."""
        self.take_over(self.generated)
        for flank in FLANKS:
            with _of(flank):
                self.side(flank).check_fillet()

    def _seen_from(self, flank: Flank) -> AsymmetricFilletSide:
        internal = isinstance(self.generated, AsymmetricInternalTooth)
        return (AsymmetricFilletRingSide if internal else AsymmetricFilletSide)(self, flank)

    def angle(self, flank: Flank) -> float:
        """Pressure angle of a flank [rad]."""
        return self.generated.angle(flank)

    def shape(self, flank: Flank) -> FilletShape | None:
        """Fillet below a flank; None of that of the tool."""
        return self.drive_fillet if flank == "drive" else self.coast_fillet

    @property
    def reversed(self) -> AsymmetricFilletsTooth:
        """The tooth with its flanks exchanged, as of a gear turned round on its shaft."""
        return AsymmetricFilletsTooth(self.generated.reversed, self.coast_fillet, self.drive_fillet)

    @cached_property
    def _feet(self) -> dict[Flank, Foot]:
        """Both fillets in the frame of the generated tooth; the second one ends where the first one does."""
        found: dict[Flank, Foot] = {}
        for flank in self._order:
            made, shape = self.generated.side(flank), self.shape(flank)
            if shape is None:
                found[flank] = Foot(
                    made.fillet, made.form_roll, made.root_radius, made.root_land_half_angle, made.undercut
                )
                continue
            with _of(flank):
                found[flank] = shape.below(_above(made, next(iter(found.values()), None)))
        return found

    @property
    def _order(self) -> tuple[Flank, Flank]:
        """First the fillet that goes as far as it is given: what the tool makes, or no ellipse."""
        drive, coast = self.drive_fillet, self.coast_fillet
        follows = drive is not None and (
            coast is None or (isinstance(drive, EllipseOnSpace) and not isinstance(coast, EllipseOnSpace))
        )
        return ("coast", "drive") if follows else ("drive", "coast")

    @cached_property
    def turn(self) -> float:
        """Angle by which its drive flank lies farther from the centre line than of the generated tooth [rad]."""
        feet = self._feet
        return 0.5 * (feet["drive"].root_land_half_angle - feet["coast"].root_land_half_angle)

    def foot(self, flank: Flank) -> Foot:
        """Fillet below a flank, in the frame of the tooth."""
        feet = self._feet
        land = max(0.5 * sum(one.root_land_half_angle for one in feet.values()), 0.0)
        turn = self.turn if flank == "drive" else -self.turn
        fillet = feet[flank].fillet if turn == 0.0 else turned_curve(feet[flank].fillet, turn)
        return feet[flank]._replace(fillet=fillet, root_land_half_angle=land)


@dataclass(frozen=True)
class AsymmetricFilletSide(ShapedSide, OneOfTwoFlanks[AsymmetricFilletsTooth]):
    """Such a tooth seen from one of its flanks.

    Parameters
    ----------
    tooth : AsymmetricFilletsTooth
    flank : {"drive", "coast"}
    """

    @cached_property
    def foot(self) -> Foot:
        """The fillet below the flank, in the tooth's frame."""
        return self.tooth.foot(self.flank)

    @property
    def fillet_key(self) -> FilletKey | None:
        """By which its fillet is given; None where it is the tool's."""
        return None if self.tooth.shape(self.flank) is None else FILLET_KEYS[self.flank]

    @property
    def as_generated(self) -> AsymmetricSide | AsymmetricInternalSide:
        """The side as its tool makes it."""
        return self.tooth.generated.side(self.flank)

    @property
    def turn(self) -> float:
        """Angle by which the flank lies farther from the centre line than of the generated tooth [rad]."""
        return self.tooth.turn if self.flank == "drive" else -self.tooth.turn

    @property
    def pressure_angle(self) -> float:
        """alpha_t of this flank [rad]."""
        return self.as_generated.pressure_angle

    @property
    def base_half_angle(self) -> float:
        """psi_b, angle from the centre line at which the involute leaves the base circle [rad]."""
        return self.as_generated.base_half_angle + self.turn


class AsymmetricFilletRingSide(AsymmetricFilletSide):
    """The same of an internal gear."""

    side: ClassVar[int] = -1


def with_fillets(
    side: AsymmetricSide | AsymmetricInternalSide | AsymmetricFilletSide, **shapes: FilletShape | None
) -> AsymmetricSide | AsymmetricInternalSide | AsymmetricFilletSide:
    """A tooth with other fillets, seen from the same flank; as generated with none.

    Parameters
    ----------
    side : AsymmetricSide, AsymmetricInternalSide or AsymmetricFilletSide
    **shapes : FilletShape, optional
        By flank, ``drive`` and ``coast``, in the frame of the generated tooth; what is not named stays.
    """
    tooth, given = side.tooth, shapes
    if isinstance(tooth, AsymmetricFilletsTooth):
        given = {"drive": tooth.drive_fillet, "coast": tooth.coast_fillet, **shapes}
        tooth = tooth.generated
    if not any(given.values()):
        return tooth.side(side.flank)
    return AsymmetricFilletsTooth(tooth, given.get("drive"), given.get("coast")).side(side.flank)


def kept_land(side: InvoluteSide) -> float:
    """Angle beyond the middle of the generated tooth space at which the fillet of the other side ends [rad]."""
    back = side.back
    return back.root_land_half_angle + (back.turn if isinstance(back, AsymmetricFilletSide) else 0.0)


def _above(side: AsymmetricSide | AsymmetricInternalSide, other: Foot | None) -> FlankAbove:
    """What a fillet is fitted to, beside the other fillet of its tooth space or before that one."""
    return FlankAbove(
        side.base_radius, side.base_half_angle, side.side, math.pi / side.teeth, side.root_radius, side.form_radius,
        None if other is None else other.root_radius, None if other is None else other.root_land_half_angle,
    )  # fmt: skip


@contextmanager
def _of(flank: Flank) -> Iterator[None]:
    """Refuse a fillet under the key of its side."""
    try:
        yield
    except GeometryError as error:
        if not error.key.startswith("fillet"):
            raise
        key = FILLET_KEYS[flank] + error.key.removeprefix("fillet")
        raise GeometryError(key, cast("str", error.value), error.rule, error.remedy) from None
