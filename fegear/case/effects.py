"""``[effects]``: what a case calls for; everything is off unless named."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field

from fegear.case.part import Part


class Described(NamedTuple):
    """A pair without effects: keys of its gears, its own keys, and whether it is loaded with its width."""

    gears: Collection[str]
    pair: Mapping[str, Any]
    wide: bool

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
        Whether a question about a pair, asked without a case file, calls for it.
    of : {"teeth", "flanks", "motion"}
        Whether it is about how teeth give way and touch, about modifications and errors that their flanks have, or
        about how a train moves.
    plane : bool
        Whether plane teeth know it, as those with a width do.
    on : bool or str
        Value that switches it on.
    """

    needs: str
    kernels: tuple[str, ...]
    called: Callable[[Described], bool]
    of: Literal["teeth", "flanks", "motion"] = "teeth"
    plane: bool = True
    on: bool | str = True


def _always(_pair: Described) -> bool:
    return True


class EffectsPart(Part):
    """Physical effects by name."""

    corner_contact: Annotated[bool, Effect("no `friction`", ("corner searches", "corner contacts"), _always)] = Field(
        default=False, description="Whether deflected teeth meet before and after the nominal path of contact."
    )
    neighbour_coupling: Annotated[
        bool,
        Effect(
            'compliance source "fe" of plane teeth', ("neighbours",),
            lambda pair: pair.pair.get("compliance", {}).get("source", "fe") == "fe",
        ),
    ] = Field(default=False, description="Whether a loaded tooth bends its neighbours through the body.")  # fmt: skip
    hertz: Annotated[
        Literal["load-dependent", "linear", "none"],
        Effect("a source with a contact of its own: no table", ("nonlinear steps",), _always, on="load-dependent"),
    ] = Field(
        default="none",
        description="Contact deformation: as it grows with the load, linearised at the nominal load, or neglected.",
    )
    relief: Annotated[
        bool,
        Effect(
            "`relief` on a gear; for pairs with a width also `lead`, `bias`, `topography`, and `modification` of the "
            "pair",
            ("reliefs",),
            lambda pair: pair.has("relief", *(("lead", "bias", "topography", "modification") if pair.wide else ())),
            of="flanks",
        ),
    ] = Field(default=False, description="Whether profile and flank modifications count.")
    spacing_errors: Annotated[
        bool,
        Effect("`spacing_errors` on a gear", ("spacing errors",), lambda pair: pair.has("spacing_errors"), of="flanks"),
    ] = Field(default=False, description="Whether spacing errors of the teeth count.")
    contact_loss: Annotated[bool, Effect("results in time", ("changes of contact",), _always, of="motion")] = Field(
        default=False, description="Loss of contact and impacts in motion."
    )
    friction: Annotated[
        bool,
        Effect(
            "`parametric` where it moves, no `neighbour_coupling`, no `corner_contact`", ("friction fits",),
            lambda _pair: False, of="motion",
        ),
    ] = Field(default=False, description="Sliding friction between the teeth.")  # fmt: skip
    parametric: Annotated[bool, Effect("results in time", ("springs in time",), _always, of="motion")] = Field(
        default=False, description="Whether the mesh stiffness varies in time."
    )
    misalignment: Annotated[
        bool,
        Effect(
            "`misalignment` of a helical pair or of one with a width, `line_error` of one with a width, or shafts that "
            "carry both its gears",
            ("misaligned flanks",),
            lambda pair: pair.wide and pair.has("misalignment", "line_error"),
            of="flanks",
            plane=False,
        ),
    ] = Field(default=False, description="Whether misalignment and line errors of a pair count.")

    def is_on(self, name: str) -> bool:
        """Whether an effect is switched on."""
        return getattr(self, name) not in (False, "none")

    def example(self, name: str) -> str:
        """Value that switches an effect on, as a case file writes it."""
        return json.dumps(EFFECTS[name].on)

    def on(self) -> tuple[str, ...]:
        """Names of the effects that are on."""
        return tuple(name for name in type(self).model_fields if self.is_on(name))

    def only(self, names: Collection[str]) -> EffectsPart:
        """These effects as they are, the others off."""
        return EffectsPart(**{name: getattr(self, name) for name in names})


#: What there is to know of each effect, by its name.
EFFECTS: dict[str, Effect] = {
    name: next(one for one in field.metadata if isinstance(one, Effect))
    for name, field in EffectsPart.model_fields.items()
}


#: Effects that change loaded pairs: those with a width, and those of plane teeth.
WIDE_EFFECTS = tuple(name for name, effect in EFFECTS.items() if effect.of != "motion")
PLANE_EFFECTS = tuple(name for name in WIDE_EFFECTS if EFFECTS[name].plane)
#: Those of plane teeth that a pair without modifications and errors has.
AT_REST = tuple(name for name in PLANE_EFFECTS if EFFECTS[name].of == "teeth")
#: Those of wide pairs by which their flanks leave gaps.
GAPS = tuple(name for name in WIDE_EFFECTS if EFFECTS[name].of == "flanks")


def called_for(pair: Described) -> dict[str, bool | str]:
    """Effects that a question about a pair calls for, as a case file has them."""
    return {name: effect.on for name, effect in EFFECTS.items() if effect.called(pair)}
