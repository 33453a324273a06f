"""What a model says, asked attribute by attribute: values in SI, and what was asked for and found."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, shown
from fegear.base.unit_text import plain_number
from fegear.exchange.rexs.units import size_of, units_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.exchange.rexs.model import Attribute, Component, Model

Vector = tuple[float, float, float]
Frame = tuple[Vector, Vector, Vector]
#: Largest number that stands for something: beyond it programs mean infinity.
RIGID = 1e15


@dataclass
class Said:
    """A model under one load case, and a record of what has been read of it.

    Parameters
    ----------
    model : Model
    loaded : mapping
        Attributes under the load case, by the components' numbers; they come before those of the components.
    used : set of (int, str)
        Numbers of components and names of attributes that entered the case.
    notes : list of str
        What was assumed or not used, for the user.
    turn : three unit vectors, optional
        Axes along which vectors of the model are read, in place of its own u, v and w.
    across : set of int
        Shafts that do not run along u.
    """

    model: Model
    loaded: Mapping[int, Mapping[str, Attribute]] = field(default_factory=dict)
    used: set[tuple[int, str]] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)
    turn: Frame | None = None
    across: set[int] = field(default_factory=set)

    @cached_property
    def arrays_lost(self) -> bool:
        """Whether a program wrote its arrays, so vectors too, as truth values."""
        parts = self.model.components.values()
        return any(
            one.value is False for part in parts for one in part.attributes.values() if one.name.endswith("_vector")
        )

    def attributes_of(self, component: Component) -> Mapping[str, Attribute]:
        """All that a component says under the load case, by names."""
        return {**component.attributes, **self.loaded.get(component.id, {})}

    def found(self, component: Component, *names: str) -> Attribute | None:
        """The first of some attributes that a component has, and a record that it was used."""
        given = self.attributes_of(component)
        for name in names:
            one = given.get(name)
            if one is not None and one.value != "":
                self.used.add((component.id, name))
                return one
        return None

    def number(self, component: Component, quantity: str, *names: str) -> float | None:
        """A number in SI, by the first of its names that is there; None without any.

        Raises
        ------
        InputError
            If it is no number, not finite, or has no unit of the quantity.
        """
        one = self.found(component, *names)
        return None if one is None else _in_si(one, one.value, component, quantity)

    def needed(self, component: Component, quantity: str, *names: str) -> float:
        """The same of what no case can do without."""
        value = self.number(component, quantity, *names)
        if value is None:
            rule = f"is missing in {component.said} {shown(component.name)}"
            raise InputError(names[0], "(not given)", rule, "complete the model in its source program")
        return value

    def whole(self, component: Component, *names: str) -> int:
        """A whole number, as numbers of teeth; a missing one is refused."""
        value = self.needed(component, "number", *names)
        if value != round(value):
            raise InputError(names[0], f"{value:g}", f"is not an integer in {component.said}", "correct the model")
        return round(value)

    def vector(self, component: Component, name: str) -> Vector | None:
        """Three components along u, v and w in SI (mm); None without."""
        one = self.found(component, name)
        if one is None or self._is_truth(one, component):
            return None
        if not isinstance(one.value, tuple) or len(one.value) != 3:
            raise InputError(
                name, shown(one.value), f"must have three entries in {component.said}", "correct the model"
            )
        u, v, w = (_in_si(one, part, component, "length") for part in one.value)
        if self.turn is not None:
            u, v, w = (axis[0] * u + axis[1] * v + axis[2] * w for axis in self.turn)
        return u, v, w

    def word(self, component: Component, *names: str) -> str | None:
        """A word or a name; None without, or where a truth value stands in its place."""
        one = self.found(component, *names)
        return None if one is None or self._is_truth(one, component) else str(one.value)

    def _is_truth(self, one: Attribute, component: Component) -> bool:
        """Whether a truth value stands where none is meant, as some programs write what they could not; a note then."""
        if isinstance(one.value, bool):
            self.used.discard((component.id, one.name))
            self.notes.append(f"{component.said}: boolean {one.name} ignored.")
        return isinstance(one.value, bool)

    def yes(self, component: Component, name: str) -> bool | None:
        """Whether something holds; None where nothing is said, or where a program wrote its arrays as false."""
        one = self.found(component, name)
        if one is not None and one.value is False and self.arrays_lost:
            self.used.discard((component.id, name))
            self.notes.append(f"{component.said}: {name} is false, as are all arrays of this model; ignored.")
            return None
        # Of what differs between gears of a gearbox that shifts, the first counts.
        value = one.value[0] if one is not None and isinstance(one.value, tuple) and one.value else one and one.value
        return None if one is None else str(value).lower() == "true"

    def linked(self, component: Component, role: str, kind: str, other: str, *types: str) -> list[Component]:
        """Components of these types that relations link to one; as `Model.linked`."""
        return [one for one in self.model.linked(component, role, kind, other) if not types or one.type in types]


def _in_si(one: Attribute, value: object, component: Component, quantity: str) -> float:
    size = size_of(one.unit, quantity)
    if size is None:
        rule = f"has an invalid unit for {quantity} in {component.said}"
        raise InputError(one.name, f"{value} {one.unit}".rstrip(), rule, f"those of REXS are {units_of(quantity)}")
    number = _plain(value)
    if number is None or not math.isfinite(number * size):
        raise InputError(one.name, shown(value), f"is not a finite number in {component.said}", "correct the model")
    return number * size


def _plain(value: object) -> float | None:
    """A number of JSON, or one that XML writes in ASCII digits; None for anything else."""
    if isinstance(value, str):
        return plain_number(value)
    try:
        return None if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
    except OverflowError:  # one of hundreds of digits
        return None
