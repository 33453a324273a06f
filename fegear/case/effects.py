"""``[effects]``: what a case calls for; everything is off unless named, or called for by what the case describes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, get_type_hints

from pydantic import Field, ValidationInfo, create_model, field_validator

from fegear.base.effects import (
    EFFECTS,
    GROUPS,
    OF_SOME,
    Described,
    FaceEffects,
    MotionEffects,
    RevolutionEffects,
    RootEffects,
    ToothEffects,
)
from fegear.case.part import Part


class _Switches(Part):
    """Physical effects by name."""

    start: Literal["none", "described"] = Field(
        default="none",
        description="Initial state of all effects: `none`, or those required by the gears and pairs described (as in "
        "Python). Effects set here take precedence.",
    )

    @field_validator("*", mode="before")
    @classmethod
    def _as_others(cls, value: object, info: ValidationInfo) -> object:
        """An effect with words for its kinds takes true and false as all the others do."""
        effect = EFFECTS.get(info.field_name or "")
        if effect is None or isinstance(effect.off, bool) or not isinstance(value, bool):
            return value
        return effect.on if value else effect.off

    def is_on(self, name: str) -> bool:
        """Whether an effect is switched on."""
        return bool(getattr(self, name) != EFFECTS[name].off)

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


if TYPE_CHECKING:

    class EffectsPart(_Switches, ToothEffects, RootEffects, RevolutionEffects, MotionEffects, FaceEffects):  # type: ignore[misc]  # frozen by pydantic
        """Physical effects by name."""

else:  # the same fields, all off
    EffectsPart = create_model(
        "EffectsPart", __base__=_Switches, __module__=__name__, __doc__=_Switches.__doc__,
        **{
            name: (kind, Field(default=EFFECTS[name].off, description=EFFECTS[name].about))
            for group in GROUPS for name, kind in get_type_hints(group).items()
        },
    )  # fmt: skip


def started(effects: EffectsPart, pairs: Sequence[Described]) -> EffectsPart:
    """Effects of a case with those that its pairs call for, where they start as described; named ones stay as they are.

    What flanks or single teeth have counts where one pair has it; how teeth give way and touch, where every pair can.
    """
    if effects.start == "none" or not pairs:
        return effects
    on = {
        name: effect.on for name, effect in EFFECTS.items()
        if name not in effects.model_fields_set
        and (any if name in OF_SOME else all)(effect.called(pair) for pair in pairs)
    }  # fmt: skip
    # Not `model_copy`, which would take them for named ones.
    return EffectsPart.model_construct(effects.model_fields_set, **{**dict(effects), **on})
