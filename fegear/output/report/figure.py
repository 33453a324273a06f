"""Interactive figures, described: panels of curves whose numbers are columns of tables.

A figure holds no numbers of its own: where plotly expects an array, it says which column of which table stands there.
The page's script (``page.js``) reads the columns from the CSV files that the page carries, so a table is in the page
once. The vocabulary of such references is small:

======================== ==================================================================================
``{"$": "column"}``      a column of a table, of the rows that `where` picks
``{"$": "size"}``        root of the sum of squares of two (real and imaginary part)
``{"$": "centred"}``     less its mean
``{"$": "log"}``         decadic logarithm
``{"$": "short"}``       as texts of five digits, for names on an axis
``{"$": "rows"}``        several columns side by side, for hover texts
``{"$": "by"}``          largest or smallest value for each value of a key
``{"$": "unique"}``      different values in order
``{"$": "grid"}``        values over two keys, one row for each value of the first
``{"$": "coordinates"}`` lines through uprights, one for each row, with gaps between
======================== ==================================================================================

Colours are names of the house's palette (``@blue``), so that the script can choose the shade for light and dark pages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from fegear.output.report.numbers import pretty_unit

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.engine.outcome import Table

Reference = dict[str, Any]

#: Names that the page's script turns into shades; told apart by all kinds of colour vision.
COLOURS = ("@blue", "@orange", "@green", "@red", "@purple", "@sky")
DASHES = ("solid", "dash", "dashdot", "dot", "longdash", "longdashdot")
SYMBOLS = ("circle", "square", "triangle-up", "diamond", "triangle-down", "cross")


def ramp(count: int) -> list[str]:
    """Colours for an ordered family of curves, from the lowest to the highest."""
    return [f"@ramp:{i / max(count - 1, 1):.3f}" for i in range(count)]


def heading(table: Table, name: str) -> str:
    """Unit of a column as people read it; empty where it has none."""
    return next(pretty_unit(column.unit) for column in table.columns if column.name == name)


def has(table: Table, name: str) -> bool:
    """Whether a table has a column."""
    return any(column.name == name for column in table.columns)


def column(table: Table, name: str, where: Mapping[str, object] | None = None) -> Reference:
    """Refer to a column.

    Parameters
    ----------
    table : Table
    name : str
    where : mapping, optional
        Column names and the cell that a row must have there, as the CSV file writes it; or ``("min", number)``,
        ``("max", number)``, ``("between", lowest, first that is too large)``.
    """
    names = [c.name for c in table.columns]
    told: Reference = {"$": "column", "table": table.name, "column": names.index(name)}
    if where:
        # JSON has no infinity, and the script takes null for none.
        told["where"] = [
            [names.index(key), [_finite(x) for x in v] if isinstance(v, tuple) else str(v)] for key, v in where.items()
        ]
    return told


def _finite(item: object) -> object:
    return None if isinstance(item, float) and not math.isfinite(item) else item


def size(real: Reference, imaginary: Reference) -> Reference:
    """Refer to the size of a complex quantity."""
    return {"$": "size", "of": [real, imaginary]}


def unique(of: Reference) -> Reference:
    """Refer to the different values of a column, in order."""
    return {"$": "unique", "of": of}


@dataclass
class Figure:
    """One plot: panels above each other over the same kind of abscissa.

    Parameters
    ----------
    key : str
        Unique in the page; where a picture file has the same stem, the plot takes its place in the page.
    title, caption : str
    """

    key: str
    title: str
    caption: str = ""
    panels: list[Panel] = field(default_factory=list)
    menu: list[tuple[str, list[int], str]] = field(default_factory=list)
    shared: bool = True

    def panel(self, x: str, y: str, **options: Any) -> Panel:
        """Add a panel with axis titles that name the unit in brackets; see `Panel` for the options."""
        made = Panel(self, len(self.panels) + 1, x, y, **options)
        self.panels.append(made)
        return made

    @property
    def traces(self) -> list[dict[str, Any]]:
        """All traces, in the order of the panels."""
        return [trace for panel in self.panels for trace in panel.traces]

    def choose(self, label: str, traces: Sequence[dict[str, Any]], ordinate: str = "") -> None:
        """Make some traces an entry of the figure's menu, with the ordinate's title where each has its own.

        The first entry is shown at first. Call it when all traces are there.
        """
        every = [id(trace) for trace in self.traces]
        self.menu.append((label, [every.index(id(trace)) for trace in traces], ordinate))

    def spec(self) -> dict[str, Any]:
        """Return what the page's script draws."""
        return {
            "key": self.key,
            "traces": self.traces,
            "panels": [panel.spec() for panel in self.panels],
            "menu": self.menu,
            "shared": self.shared,
        }


@dataclass
class Panel:
    """One pair of axes of a figure.

    Parameters
    ----------
    figure : Figure
    number : int
    x, y : str
        Titles; a unit stands in brackets behind.
    log_x, log_y : bool
    zero : bool
        Whether the ordinate starts at zero.
    height : float
        Weight among the figure's panels.
    categories : bool
        Whether the abscissa's values are names.
    title : str
        Above the panel.
    limits : (float, float), optional
        Of the ordinate, where some curves would stretch it too far.
    bare : bool
        Without an ordinate: only uprights at the abscissa's names.
    """

    figure: Figure
    number: int
    x: str
    y: str
    log_x: bool = False
    log_y: bool = False
    zero: bool = False
    height: float = 1.0
    categories: bool = False
    title: str = ""
    limits: tuple[float, float] | None = None
    bare: bool = False
    marks: list[tuple[str, object, str]] = field(default_factory=list)
    traces: list[dict[str, Any]] = field(default_factory=list)

    def spec(self) -> dict[str, Any]:
        """Return what the script needs of the axes."""
        return {
            "x": self.x, "y": self.y, "logX": self.log_x, "logY": self.log_y, "zero": self.zero,
            "height": self.height, "categories": self.categories, "title": self.title, "marks": self.marks,
            "limits": self.limits, "bare": self.bare,
        }  # fmt: skip

    def mark(self, axis: str, at: float | Reference, label: str = "") -> None:
        """Draw a dotted line at a value of ``"x"`` or ``"y"``, with a word beside it."""
        self.marks.append((axis, at, label))

    def add(
        self, name: str, x: Reference | Sequence[object], y: Reference | Sequence[object], **look: Any
    ) -> Reference:
        """Add a trace; traces of one name share an entry of the legend."""
        unit = self.y[self.y.rfind("[") + 1 : -1] if self.y.endswith("]") else ""
        first = all(trace["name"] != name or not trace["showlegend"] for trace in self.figure.traces)
        trace = {
            "type": "scatter", "mode": "lines", "name": name, "legendgroup": name, "showlegend": first, "x": x, "y": y,
            "panel": self.number, "hovertemplate": "%{y:.6~g}" + (f" {unit}" if unit else ""),
        } | look  # fmt: skip
        self.traces.append(trace)
        return trace

    def line(
        self, table: Table, x: str, y: str | Reference, name: str, number: int = 0, *, error: str | None = None,
        where: Mapping[str, object] | None = None, colour: str | None = None, dash: str | None = None, **look: Any,
    ) -> Reference:  # fmt: skip
        """Add a curve of two columns, with a band of its estimated error where there is a column of it."""
        values = column(table, y, where) if isinstance(y, str) else y
        style = {"color": colour or COLOURS[number % 6], "dash": dash or DASHES[number % 6]}
        at = column(table, x, where)
        if len(table.columns[0].values) <= _FEW:
            look.setdefault("mode", "lines+markers")
        if error is None:
            return self.add(name, at, values, line=style, **look)
        spread = column(table, error, where)
        self.traces.append({
            "type": "scatter", "mode": "lines", "name": name, "legendgroup": name, "showlegend": False,
            "band": [at, values, spread], "fill": "toself", "fillcolor": style["color"] + "/0.25",
            "line": {"width": 0}, "hoverinfo": "skip", "panel": self.number,
        })  # fmt: skip
        unit = self.y[self.y.rfind("[") + 1 : -1] if self.y.endswith("]") else ""
        hover = f"%{{y:.6~g}} ± %{{customdata:.1~e}} {unit}".rstrip()
        return self.add(name, at, values, **{"line": style, "customdata": spread, "hovertemplate": hover} | look)

    def points(
        self, table: Table, x: str, y: str, name: str, number: int = 0, where: Mapping[str, object] | None = None,
        **look: Any,
    ) -> Reference:  # fmt: skip
        """Add points of two columns."""
        style = {"color": COLOURS[number % 6], "symbol": SYMBOLS[number % 6], "size": 6}
        look = {"marker": style | look.pop("marker", {})} | look
        return self.add(name, column(table, x, where), column(table, y, where), mode="markers", **look)

    def bars(
        self, table: Table, x: str, y: str, name: str, colour: str, where: Mapping[str, object] | None = None,
        **look: Any,
    ) -> Reference:  # fmt: skip
        """Add bars of two columns, side by side with those of other names."""
        at, height = column(table, x, where), column(table, y, where)
        if self.categories:
            at = {"$": "short", "of": at}
        return self.add(name, at, height, type="bar", mode=None, marker={"color": colour}, **look)

    def heat(
        self, table: Table, x: str, y: str, z: str, label: str, where: Mapping[str, object] | None = None,
        *, diverging: tuple[float, float] | None = None, **look: Any,
    ) -> Reference:  # fmt: skip
        """Add a heat map of a column over two others; `diverging` is its neutral value and half its scale's width."""
        keys = column(table, y, where), column(table, x, where)
        grid = {"$": "grid", "rows": keys[0], "columns": keys[1], "values": column(table, z, where)}
        scale: dict[str, Any] = {"colorscale": "@ramp"}
        if diverging:
            middle, half = diverging
            scale = {"colorscale": "@diverging", "zmin": middle - half, "zmax": middle + half}
        unit = f" {heading(table, z)}".rstrip()
        name = self.x.split(" [")[0], self.y.split(" [")[0]
        hover = f"{name[0]} %{{x}}<br>{name[1]} %{{y}}<br>{z.replace('_', ' ')} %{{z:.5~g}}{unit}<extra></extra>"
        return self.add(
            label, unique(keys[1]), unique(keys[0]), type="heatmap", mode=None, z=grid, showlegend=False,
            colorbar={"title": {"text": label, "side": "right"}}, hovertemplate=hover, **scale, **look,
        )  # fmt: skip


#: Curves with no more points than this show them.
_FEW = 15
