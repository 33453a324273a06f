"""``[effects]``: what a case calls for; everything is off unless named, or called for by what the case describes."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field

from fegear.case.part import Part
from fegear.contact.effects import GAPS


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


@dataclass(frozen=True, slots=True)
class Effect:
    """What there is to know of an effect besides what it is.

    Parameters
    ----------
    needs : str
        What it needs.
    kernels : tuple of str
        Kernels of `fegear.base.tally.KERNELS` that run only with it, in scenes where nothing else calls for them.
    called : callable
        Whether a pair calls for it where effects start as described.
    on : bool or str
        Value that switches it on.
    words : str
        What figures call it, where that is not its name.
    """

    needs: str
    kernels: tuple[str, ...]
    called: Callable[[Described], bool]
    on: bool | str = True
    words: str = ""


def _always(_pair: Described) -> bool:
    return True


def _moving(pair: Described) -> bool:
    return pair.moving


class EffectsPart(Part):
    """Physical effects by name."""

    start: Literal["none", "described"] = Field(
        default="none",
        description="Initial state of all effects: `none`, or those required by the gears and pairs described (as in "
        "Python). Effects set here take precedence.",
    )
    corner_contact: Annotated[bool, Effect("no `friction`", ("corner searches", "corner contacts"), _always)] = Field(
        default=False, description="Corner contact: contact outside the path of contact due to tooth deflection."
    )
    neighbour_coupling: Annotated[
        bool,
        Effect(
            'plane (2D) teeth with compliance source "fe"', ("neighbours",),
            lambda pair: pair.pair.get("compliance", {}).get("source", "fe") == "fe",
        ),
    ] = Field(default=False, description="Coupling of neighbouring teeth through the gear body.")  # fmt: skip
    hertz: Annotated[
        Literal["load-dependent", "linear", "none"],
        Effect(
            "a compliance source other than a table",
            ("nonlinear steps",),
            _always,
            on="load-dependent",
            words="load-dependent contact width",
        ),
    ] = Field(
        default="none",
        description="Hertzian contact deformation: load-dependent, linearised at nominal load, or none.",
    )
    relief: Annotated[
        bool,
        Effect(
            "`relief` on a gear; for 3D pairs also `lead`, `bias`, `topography`, and `modification` of the pair",
            ("reliefs",),
            lambda pair: pair.has("relief", *(("lead", "bias", "topography", "modification") if pair.wide else ())),
        ),
    ] = Field(default=False, description="Include profile and flank line modifications.")
    spacing_errors: Annotated[
        bool,
        Effect("`spacing_errors` on a gear", ("spacing errors",), lambda pair: pair.has("spacing_errors")),
    ] = Field(default=False, description="Include pitch deviations (`spacing_errors`).")
    contact_loss: Annotated[bool, Effect("results in time", ("changes of contact",), _moving)] = Field(
        default=False, description="Loss of contact, backlash and impacts in the time domain."
    )
    friction: Annotated[
        bool,
        Effect(
            "`parametric` where it moves, no `neighbour_coupling`, no `corner_contact`", ("friction fits",),
            lambda _pair: False,
        ),
    ] = Field(default=False, description="Sliding friction between the teeth.")  # fmt: skip
    parametric: Annotated[
        bool,
        Effect(
            "results in time", ("springs in time",), _moving, words="time-varying stiffness"
        ),
    ] = Field(default=False, description="Include the time-varying mesh stiffness (parametric "
                                         "excitation).")  # fmt: skip
    torque_ripple: Annotated[
        bool,
        Effect("`train.torque_ripple`", ("ripple lines",), lambda pair: pair.rippling),
    ] = Field(default=False, description="Torque ripple of the train, in addition to mesh excitation.")
    misalignment: Annotated[
        bool,
        Effect(
            "`misalignment` of a helical or 3D pair, `line_error` of a 3D pair, or shafts for both gears",
            ("misaligned flanks",),
            lambda pair: pair.wide and (pair.carried or pair.has("misalignment", "line_error")),
        ),
    ] = Field(default=False, description="Include misalignment and line errors of pairs.")

    def is_on(self, name: str) -> bool:
        """Whether an effect is switched on."""
        return getattr(self, name) not in (False, "none")

    def example(self, name: str) -> str:
        """Value that switches an effect on, as a case file writes it."""
        return json.dumps(EFFECTS[name].on)

    def on(self) -> tuple[str, ...]:
        """Names of the effects that are on."""
        return tuple(name for name in EFFECTS if self.is_on(name))

    @property
    def named(self) -> frozenset[str]:
        """Names of the effects that the case itself switches on or off."""
        return frozenset(self.model_fields_set)


#: What there is to know of each effect, by its name.
EFFECTS: dict[str, Effect] = {
    name: next(one for one in field.metadata if isinstance(one, Effect))
    for name, field in EffectsPart.model_fields.items()
    if name != "start"
}


def started(effects: EffectsPart, pairs: Sequence[Described]) -> EffectsPart:
    """Effects of a case with those that its pairs call for, where they start as described; named ones stay as they are.

    What flanks have counts where one pair has it; how teeth give way and touch, where every pair can.
    """
    if effects.start == "none" or not pairs:
        return effects
    on = {
        name: effect.on for name, effect in EFFECTS.items()
        if name not in effects.model_fields_set
        and (any if name in GAPS else all)(effect.called(pair) for pair in pairs)
    }  # fmt: skip
    # Not `model_copy`, which would take them for named ones.
    return EffectsPart.model_construct(effects.model_fields_set, **{**dict(effects), **on})
