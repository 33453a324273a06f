"""Inputs declared once: dimension, meaning and bounds stand at the field of the spec that takes them; twin of `shown`.

    @dataclass(frozen=True)
    class Section:
        length: float = given("length", "Length of the section.", above=0.0)
        inner: float = given("length", "Bore diameter; 0: solid.", default=0.0, at_least=0.0)

Numbers are in SI. A table of a case has the same keys from here (`fegear.case.derived.keys_of`); rules between keys are
written out there, and what no spec can be made of is refused by the spec itself.
"""

from __future__ import annotations

from dataclasses import MISSING, dataclass, field, fields
from typing import Any

_KEY = "given"


@dataclass(frozen=True, slots=True)
class Given:
    """How an input is asked for.

    Parameters
    ----------
    dimension : str
        A key of `fegear.base.units.DIMENSIONS`; empty for numbers, names and switches.
    meaning : str
        A sentence for who fills it in.
    above, at_least, at_most : float, optional
        Bounds of what may be written, in SI; None where there is none.
    """

    dimension: str
    meaning: str
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None


def given(
    dimension: str = "",
    meaning: str = "",
    *,
    default: Any = MISSING,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    **options: Any,
) -> Any:
    """Declare an input of a spec.

    Parameters
    ----------
    dimension, meaning : str
    default : object
        None for what follows from something else; without it the input is required.
    above, at_least, at_most : float, optional
        Bounds of what may be written, in SI.
    **options
        Of `dataclasses.field`: ``compare``, ``kw_only``, ...
    """
    how = Given(dimension, meaning, above, at_least, at_most)
    return field(default=default, metadata={_KEY: how}, **options)


def all_given(spec: type) -> dict[str, Given]:
    """Inputs that a spec declares, by the names of its fields and in their order."""
    return {entry.name: entry.metadata[_KEY] for entry in fields(spec) if _KEY in entry.metadata}
