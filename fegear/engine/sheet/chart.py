"""Figures of a sheet: curves, bars, stems and maps of declared quantities over one of them, a panel each.

What a figure is made of is imported when one is made: a plan reads sheets and draws nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import declared
from fegear.engine.declared import axis_of, drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.family import MOST_CURVES, few, ramp
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.load_words import load_words
from fegear.engine.sheet.seen import Seen, Text, Where, reach

if TYPE_CHECKING:
    from fegear.engine.figure.figure import Figure
    from fegear.engine.figure.items import HeatMap, Item, Mark, Zone
    from fegear.engine.figure.panel import Panel


@dataclass(frozen=True)
class Family:
    """Objects for each of which a panel has a curve.

    Parameters
    ----------
    of : where
        A mapping of names to objects, or a sequence of objects.
    label : text
        Of a member: ``{key}`` is its name, ``{one.…}`` what it declares.
    role : text
        ``series`` for members without order, ``ramp`` for ordered ones; else the role of all, or a text that gives it.
    most : int or None
        More are not drawn: evenly chosen, the first and the last among them. None: all are.
    keep : where, optional
        Numbers of the members that are drawn whatever is chosen, in place of the first and the last.
    """

    of: Where
    label: Text = "{key}"
    role: Text = "series"
    most: int | None = MOST_CURVES
    keep: Where | None = None


#: As many members of a family as there are.
ALL = 10**6
#: The loads of a pair: as many as can be told apart, the nominal one among them.
LOADS: Literal["loads"] = "loads"


@dataclass(frozen=True)
class Line:
    """A declared quantity drawn over another, each named by its attribute or by the path to it (``path.load``).

    Parameters
    ----------
    y : str
        None there: no line. A single number is drawn level. Of several that are alike, as x, one that the object of a
        repetition names: ``{key}``.
    label, role : text
        Of the legend and of the look, blue if empty; a family has its own, which a bundle's lines may replace.
    error : where, optional
        Estimated error of y in SI, drawn as a band.
    si : where, optional
        Numbers in place of the quantity's own; None there: no line.
    x : str
        Quantity that it is drawn over, where it is not the panel's.
    x_si : where, optional
        Numbers in place of that quantity's own.
    of : where, optional
        What declares both, if it is not what the chart is of: an object, or a sequence of them with a point each. None
        there: no line.
    each : Family or LOADS, optional
        Members for each of which there is one.
    kind : {"curve", "bars", "stems", "points"}
    look : mapping or function
        Further options of the item: ``dash``, ``width``, ``markers``, ``fill``, ``symbol``, ``size``, ``notes``.
    when : where, optional
        Whether it is drawn.
    first : int, optional
        How many points are drawn at most, from the first.
    ends : bool
        Whether the first and the last point are joined only, as those of level lines.
    """

    y: str
    label: Text = ""
    role: Text = ""
    error: Where | None = None
    x: str = ""
    of: Where | None = None
    each: Family | Literal["loads"] | None = None
    kind: Literal["curve", "bars", "stems", "points"] = "curve"
    look: Mapping[str, Any] | Callable[[Seen], Mapping[str, Any]] = field(default_factory=dict)
    when: Where | None = None
    first: int | None = None
    ends: bool = False
    si: Where | None = None
    x_si: Where | None = None


@dataclass(frozen=True)
class Bundle:
    """Several lines for each member of a family, in the member's colour, with labels of their own."""

    family: Family
    lines: tuple[Line, ...]
    when: Where | None = None


@dataclass(frozen=True)
class Map:
    """A declared quantity over a grid of two others, as colours.

    Parameters
    ----------
    z : str
        Of shape (N, M) for N numbers of y and M of x; None there: no map.
    y : str
    x : str
        Where it is not the panel's.
    si : where, optional
        Numbers in place of the quantity's own.
    label : text
        Of the colours; the declared one if empty.
    of, when : where, optional
        As those of a line.
    limits : where, optional
        Ends of the colours in SI, where they are not those of the numbers.
    centre : where, optional
        Neutral number and half the width of a scale of two colours, in SI.
    numbers : bool
        Whether every tile bears its number.
    """

    z: str
    y: str
    x: str = ""
    label: Text = ""
    of: Where | None = None
    when: Where | None = None
    limits: Where | None = None
    centre: Where | None = None
    numbers: bool = False
    si: Where | None = None


@dataclass(frozen=True)
class Over:
    """One panel, or one for each of some objects.

    Parameters
    ----------
    x : str or Axis or function
        Abscissa: a quantity, or an axis of its own, whose numbers are those of the lines' `x`.
    y : str or Axis or function
        Ordinate: a quantity of what the panel is of; that of the first line if empty.
    lines : tuple of Line, Bundle, Map or str
    marks : where, optional
        Marks and zones across the panel.
    options : mapping
        Of the ordinate where it is a quantity: ``zero``, ``log``, ``limits``.
    x_options : mapping
        Of the abscissa where it is a quantity: ``log``, ``whole``, ``second``.
    title : text
    panel : mapping
        Further options of the panel: ``height``, ``stacked``.
    each, of : where, optional
        Objects for each of which there is such a panel, and what declares the quantities where the chart's `of` does
        not: by default the object itself.
    when : where, optional
    """

    x: str | Axis | Callable[[Seen], Axis]
    lines: tuple[Line | Bundle | Map | str, ...]
    y: str | Axis | Callable[[Seen], Axis] = ""
    marks: Where | None = None
    options: dict[str, Any] = field(default_factory=dict)
    x_options: dict[str, Any] = field(default_factory=dict)
    title: Text = ""
    panel: dict[str, Any] = field(default_factory=dict)
    each: Where | None = None
    of: Where | None = None
    when: Where | None = None


@dataclass(frozen=True)
class Chart:
    """A figure.

    Parameters
    ----------
    name, title, caption : text
    panels : tuple of Over, or Each of these
    of : where
        What declares the quantities. None there: no figure.
    each, when : where, optional
        Objects for each of which there is such a figure; whether there is one.
    under : text
        Load or speed that all of it holds for; LOADS for the load of a pair that has one only.
    columns, most_views : int or where, int
        As those of `Figure`.
    views : where, optional
        Objects for each of which the figure has a view with all panels; paths of these begin there, and the object
        declares their quantities.
    view : text
        Label of a view.
    """

    name: Text
    title: Text
    caption: Text
    panels: tuple[Over | Each, ...]
    of: Where = ""
    each: Where | None = None
    when: Where | None = None
    under: Text = ""
    columns: int | Where = 1
    views: Where | None = None
    view: Text = "{key}"
    most_views: int = 4

    def figures(self, seen: Seen) -> Iterator[Figure]:
        """Those that there are."""
        from fegear.engine.figure.figure import Figure, View

        for one in seen.each(self.each):
            if not one.holds(self.when) or (owner := one.find(self.of)) is None:
                continue
            under = _only_load(one) if self.under == LOADS else one.said(self.under)
            panels = self._all_panels(one, owner) if self.views is None else ()
            views = () if self.views is None else tuple(
                View(each.said(self.view), self._all_panels(each, each.one)) for each in one.each(self.views)
            )  # fmt: skip
            columns = self.columns if isinstance(self.columns, int) else one.find(self.columns)
            yield Figure(
                one.said(self.name), one.said(self.title), one.said(self.caption), panels, views, columns,
                self.most_views, under=under,
            )  # fmt: skip

    def _all_panels(self, seen: Seen, owner: Any) -> tuple[Panel, ...]:
        return tuple(panel for over in self.panels for panel in _panels(seen, owner, over))


def _only_load(seen: Seen) -> str:
    """The load that a figure holds for, where the pair has one only; else its legend names them."""
    return load_words(seen.loads[0]) if len(seen.loads) == 1 else ""


def _panels(seen: Seen, owner: Any, over: Over | Each) -> Iterator[Panel]:
    if isinstance(over, Each):
        for one in seen.each(over.where):
            if one.holds(over.when):
                for element in over.elements:
                    yield from _panels(one, one.one, element)
        return
    if not seen.holds(over.when):
        return
    for member in seen.each(over.each):
        if over.of is not None:
            yield _panel(member, member.find(over.of), over)
        else:
            yield _panel(member, owner if over.each is None else member.one, over)


def _panel(seen: Seen, owner: Any, over: Over) -> Panel:
    from fegear.engine.figure.panel import Panel

    lines = [Line(one) if isinstance(one, str) else one for one in over.lines]
    lines = [line for line in lines if seen.holds(line.when)]
    x = _axis(seen, owner, over.x, over.x_options)
    if over.y:
        y = _axis(seen, owner, over.y, over.options)
    else:
        first = replace(lines[0].lines[0], each=lines[0].family) if isinstance(lines[0], Bundle) else lines[0]
        y = _axis(seen, _owner(seen, owner, first), first.y, over.options)
    base = over.x if isinstance(over.x, str) else "x"
    items = tuple(item for line in lines for item in _items(seen, owner, line, base))
    marks: tuple[Mark | Zone, ...] = () if over.marks is None else tuple(seen.find(over.marks))
    return Panel(x, y, items, marks, seen.said(over.title), **over.panel)


def _axis(seen: Seen, owner: Any, what: str | Axis | Callable[[Seen], Axis], options: dict[str, Any]) -> Axis:
    if isinstance(what, Axis):
        return what
    return axis_of(*reach(_first(owner), what), **options) if isinstance(what, str) else what(seen)


def _first(owner: Any) -> Any:
    """What declares the quantities of a sequence of objects."""
    return owner[0] if isinstance(owner, Sequence) else owner


def _drawn(owner: Any, quantity: str, si: Any = None, *, load: int | None = None) -> Array:
    """Numbers of a quantity as they are drawn, of a sequence of objects one of each."""
    if si is None and isinstance(owner, Sequence):
        si = [getattr(*reach(one, quantity)) for one in owner]
    return drawn(*reach(_first(owner), quantity), si, load=load)


def _owner(seen: Seen, owner: Any, line: Line | Map) -> Any:
    """What declares a line's quantities: the first member of a family."""
    if isinstance(line, Line) and isinstance(line.each, Family):
        first = next(iter(seen.each(line.each.of)))
        return first.one if line.of is None else first.find(line.of)
    return owner if line.of is None else seen.find(line.of)


def _items(seen: Seen, owner: Any, line: Line | Bundle | Map, base: str) -> Iterator[Item]:
    if isinstance(line, Map):
        if (found := _owner(seen, owner, line)) is not None and _there(seen, found, line.z, line.si):
            yield _map(seen, found, line, line.x or base)
    elif isinstance(line, Bundle):
        yield from _bundle(seen, line, base)
    elif isinstance(line.each, Family):
        alone = replace(line, label=line.label or line.each.label, when=None)  # the panel asked for all
        yield from _bundle(seen, Bundle(line.each, (alone,)), base)
    elif line.each is None:
        if (found := _owner(seen, owner, line)) is not None and _there(seen, found, line.y, line.si):
            yield _item(seen, found, line, base, seen.said(line.label), seen.said(line.role) or "blue", seen.nominal)
    else:
        found = _owner(seen, owner, line)
        for load, label, role in drawn_loads(seen):
            yield _item(seen, found, line, base, label, role, load, banded=load == seen.nominal)


def _there(seen: Seen, owner: Any, quantity: str, si: Where | None) -> bool:
    """Whether there is anything to be drawn of a quantity."""
    return (getattr(*reach(_first(owner), seen.said(quantity))) if si is None else seen.find(si)) is not None


def _bundle(seen: Seen, bundle: Bundle, base: str) -> Iterator[Item]:
    """Lines of every member that is drawn."""
    family, members = bundle.family, list(seen.each(bundle.family.of))
    keep = (0, len(members) - 1) if family.keep is None else seen.find(family.keep)
    chosen = few(len(members), keep, len(members) if family.most is None else family.most)
    for k, role in zip(chosen, _roles(family.role, chosen), strict=True):
        member = members[k]
        for line in bundle.lines:
            found = member.one if line.of is None else member.find(line.of)
            if not member.holds(line.when) or found is None or not _there(member, found, line.y, line.si):
                continue
            look = member.said(line.role) or member.said(role)
            yield _item(member, found, line, base, member.said(line.label), look, seen.nominal)


def _roles(role: Text, chosen: list[int]) -> list[Text]:
    if role == "ramp":
        return [*ramp(len(chosen))]
    return [f"series:{k}" if role == "series" else role for k in chosen]


def drawn_loads(seen: Seen) -> list[tuple[int, str, str]]:
    """Index, label and role of the loads that are drawn: all, or evenly many with the nominal one."""
    loads, nominal = seen.loads, seen.nominal or 0
    chosen = few(len(loads), (nominal,))
    labels = [load_words(loads[i]) + (" (nominal)" if i == nominal and len(loads) > 1 else "") for i in chosen]
    return list(zip(chosen, labels, ramp(len(chosen)), strict=True))


def _item(
    seen: Seen, owner: Any, line: Line, base: str, label: str, role: str, load: int | None, *, banded: bool = True
) -> Item:  # fmt: skip
    """One curve, row of bars or of stems, in the units in which its quantities are read."""
    from fegear.engine.figure.items import Bars, Curve, Points, Stems

    upto, x, quantity = slice(line.first), seen.said(line.x) or base, seen.said(line.y)
    si, x_si = (None if where is None else seen.find(where) for where in (line.si, line.x_si))
    along, y = _drawn(owner, x, x_si, load=load)[upto], _drawn(owner, quantity, si, load=load)
    y = y[upto] if y.ndim else np.full(along.shape, y)
    if line.ends:
        along, y = along[[0, -1]], y[[0, -1]]
    error = None if line.error is None or not banded else seen.find(line.error)
    if error is not None:
        error = _drawn(owner, quantity, error[..., load] if load is not None and np.ndim(error) > 1 else error)[upto]
    look = line.look(seen) if callable(line.look) else line.look
    if line.kind == "bars":
        return Bars(along, y, label, role, error)
    if line.kind == "stems":
        return Stems(along, y, label, role, **look)
    if line.kind == "points":
        return Points(along, y, label, role, error=error, **look)
    return Curve(along, y, label, role, error, **look)


def _map(seen: Seen, owner: Any, spec: Map, x: str) -> HeatMap:
    """Colours over a grid, in the units in which its quantities are read."""
    from fegear.engine.figure.items import HeatMap

    (of, quantity), si = reach(owner, spec.z), None if spec.si is None else seen.find(spec.si)
    how = declared(of if isinstance(of, type) else type(of), quantity)

    def pair(where: Where | None) -> tuple[float, float] | None:
        if where is None:
            return None
        one, other = drawn(of, quantity, seen.find(where)).tolist()
        return one, other

    return HeatMap(
        drawn(*reach(owner, x)), drawn(*reach(owner, spec.y)), drawn(of, quantity, si),
        seen.said(spec.label) or how.label, how.unit, pair(spec.centre), spec.numbers,
        pair(spec.limits),
    )  # fmt: skip
