"""Texts on paper: subscripts, units, and how many letters they take."""

from __future__ import annotations

import re
from typing import Any

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import (
    HeatMap,
    Points,
    TriangleField,
)
from fegear.engine.figure.panel import Panel
from fegear.output.numbers import pretty_unit

#: Letters that stand lower as letters of their own: laying out mathematics takes long.
_LOWER = str.maketrans("0123456789+−-=()aehklmnopstx", "₀₁₂₃₄₅₆₇₈₉₊₋₋₌₍₎ₐₑₕₖₗₘₙₒₚₛₜₓ")


def words(text: str) -> str:
    """Plain text for matplotlib: nothing in it is mathematics but what ``_{...}`` sets lower and no letter shows."""

    def lower(found: re.Match[str]) -> str:
        plain = found[1].translate(_LOWER)
        return rf"$_{{\mathrm{{{found[1]}}}}}$" if any(a == b for a, b in zip(plain, found[1], strict=True)) else plain

    return re.sub(r"_\{([^{}]*)\}", lower, text.replace("$", r"\$"))


def titled(label: str, unit: str) -> str:
    """Label with its unit in brackets."""
    return words(f"{label} [{pretty_unit(unit)}]" if unit else label)


def maps_of(panel: Panel) -> list[HeatMap | TriangleField | Points]:
    """Items whose colours need a scale."""
    return [
        i for i in panel.items
        if isinstance(i, (HeatMap, TriangleField)) or (isinstance(i, Points) and i.shade is not None)
    ]  # fmt: skip


def bar_label(item: HeatMap | TriangleField | Points) -> str:
    """What a scale of colours shows."""
    return words(item.shade_label) if isinstance(item, Points) else titled(item.label, item.unit)


def lines_of(axis: Axis) -> int:
    """Lines of the longest name of a category."""
    return max((name.count("\n") + 1 for name in axis.categories), default=1)


def longest_number(axis: Any) -> int:
    """Letters of the longest number at an axis."""
    low, high = sorted(axis.get_view_interval())
    places = [place for place in axis.get_majorticklocs() if low <= place <= high]
    texts = axis.get_major_formatter().format_ticks(places)
    return max((len(re.sub(r"\$|\\[a-z]+|[{}^]", "", text)) for text in texts), default=0)
