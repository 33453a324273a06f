"""What a sheet is filled from: a result's data, what was asked, its loads; and where in these a quantity stands."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from fegear.base.printed import percent, rounded, unit_said
from fegear.base.shown import declared
from fegear.base.units import from_si
from fegear.engine.sheet.load_words import load_words
from fegear.engine.value import Value

#: Where something stands: a path of attributes and of names in mappings ("found.errors.load") from what is shown, or a
#: function of all that is seen. A path that meets None ends there.
Where: TypeAlias = "str | Callable[[Seen], Any]"
#: A sentence or a word: a text with fields in braces (see `Seen.said`), or a function of all that is seen.
Text: TypeAlias = "str | Callable[[Seen], str]"


@dataclass(frozen=True)
class Seen:
    """All that tables, values and figures of one result are filled from.

    Parameters
    ----------
    data : object
        Of a class that declares what it shows (`fegear.base.shown`), or that holds such objects.
    asked : object
        What the result was asked for.
    name : str
        Of the gear, pair, mesh or train.
    loads : sequence of float
        Last axis of what is known for several loads [N]; empty where there is no such axis.
    nominal : int or None
        Which of them single numbers are for.
    key, one : str, object
        Name and object for which an element is repeated (``each``); paths then begin there.
    values : mapping of str to Value
        Single values of the sheet by their names, for its answer.
    """

    data: Any
    asked: Any = None
    name: str = ""
    loads: Sequence[float] = ()
    nominal: int | None = None
    key: str = ""
    one: Any = None
    values: Mapping[str, Value] = field(default_factory=dict)

    def find(self, where: Where) -> Any:
        """What stands there; all that is shown for an empty path, None where a path ends at None."""
        if not isinstance(where, str):
            return where(self)
        found = self.data if self.one is None else self.one
        for attribute in where.split(".") if where else ():
            if found is None:
                return None
            found = found[attribute] if isinstance(found, Mapping) else getattr(found, attribute)
        return found

    def said(self, text: Text) -> str:
        """A text with its fields filled in.

        Fields are ``{name}``, ``{key}``, ``{load}`` (nominal, in N; ``{load:said}`` as the case gives it, by the torque
        or by the force, and so of every load in N), ``{d.…}`` for the data, ``{one.…}`` for the
        object of this repetition and ``{asked.…}``. A declared quantity stands in its unit, which follows it:
        ``{d.te_peak_to_peak:.3g}`` gives ``4.69 µm``, ``{d.te_peak_to_peak:.3g!}`` the number only; of several loads
        that of the nominal one is meant. ``{v[te_peak_to_peak]}`` is a single value of the subject, rounded to what its
        error allows and to three digits; ``:2`` two digits, ``:!`` without the unit, ``:%`` a share in per cent.

        Raises
        ------
        MissingValueError
            If there is no such single value.
        """
        if not isinstance(text, str):
            return text(self)
        if "{" not in text:
            return text
        load = None if self.nominal is None or not len(self.loads) else _Float(self.loads[self.nominal])
        read = {"d": self.data, "one": self.one, "asked": self.asked}
        return text.format(
            name=self.name, key=self.key, load=load, v=_Values(self.values, (self.name, self.key)),
            **{word: _Read(owner, self.nominal) for word, owner in read.items() if owner is not None},
        )  # fmt: skip

    def each(self, where: Where | None) -> Iterator[Seen]:
        """Itself where nothing is repeated; else once for each member of a mapping or of a sequence of objects."""
        if where is None:
            yield self
            return
        members = self.find(where)
        if members is None:
            return
        pairs = members.items() if isinstance(members, Mapping) else ((str(k), one) for k, one in enumerate(members))
        for key, one in pairs:
            yield replace(self, key=str(key), one=one)

    def holds(self, when: Where | None) -> bool:
        """Whether a condition holds: something stands there, and it is neither false, empty nor zero."""
        if when is None:
            return True
        found = self.find(when)
        return bool(np.size(found)) if isinstance(found, np.ndarray) else bool(found)


def itself(seen: Seen) -> Any:
    """The member of this repetition, where it is numbers: ``Cell("energy", itself, ..., each="energies")``."""
    return seen.one


def reach(owner: Any, quantity: str) -> tuple[Any, str]:
    """What declares a quantity, and its attribute there: ``path.load`` is ``load`` of ``owner.path``."""
    *path, attribute = quantity.split(".")
    for one in path:
        owner = owner[one] if isinstance(owner, Mapping) else getattr(owner, one)
    return owner, attribute


class MissingValueError(KeyError):
    """A sentence names a single value that there is not."""


class _Values:
    """Single values by their names, that of the subject left out."""

    __slots__ = ("_owners", "_values")

    def __init__(self, values: Mapping[str, Value], owners: Sequence[str]) -> None:
        self._values, self._owners = values, owners

    def __getitem__(self, name: str) -> _Rounded:
        for full in (*(f"{owner}.{name}" for owner in self._owners if owner), name):
            if full in self._values:
                return _Rounded(self._values[full])
        raise MissingValueError(name)


class _Rounded:
    """A single value that is written as a person says it."""

    __slots__ = ("_value",)

    def __init__(self, value: Value) -> None:
        self._value = value

    def __format__(self, spec: str) -> str:
        if spec == "%":
            return percent(self._value.value)
        digits = spec.removesuffix(_ONLY)
        number = rounded(self._value.value, self._value.error, int(digits) if digits else _SAID)
        return number if spec.endswith(_ONLY) else f"{number} {unit_said(self._value.unit)}".rstrip()


#: Digits of a number in an answer.
_SAID = 3
#: The format of a load as the case gives it.
_SAID_LOAD = "said"
#: Ends the format of a number without its unit.
_ONLY = "!"


class _Read:
    """An object whose declared quantities are written with their units in a text."""

    __slots__ = ("_load", "_owner")

    def __init__(self, owner: Any, load: int | None) -> None:
        self._owner, self._load = owner, load

    def __getattr__(self, attribute: str) -> Any:
        found = getattr(self._owner, attribute)
        try:
            unit = declared(type(self._owner), attribute).unit
        except TypeError:
            if isinstance(found, float):
                return _Float(found)
            return found if isinstance(found, (str, int)) or found is None else _Read(found, self._load)
        if isinstance(found, str):
            return found
        if is_dataclass(found):  # several quantities under one name
            return _Read(found, self._load)
        return _Number(found[self._load] if np.ndim(found) and self._load is not None else found, unit)

    def __format__(self, spec: str) -> str:
        return format(self._owner, spec)


class _Float(float):
    """A number that is written as it is, a load also as the case gives it."""

    __slots__ = ()

    def __format__(self, spec: str) -> str:
        return load_words(self) if spec == _SAID_LOAD else super().__format__(spec)


class _Number:
    """A number of SI that is written in a unit."""

    __slots__ = ("_si", "_unit")

    def __init__(self, si: Any, unit: str) -> None:
        self._si, self._unit = si, unit

    def __format__(self, spec: str) -> str:
        if spec == _SAID_LOAD:
            return load_words(float(self._si))
        number = float(self._si) * (from_si(self._unit) if self._unit else 1.0)
        if spec.endswith(_ONLY):
            return format(number, spec.removesuffix(_ONLY))
        return f"{number:{spec}} {unit_said(self._unit)}".rstrip()
