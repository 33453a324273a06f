"""What the mechanics needs of two gears in mesh, plane or with their width: the one form between a case and its answer.

`fegear.contact.load.load` makes a loaded pair of it. All in SI, nothing of it about files or names of keys; what is
given and has its effect off is neglected, and the answer says by how much.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self, get_args

import numpy as np

from fegear.base.arrays import Array
from fegear.base.effects import EFFECTS, MISALIGNMENT, RELIEF, SPACING_ERRORS, FaceEffects, RootEffects, ToothEffects
from fegear.base.errors import InputError
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.plausible_flanks import DEEPEST_RELIEF
from fegear.geometry.relief import CombinedRelief, Relief
from fegear.geometry.relief_spec import BiasSpec, ReliefSpec

if TYPE_CHECKING:
    from fegear.contact.odd_flank import OddFlank, ToothProfile
    from fegear.contact.wide.shaft_gaps import ShaftGaps
    from fegear.contact.wide_spec import WideSpec
    from fegear.geometry.flank_modification import FlankModification

#: How wide the teeth of a loaded pair are: a section, coupled slices of it, or solid gears.
Width = Literal["plane", "slices", "solid"]
Hertz = Literal["load-dependent", "linear", "none"]
#: Panels per module of face, where their number is not given.
_PANELS_PER_MODULE = 4.0


class ComplianceTable(NamedTuple):
    """Compliances [m/N] at positions on the line of action [m], of one tooth or of a pair of teeth, and their fit."""

    x: Array
    compliance: Array
    of: Literal["tooth", "pair"] = "tooth"
    fit: Literal["linear", "cubic"] = "cubic"


@dataclass(frozen=True)
class FlankSpec:
    """What the flanks of one gear have.

    Parameters
    ----------
    relief : ReliefSpec or None
        Profile modification.
    spacing : ndarray, shape (teeth,)
        Spacing error of each tooth in the order of meshing, removal positive [m]; empty for none.
    face : tuple of FlankModification
        Lead modifications and topography, for teeth with a width.
    bias : BiasSpec or None
        Twist, for teeth with a width.
    odd : tuple of (int, OddFlank)
        Flanks that differ from the others, by the number of the tooth in the order of meshing, for plane teeth.
    profiles : tuple of (int, ToothProfile)
        Profile modifications and deviations of single teeth likewise.
    gear : str
        Name of the gear, for messages.
    written : str
        The same in the case file, where it has another one there.
    key : str
        Key of the relief among those of the gear, for messages.
    measured : bool
        Whether the relief is a measured one, for messages.
    wrong : mapping of str to InputError
        What is wrong with the data of an effect that is off, by its name: it stops nothing.
    """

    relief: ReliefSpec | None = None
    spacing: Array = field(default_factory=lambda: np.empty(0))
    face: tuple[FlankModification, ...] = ()
    bias: BiasSpec | None = None
    odd: tuple[tuple[int, OddFlank], ...] = ()
    profiles: tuple[tuple[int, ToothProfile], ...] = ()
    gear: str = field(default="", compare=False)
    written: str = field(default="", compare=False)
    key: str = field(default="relief", compare=False)
    measured: bool = field(default=False, compare=False)
    wrong: Mapping[str, InputError] = field(default_factory=dict, compare=False)

    @property
    def wants_delta(self) -> bool:
        """Whether the relief's amount is given in Welbourn's Delta."""
        own = (profile.wants_delta for _, profile in self.profiles)
        return (self.relief is not None and self.relief.wants_delta) or any(own)

    @property
    def bare(self) -> FlankSpec:
        """The flanks of the same gear with nothing on them."""
        return FlankSpec(gear=self.gear, written=self.written)

    @property
    def over_face(self) -> bool:
        """Whether anything is modified over the face."""
        return bool(self.face) or self.bias is not None

    @property
    def prefix(self) -> str:
        """Of keys in messages."""
        name = self.written or self.gear
        return f"gear.{name}" if name else ""

    def profile(self, pair: GearPair, member: Member, delta: float = math.nan) -> Relief:
        """The relief for one gear of a pair; `delta` is Welbourn's [m].

        Raises
        ------
        InputError
            If it does not fit the gear.
        """
        if self.relief is None:
            return CombinedRelief()
        try:
            return self.relief.built(pair, member, delta)
        except InputError as error:
            inside, point, rest = error.key.partition(".")
            key = self.key + point + rest if inside == "relief" else error.key
            raise error.under(self.prefix, {error.key: key}) from None

    def surface(self, pair: GearPair, member: Member) -> tuple[FlankModification, ...]:
        """All that is modified over the face, for one gear of a pair.

        Raises
        ------
        InputError
            If it lies elsewhere than the active profile, or takes more than the tooth has.
        """
        try:
            bias = () if self.bias is None else (self.bias.built(pair, member),)
            found = (*self.face, *bias)
            _refuse_odd_flank(pair, member, found)
        except InputError as error:
            raise error.under(self.prefix) from None
        return found


def _refuse_odd_flank(pair: GearPair, member: Member, parts: tuple[FlankModification, ...]) -> None:
    from fegear.geometry.flank_modification import Topography

    gear, half = pair.gear(member), 0.5 * pair.gear(member).face_width
    low, high = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
    for part in parts:
        if isinstance(part, Topography) and (part.roll[0] >= high or part.roll[-1] <= low):
            raise InputError(
                "topography",
                f"from roll angle {math.degrees(part.roll[0]):.5g} to {math.degrees(part.roll[-1]):.5g} deg",
                f"lies outside the active profile, {math.degrees(low):.5g} to {math.degrees(high):.5g} deg",
                "check the units of its radii and angles",
            )  # fmt: skip
    kinks = [k for part in parts for k in part.face_kinks]
    z = np.union1d(np.linspace(-half, half, 65), np.clip(kinks, -half, half))
    roll = np.linspace(low, high, 33)[:, None]
    total = np.abs(sum((part.removal(roll, z) for part in parts), np.zeros((33, z.size))))
    if total.max() > DEEPEST_RELIEF * gear.module:
        raise InputError(
            "", f"lead, bias and topography of {total.max() * 1e6:.4g} um",
            f"equal {total.max() / gear.module:.3g} modules, more than the maximum of {DEEPEST_RELIEF:g} modules",
            "check the unit: modifications are some tens of micrometres",
        )  # fmt: skip


@dataclass(frozen=True)
class PairSpec(ToothEffects, RootEffects, FaceEffects):
    """Two gears in mesh, what their flanks have, their loads, and which effects count.

    Effects are those of `fegear.base.effects`, each a keyword: on unless their rows say otherwise.

    Parameters
    ----------
    pair : GearPair
        Both gears, at their centre distance.
    loads : tuple of float
        Along the transverse line of action [N].
    nominal : float
        The one of them that single numbers are for [N]; the largest by default.
    width : {"plane", "slices", "solid"}
        One plane section, coupled slices of it, or solid gears.
    compliance : str
        Of plane teeth: ``"fe"`` (of the solved gears), or the name of a formula.
    table : ComplianceTable or None
        Of plane teeth, in place of either.
    driver, driven : FlankSpec
    wide : WideSpec or None
        What only teeth with a width have: errors over the face, and how it is divided; None for plane teeth.
    name : str
        For messages.
    load_key : str
        By which key its largest load is given, for messages: "load", "loads", or one whose values are torques.
    """

    pair: GearPair
    loads: tuple[float, ...] = ()
    nominal: float = math.nan
    width: Width = "plane"
    compliance: str = "fe"
    table: ComplianceTable | None = None
    driver: FlankSpec = field(default_factory=FlankSpec)
    driven: FlankSpec = field(default_factory=FlankSpec)
    wide: WideSpec | None = None
    name: str = field(default="", compare=False)
    load_key: str = field(default="load", compare=False)

    def __post_init__(self) -> None:
        """Fill in the nominal load; refuse one that is none of the loads, and loads that are one number."""
        if np.ndim(self.loads) == 0:
            raise InputError("loads", str(self.loads), "must be a sequence of loads", f"write loads=({self.loads},)")
        if math.isnan(self.nominal):
            object.__setattr__(self, "nominal", max(self.loads, default=math.nan))
        elif self.loads and self.nominal not in self.loads:
            among = ", ".join(f"{load:.6g}" for load in sorted(self.loads))
            raise InputError("nominal", f"{self.nominal:.6g} N", f"must be one of the loads, {among} N")
        object.__setattr__(self, "loads", tuple(sorted(set(self.loads))))
        if self.width not in get_args(Width):
            among = ", ".join(f'"{one}"' for one in get_args(Width))
            raise InputError("width", f'"{self.width}"', f"must be one of {among}")
        if self.width == "plane":
            object.__setattr__(self, "wide", None)
        elif self.wide is None:
            from fegear.contact.wide_spec import WideSpec

            object.__setattr__(self, "wide", WideSpec())

    @property
    def prefix(self) -> str:
        """Of keys in messages."""
        return f"pair.{self.name}" if self.name else ""

    def is_on(self, effect: str) -> bool:
        """Whether an effect counts."""
        return bool(getattr(self, effect) != EFFECTS[effect].off)

    def with_effect(self, effect: str) -> Self:
        """The same with an effect that is off, or on in part."""
        more: dict[str, Any] = {effect: EFFECTS[effect].on}
        return replace(self, **more)

    def flanks(self, member: Member) -> FlankSpec:
        """Those of driver or driven."""
        return self.driver if member == "driver" else self.driven

    @property
    def both(self) -> tuple[FlankSpec, FlankSpec]:
        """Flanks of driver and driven."""
        return self.driver, self.driven

    @property
    def gears(self) -> tuple[str, str]:
        """Names of driver and driven."""
        return self.driver.gear, self.driven.gear

    @property
    def at_rest(self) -> PairSpec:
        """The same of perfect flanks and teeth, under no load but the one that a contact's width is taken at."""
        return replace(
            self, relief=False, spacing_errors=False, misalignment=False, loads=(),
            driver=self.driver.bare, driven=self.driven.bare,
            nominal=self.nominal if self.hertz == "linear" else math.nan,
        )  # fmt: skip

    # ---- teeth with a width ------------------------------------------------------------------------------------------
    @property
    def face(self) -> WideSpec:
        """What only teeth with a width have.

        Raises
        ------
        InputError
            If these are plane teeth.
        """
        if self.wide is None:
            raise InputError("width", f'"{self.width}"', "has no face width", 'set width = "slices" or "solid"')
        return self.wide

    @property
    def panel_count(self) -> int:
        """Parts into which the common face is divided."""
        usual = math.ceil(_PANELS_PER_MODULE * self.pair.face_width / self.pair.driver.module - 1e-9)
        return self.face.panels or max(4, usual)

    @property
    def panel(self) -> float:
        """Length of a panel [modules]."""
        return self.pair.face_width / self.panel_count / self.pair.driver.module

    @property
    def placed(self) -> GearPair:
        """The pair at the centre distance that its error leaves, if the effect `misalignment` counts it."""
        return self.misaligned if self.misalignment else self.pair

    @property
    def misaligned(self) -> GearPair:
        """The pair at the centre distance that its error leaves.

        Raises
        ------
        InputError
            If the gears do not mesh there.
        """
        apart = self.face.errors.apart
        try:
            return replace(self.pair, centre_distance=self.pair.centre_distance + apart) if apart else self.pair
        except InputError as error:
            raise error.under(".".join(filter(None, (self.prefix, "misalignment")))) from None

    def has_data(self, effect: str) -> bool:
        """Whether there is anything that an effect could count."""
        own = any(flank.relief or flank.over_face or flank.profiles for flank in self.both)
        modified = own or bool(self.wide and self.wide.cutter)
        in_delta = self.wide is not None and any(flank.wants_delta for flank in self.both)  # of plane teeth only
        given = {
            RELIEF.name: modified and not in_delta,
            SPACING_ERRORS.name: any(flank.spacing.size for flank in self.both),
            MISALIGNMENT.name: self.wide is not None and self.wide.errors.given,
        }
        return given.get(effect, True)

    def on(self, shafts: ShaftGaps) -> PairSpec:
        """The same on shafts that open other gaps."""
        return replace(self, wide=replace(self.face, errors=replace(self.face.errors, shafts=shafts)))
