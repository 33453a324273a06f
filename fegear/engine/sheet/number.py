"""Single numbers of a sheet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fegear.engine.declared import value_of
from fegear.engine.sheet.seen import Seen, Text, Where, reach
from fegear.engine.value import Value


def exact(_seen: Seen) -> float:
    """Error of a number in which nothing is estimated."""
    return 0.0


@dataclass(frozen=True)
class Number:
    """A declared quantity as a single value with its error; one that is not a number is no value.

    Parameters
    ----------
    quantity : str
        Its attribute, or the path to it (``path.load``); ``{key}`` for the one that a repetition names.
    error : where, optional
        Its estimated error, one number or one for each load; unknown where it is None.
    of : where
        What declares it. None there: no value.
    si : where, optional
        A number in its place; None there: no value.
    owner, name, meaning, ending, further : text
        The value's name is ``owner.name``; by default that of the subject and of the quantity. `ending` follows the
        declared name, `further` the declared meaning.
    each, when : where, optional
        Objects for each of which there is such a value; whether there is one.
    zero : where, optional
        Whether it is meant to be zero, see `Value`.
    choice : bool
        Whether it is chosen among equally good ones, see `Value`.
    finite : bool
        Whether an infinite one is no value either.
    """

    quantity: str
    error: Where | None = None
    of: Where = ""
    si: Where | None = None
    owner: Text = "{name}"
    name: Text = ""
    meaning: Text = ""
    further: Text = ""
    each: Where | None = None
    when: Where | None = None
    finite: bool = False
    ending: Text = ""
    zero: Where | None = None
    choice: bool = False

    def values(self, seen: Seen) -> Iterator[Value]:
        """Those that there are."""
        for one in seen.each(self.each):
            if not one.holds(self.when) or (found := one.find(self.of)) is None:
                continue
            quantity = one.said(self.quantity)
            number = getattr(*reach(found, quantity)) if self.si is None else one.find(self.si)
            if number is None or (np.ndim(number) == 0 and (np.isnan(number) or (self.finite and np.isinf(number)))):
                continue
            error = None if self.error is None else one.find(self.error)
            if error is not None:
                error = float(error if np.ndim(error) == 0 or one.nominal is None else error[one.nominal])
            made = value_of(
                *reach(found, quantity), one.said(self.owner), error, si=number,
                load=one.nominal, name=one.said(self.name), ending=one.said(self.ending),
                meaning=one.said(self.meaning), further=one.said(self.further),
            )  # fmt: skip
            zero = self.zero is not None and one.holds(self.zero)
            yield replace(made, zero=zero, choice=self.choice) if zero or self.choice else made
