"""Effects that a case switches on or off: one row each, from which every list, key, table and study of them is made.

A new effect is a row here with a field of the class below it, and its place of use: a maker that reads the field.
The fields of `ToothEffects`, `RootEffects` and `FaceEffects` are those of `fegear.contact.pair_spec.PairSpec`, where
all are on unless their rows or the caller say otherwise; ``[effects]`` of a case has the same keys, where all are off.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Literal, NamedTuple


class Described(NamedTuple):
    """A pair without effects.

    Attributes
    ----------
    gears : collection of str
        Keys of its gears.
    pair : mapping
        Its own keys.
    wide, carried, moving : bool
        Whether it is loaded with its width, shafts of the case carry its gears, and the case has a train.
    rippling : bool
        Whether the train has torques that fluctuate.
    """

    gears: Collection[str]
    pair: Mapping[str, Any]
    wide: bool
    carried: bool = False
    moving: bool = False
    rippling: bool = False

    def has(self, *keys: str) -> bool:
        """Whether a gear or the pair has one of these keys."""
        return any(key in self.gears or key in self.pair for key in keys)


@dataclass(frozen=True, eq=False)
class Effect:
    """All there is to know of an effect but its mechanics.

    Parameters
    ----------
    name : str
        Key under ``[effects]``, and field of the specs of those that change loaded pairs.
    about : str
        What it is, for the key.
    without : str
        What is assumed where it is off.
    needs : str
        What it needs.
    kind : {"teeth", "flanks", "roots", "revolution", "motion"}
        How teeth give way and touch, without modifications and errors; what keeps flanks apart; what acts on root
        stress only, under loads that stay as they are (`fegear.contact.plane.root_stress`); what
        differs from tooth to tooth, over a revolution; what acts in time.
    plane, wide : bool
        Whether plane teeth have it, and teeth with a width.
    kernels : mapping of str to str
        Kernels of `fegear.base.tally` that run only with it, in scenes where nothing else calls for them, and what one
        call of each does.
    called : callable
        Whether a pair calls for it where effects start as described.
    scene : tuple of str
        Example case, and what is changed in it, in which nothing but the effect calls for its kernels.
    on, off : bool or str
        Values that switch it on and off.
    usual : bool, str or None
        What specs in Python have unless it is given; None: on.
    words : str
        What figures call it, where that is not its name.
    excludes : tuple of str
        Effects that cannot be on with it.
    alone_with_it : tuple of str
        Key of the case that has a meaning only with it, as the table and the key of each of its entries.
    """

    name: str
    about: str
    without: str
    needs: str
    kind: Literal["teeth", "flanks", "roots", "revolution", "motion"]
    kernels: Mapping[str, str]
    called: Callable[[Described], bool]
    scene: tuple[str, ...]
    plane: bool = True
    wide: bool = True
    on: bool | str = True
    off: bool | str = False
    usual: bool | str | None = None
    words: str = ""
    excludes: tuple[str, ...] = ()
    alone_with_it: tuple[str, ...] = ()

    @property
    def said(self) -> str:
        """What figures call it."""
        return self.words or self.name.replace("_", " ")


def _always(_pair: Described) -> bool:
    return True


def _moving(pair: Described) -> bool:
    return pair.moving


_ERROR = 'results=["transmission-error"]'
_CALCULIX = ("calculix_pair", "accuracy.tolerance=1e-2", "pair.I.loads=['350 N']", _ERROR)
_LIN = ("lin_tip_relief", _ERROR, "pair.I.loads=['8890 N']")
_MOTION = ("lin_dynamic_factor", 'results=["dynamic-factor"]', "dynamics.speeds=['6000 rpm', '12000 rpm']")
_SPACING = "gear.a.spacing_errors={ values = [" + ", ".join(["'5 um'", *["'0 um'"] * 27]) + "] }"
_RELIEF = "gear.a.relief={ tip = { amount = '20 um', normalised_length = 1.0 } }"


FRICTION = Effect(
    "friction", "Sliding friction between the teeth.", "frictionless flanks",
    "`parametric` where it moves, no `neighbour_coupling`, no `corner_contact`", "motion",
    {"friction fits": "friction torque of one gear pair at one speed"},
    lambda _pair: False, _MOTION,
)  # fmt: skip
CORNER_CONTACT = Effect(
    "corner_contact", "Corner contact: contact outside the path of contact due to tooth deflection.",
    "contact on the path of contact only", "no `friction`", "teeth",
    {
        "corner searches": "position and gap of tip edges outside the path of contact",
        "corner contacts": "contact law at a tip edge",
    },
    _always, _CALCULIX, excludes=(FRICTION.name,),
)  # fmt: skip
NEIGHBOUR_COUPLING = Effect(
    "neighbour_coupling", "Coupling of neighbouring teeth through the gear body.",
    "a tooth that deflects under its own load only", 'plane (2D) teeth with compliance source "fe"', "teeth",
    {"neighbours": "compliances of neighbouring teeth at many positions"},
    lambda pair: pair.pair.get("compliance", {}).get("source", "fe") == "fe",
    _CALCULIX, excludes=(FRICTION.name,),
)  # fmt: skip
HERTZ = Effect(
    "hertz", "Hertzian contact deformation: load-dependent, linearised at nominal load, or none.",
    "the contact width of the compliances, under every load", "a compliance source other than a table", "teeth",
    {"nonlinear steps": "one Newton step of load sharing with load-dependent contact stiffness"},
    _always, (*_CALCULIX, f"effects.{CORNER_CONTACT.name}=false"),
    on="load-dependent", off="none", words="load-dependent contact width",
)  # fmt: skip
RELIEF = Effect(
    "relief", "Include profile and flank line modifications.", "unmodified involute flanks",
    "`relief` on a gear; for 3D pairs also `lead`, `bias`, `topography`, and `modification` of the pair", "flanks",
    {"reliefs": "removal of a modified flank at many positions"},
    lambda pair: pair.has(
        "relief", "coast_relief", *(("lead", "coast_lead", "bias", "topography", "modification") if pair.wide else ())
    ),
    _LIN,
)  # fmt: skip
SPACING_ERRORS = Effect(
    "spacing_errors", "Include pitch deviations (`spacing_errors`).", "uniform pitch",
    "`spacing_errors` on a gear", "flanks",
    {"spacing errors": "pitch deviations of the teeth in one base pitch"},
    lambda pair: pair.has("spacing_errors"), (*_LIN, _SPACING, _RELIEF),
)  # fmt: skip
ODD_TEETH = Effect(
    "odd_teeth", "Include teeth that differ (`odd_tooth`: crack, missing, hole, pits) over a revolution and in trains.",
    "identical teeth",
    '`odd_tooth` on a gear of a plane (2D) pair with compliance source "fe" or of a 3D pair', "revolution",
    {"odd sectors": "gear with odd teeth solved by FE"},
    lambda pair: pair.has("odd_tooth"),
    ("cracked_tooth", 'results=["mesh-stiffness-revolution"]', "accuracy.tolerance=2e-2"),
)  # fmt: skip
CONTACT_LOSS = Effect(
    "contact_loss", "Loss of contact, backlash and impacts in the time domain.", "teeth always in contact",
    "results in time", "motion",
    {"changes of contact": "a change between contact and loss of contact in a motion"},
    _moving, _MOTION, alone_with_it=("train", "mesh", "backlash"),
)  # fmt: skip
PARAMETRIC = Effect(
    "parametric", "Include the time-varying mesh stiffness (parametric excitation).", "constant mean mesh stiffness",
    "results in time", "motion",
    {"springs in time": "a time-varying spring, in one integration interval"},
    _moving, (*_MOTION, f"effects.{HERTZ.name}=none"), words="time-varying stiffness",
)  # fmt: skip
TORQUE_RIPPLE = Effect(
    "torque_ripple", "Torque ripple of the train, in addition to mesh excitation.", "constant torques",
    "`train.torque_ripple`", "motion",
    {"ripple lines": "one line of a torque ripple at one speed, or in one integration interval"},
    lambda pair: pair.rippling, ("torque_ripple", 'results=["tooth-force"]'),
)  # fmt: skip
MISALIGNMENT = Effect(
    "misalignment", "Include misalignment and line errors of pairs.", "parallel axes, and flanks without line errors",
    "`misalignment` of a helical or 3D pair, `line_error` of a 3D pair, or shafts for both gears", "flanks",
    {"misaligned flanks": "a flank displaced from its nominal axis"},
    lambda pair: pair.wide and (pair.carried or pair.has("misalignment", "line_error")),
    ("litvin_shaft_angle", "tooth_contact.positions=24"), plane=False, alone_with_it=("pair", "misalignment"),
)  # fmt: skip


def _counts(effect: Effect) -> Any:
    return field(default=effect.on if effect.usual is None else effect.usual, metadata={"effect": effect})


@dataclass(frozen=True, kw_only=True)
class ToothEffects:
    """Which effects a loaded pair has, plane or with its width."""

    corner_contact: bool = _counts(CORNER_CONTACT)
    neighbour_coupling: bool = _counts(NEIGHBOUR_COUPLING)
    hertz: Literal["load-dependent", "linear", "none"] = _counts(HERTZ)
    relief: bool = _counts(RELIEF)
    spacing_errors: bool = _counts(SPACING_ERRORS)


@dataclass(frozen=True, kw_only=True)
class RootEffects:
    """Which effects change root stress and nothing else."""

    @classmethod
    def of(cls, holder: object) -> RootEffects:
        """Those of a spec, or of ``[effects]`` of a case."""
        return cls(**{one.name: getattr(holder, one.name) for one in fields(cls)})


@dataclass(frozen=True, kw_only=True)
class MotionEffects:
    """Which effects a moving train has."""

    contact_loss: bool = _counts(CONTACT_LOSS)
    friction: bool = _counts(FRICTION)
    parametric: bool = _counts(PARAMETRIC)
    torque_ripple: bool = _counts(TORQUE_RIPPLE)


@dataclass(frozen=True, kw_only=True)
class RevolutionEffects:
    """Which effects a loaded pair has only over a revolution."""

    odd_teeth: bool = _counts(ODD_TEETH)


@dataclass(frozen=True, kw_only=True)
class FaceEffects:
    """Which effects a loaded pair has only with its width."""

    misalignment: bool = _counts(MISALIGNMENT)


#: Classes whose fields are the effects, in the order in which a case and the pages list them.
GROUPS = (ToothEffects, RootEffects, RevolutionEffects, MotionEffects, FaceEffects)
#: All effects by name.
EFFECTS: Mapping[str, Effect] = {one.name: one.metadata["effect"] for group in GROUPS for one in fields(group)}


def _names(*kinds: str, **have: bool) -> tuple[str, ...]:
    return tuple(
        name for name, effect in EFFECTS.items()
        if effect.kind in kinds and all(getattr(effect, key) == value for key, value in have.items())
    )  # fmt: skip


#: How teeth give way and touch: effects of teeth without modifications and errors.
AT_REST = _names("teeth")
#: Modifications and errors of flanks, by which these leave gaps.
GAPS = _names("flanks")
#: Effects on root stress only, which results of a pair's root stress have besides.
ROOT_EFFECTS = _names("roots")
#: What counts in a case where one pair has it, not only where every pair can.
OF_SOME = _names("flanks", "revolution")
#: All that change a loaded pair, those of pairs with a width, of plane teeth, and those that change a motion.
PAIR_EFFECTS = _names("teeth", "flanks")
WIDE_EFFECTS = _names("teeth", "flanks", wide=True)
PLANE_EFFECTS = _names("teeth", "flanks", plane=True)
MOTION_EFFECTS = _names("motion")


def switched_on(*names: str) -> dict[str, bool | str]:
    """``[effects]`` of a case with these on."""
    return {name: EFFECTS[name].on for name in names}
