"""A REXS model as a file: components, attributes in the units of the standard, relations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

import fegear
from fegear.exchange.rexs.units import size_of

#: A table of a run: its columns in SI by name.
Columns = Mapping[str, NDArray[np.generic]]

#: Version of REXS that is written.
VERSION = "1.7"

#: Units of the standard's attributes by quantity.
_UNITS = {
    "length": "mm",
    "small length": "mum",
    "angle": "deg",
    "force": "N",
    "large force": "kN",
    "torque": "N m",
    "speed": "1 / min",
    "stress": "N / mm^2",
    "density": "kg / dm^3",
    "viscosity": "mm^2 / s",
    "temperature": "C",
    "time": "h",
    "stiffness": "N / m",
    "tilting stiffness": "N mm / rad",
    "line load": "N / mm",
    "number": "none",
    "hardness": "HV",
}


@dataclass(frozen=True, slots=True)
class Found:
    """What a run found.

    Parameters
    ----------
    values : mapping
        Single values in SI by their names.
    tables : mapping
    """

    values: Mapping[str, float] = field(default_factory=dict)
    tables: Mapping[str, Columns] = field(default_factory=dict)


@dataclass
class Part:
    """A component while it is written."""

    id: int
    type: str
    name: str
    attributes: list[tuple[str, str, str | Sequence[float]]] = field(default_factory=list)

    def say(self, quantity: str, **values: float | Sequence[float] | None) -> Part:
        """Give attributes of a quantity, in SI; None is left out."""
        unit = _UNITS[quantity]
        size = _size(quantity, unit)
        for name, value in values.items():
            if value is None:
                continue
            if isinstance(value, int | float):
                self.attributes.append((name, unit, _number(value / size)))
            else:
                self.attributes.append((name, unit, [one / size for one in value]))
        return self

    def word(self, **words: str | bool | None) -> Part:
        """Give words and truth values."""
        for name, value in words.items():
            if value is not None:
                self.attributes.append((name, "none", str(value).lower() if isinstance(value, bool) else value))
        return self


@dataclass
class Written:
    """Parts and relations of a model, and what it leaves out."""

    parts: list[Part] = field(default_factory=list)
    relations: list[tuple[str, int | None, tuple[tuple[str, Part], ...]]] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    _numbers: Iterator[int] = field(default_factory=lambda: count(1))

    def part(self, kind: str, name: str = "") -> Part:
        """Add a component."""
        made = Part(next(self._numbers), kind, name)
        self.parts.append(made)
        return made

    def relate(self, kind: str, order: int | None = None, /, **roles: Part) -> None:
        """Add a relation."""
        self.relations.append((kind, order, tuple(roles.items())))

    def text(self, date: str) -> str:
        """The file.

        Parameters
        ----------
        date : str
            By ISO 8601.
        """
        about = f'applicationId="fegear" applicationLanguage="en" applicationVersion={quoteattr(fegear.__version__)} '
        about += f'date={quoteattr(date)} version="{VERSION}"'
        lines = [
            '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>',
            f"<model {about}>",
            "  <relations>",
        ]
        for n, (kind, order, roles) in enumerate(self.relations, 1):
            place = "" if order is None else f' order="{order}"'
            lines.append(f'    <relation id="{n}"{place} type="{kind}">')
            lines += [f'      <ref hint="{one.type}" id="{one.id}" role="{role}"/>' for role, one in roles]
            lines.append("    </relation>")
        lines += ["  </relations>", "  <components>"]
        for part in self.parts:
            lines.append(f'    <component id="{part.id}" name={quoteattr(part.name)} type="{part.type}">')
            for name, unit, value in part.attributes:
                inside = escape(value) if isinstance(value, str) else _array(value)
                lines.append(f'      <attribute id="{name}" unit="{unit}">{inside}</attribute>')
            lines.append("    </component>")
        return "\n".join([*lines, "  </components>", "</model>", ""])


def _size(quantity: str, unit: str) -> float:
    kind = {"small length": "length", "large force": "force", "hardness": "hardness HV"}.get(quantity, quantity)
    return 1e3 if quantity == "line load" else size_of(unit, kind) or 1.0


def _number(value: float) -> str:
    return f"{value + 0.0:.15g}"


def _array(values: Sequence[float]) -> str:
    return "<array>" + "".join(f"<c>{_number(one)}</c>" for one in values) + "</array>"
