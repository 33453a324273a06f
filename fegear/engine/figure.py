"""A figure, described once and as data: what is drawn over which axes, in the units in which it is read.

Renderers draw a description as PNG, as SVG and as the report's interactive plot; they take everything from it, so they
cannot disagree. Names, labels and titles are plain text, in which ``_{...}`` sets what it holds lower.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from fegear.arrays import Array


Which = Literal["x", "y"]

#: More curves of a family than this cannot be distinguished.
MOST_CURVES = 7
#: Curves with no more points than this show them.
_FEW = 15
#: Curves that vary by less than this share of their size are drawn level, not their last digits over the whole height.
_LEVEL = 1e-3
#: Half the height of the axis of a level curve, as a share of its size.
_LEVEL_HEIGHT = 0.05
#: Marks of an axis of whole numbers.
_MOST_WHOLE = 20
#: Share of an axis that a word beside a mark takes.
_ROOM_OF_WORD = 0.045
#: Share of the axis that neighbouring bars of one place take.
_BAR_ROOM = 0.8


def fixed(values: ArrayLike) -> Array:
    """A read-only copy as floats."""
    made = np.array(values, dtype=float)
    made.setflags(write=False)
    return made


class _Item:
    """Makes the arrays of a frozen item read-only floats."""

    __slots__ = ()
    ARRAYS: ClassVar[tuple[str, ...]] = ("x", "y")

    def __post_init__(self) -> None:
        """Copy what is an array; arrays of one curve have one length."""
        for name in self.ARRAYS:
            if getattr(self, name) is not None:
                object.__setattr__(self, name, fixed(getattr(self, name)))


@dataclass(frozen=True, slots=True)
class Curve(_Item):
    """A curve; NaN makes a gap.

    Parameters
    ----------
    x, y : array_like, shape (N,)
    name : str
        Entry of the legend, which curves of one name share; empty for none.
    role : str
        What it shows, which decides its colour and dash: see `fegear.engine.colours`.
    error : array_like, shape (N,), optional
        Estimated error of y, drawn as a band.
    dash : str, optional
        ``solid``, ``dash``, ``dot``, ``dashdot`` or ``steps`` (level to the next point) in place of the role's own.
    width : float
    markers : bool, optional
        Whether the points are marked; by default where they are few.
    fill : bool
        Whether the area between it and zero is shaded.
    notes : tuple of str
        What the reader sees on pointing at each point, in place of its numbers.
    """

    x: ArrayLike
    y: ArrayLike
    name: str = ""
    role: str = "series:0"
    error: ArrayLike | None = None
    dash: str = ""
    width: float = 1.8
    markers: bool | None = None
    fill: bool = False
    notes: tuple[str, ...] = ()
    ARRAYS: ClassVar[tuple[str, ...]] = ("x", "y", "error")

    @property
    def marked(self) -> bool:
        """Whether its points are marked."""
        return np.size(self.x) <= _FEW if self.markers is None else self.markers


@dataclass(frozen=True, slots=True)
class Points(_Item):
    """Single points.

    Parameters
    ----------
    x, y : array_like, shape (N,)
    name, role : str
    symbol : str
        ``circle``, ``square``, ``diamond``, ``triangle-up``, ``triangle-down``, ``cross``, ``x`` or ``star``; the
        role's own if empty.
    size : float
    shade : array_like, shape (N,), optional
        Positive numbers that the colours show on a logarithmic scale.
    shade_label : str
        What these are, with the unit.
    error : array_like, shape (N,), optional
        Estimated error of y.
    notes : tuple of str
        What the reader sees on pointing at each point.
    written : bool
        Whether paper has the notes beside the points.
    """

    x: ArrayLike
    y: ArrayLike
    name: str = ""
    role: str = "series:0"
    symbol: str = ""
    size: float = 6.0
    shade: ArrayLike | None = None
    shade_label: str = ""
    error: ArrayLike | None = None
    notes: tuple[str, ...] = ()
    written: bool = False
    ARRAYS: ClassVar[tuple[str, ...]] = ("x", "y", "shade", "error")


@dataclass(frozen=True, slots=True)
class Bars(_Item):
    """Bars; several in one panel stand side by side, or on each other where the panel is stacked."""

    x: ArrayLike
    y: ArrayLike
    name: str = ""
    role: str = "series:0"
    error: ArrayLike | None = None
    ARRAYS: ClassVar[tuple[str, ...]] = ("x", "y", "error")


@dataclass(frozen=True, slots=True)
class Stems(_Item):
    """Lines of a spectrum: uprights with a head; `notes` is what the reader sees on pointing at each."""

    x: ArrayLike
    y: ArrayLike
    name: str = ""
    role: str = "series:0"
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class HeatMap(_Item):
    """Values over a grid.

    Parameters
    ----------
    x : array_like, shape (M,)
    y : array_like, shape (N,)
    z : array_like, shape (N, M)
        NaN where there is nothing.
    label, unit : str
    centre : (float, float), optional
        Neutral value and half the width of a scale of two colours; one scale from dark to light without.
    numbers : bool
        Whether every tile bears its number.
    limits : (float, float), optional
        Ends of the scale of colours, where several maps have one; else those of the values.
    """

    x: ArrayLike
    y: ArrayLike
    z: ArrayLike
    label: str
    unit: str = ""
    centre: tuple[float, float] | None = None
    numbers: bool = False
    limits: tuple[float, float] | None = None
    ARRAYS: ClassVar[tuple[str, ...]] = ("x", "y", "z")

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of its scale of colours."""
        if self.centre:
            return self.centre[0] - self.centre[1], self.centre[0] + self.centre[1]
        if self.limits:
            return self.limits
        found = np.asarray(self.z)[np.isfinite(self.z)]
        return (float(found.min()), float(found.max())) if found.size else (0.0, 1.0)


@dataclass(frozen=True, slots=True)
class TriangleField(_Item):
    """Values at the corners of plane triangles.

    Parameters
    ----------
    points : array_like, shape (2, N)
    triangles : ndarray of int, shape (3, M)
    values : array_like, shape (N,)
    top : float
        Where the scale of colours ends; it starts at zero.
    label, unit : str
    """

    points: ArrayLike
    triangles: NDArray[np.int64]
    values: ArrayLike
    top: float
    label: str
    unit: str = ""
    ARRAYS: ClassVar[tuple[str, ...]] = ("points", "values")


@dataclass(frozen=True, slots=True)
class Surface(_Item):
    """A surface in space over a grid of points, with its boundary; the panel is seen in perspective.

    Parameters
    ----------
    points : array_like, shape (3, M, N)
    role : str
    opacity : float
    """

    points: ArrayLike
    role: str
    opacity: float = 1.0
    ARRAYS: ClassVar[tuple[str, ...]] = ("points",)


@dataclass(frozen=True, slots=True)
class Spot(_Item):
    """A point in space beside surfaces, shape (3,)."""

    points: ArrayLike
    role: str
    ARRAYS: ClassVar[tuple[str, ...]] = ("points",)


@dataclass(frozen=True, slots=True)
class Mark:
    """A dotted line across the panel at a value of an axis, with a word beside it."""

    axis: Which
    at: float
    label: str = ""


@dataclass(frozen=True, slots=True)
class Zone:
    """A grey band across the panel between two values of an axis."""

    axis: Which
    low: float
    high: float


Item: TypeAlias = Curve | Points | Bars | Stems | HeatMap | TriangleField | Surface | Spot


@dataclass(frozen=True, slots=True)
class Scale:
    """A second scale on the far side of an axis: which value belongs to which place.

    Parameters
    ----------
    label, unit : str
    at, value : array_like, shape (N,)
        Both rising.
    """

    label: str
    unit: str
    at: ArrayLike
    value: ArrayLike

    def ticks(self) -> tuple[Array, tuple[str, ...]]:
        """Places and texts of its marks, at round values."""
        at, value = fixed(self.at), fixed(self.value)
        shown = round_numbers(float(value[0]), float(value[-1]))
        return np.interp(shown, value, at), tuple(f"{v:.6g}" for v in shown)


def round_numbers(low: float, high: float, most: int = 7) -> Array:
    """Multiples of 1, 2 or 5 times a power of ten between two values, at most so many."""
    if not high > low:
        return np.array([low])
    power = 10.0 ** math.floor(math.log10((high - low) / most))
    step = next(s * power for s in (1.0, 2.0, 5.0, 10.0) if (high - low) / (s * power) <= most)
    return fixed(np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1) * step)


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis of a panel.

    Parameters
    ----------
    label, unit : str
        The unit as in a column of a table.
    log : bool
    zero : bool
        Whether it starts at zero.
    categories : tuple of str
        Names of the places 0, 1, 2, ...
    whole : bool
        Whether only whole numbers have a meaning.
    limits : (float, float), optional
        Where some curves would stretch it too far.
    second : Scale, optional
    hidden : bool
        Without numbers: only the lines at the other axis's names.
    """

    label: str = ""
    unit: str = ""
    log: bool = False
    zero: bool = False
    categories: tuple[str, ...] = ()
    whole: bool = False
    limits: tuple[float, float] | None = None
    second: Scale | None = None
    hidden: bool = False

    def like(self, other: Axis) -> bool:
        """Whether two axes show the same thing on the same scale."""
        return (self.label, self.unit, self.log, self.categories) == (
            other.label, other.unit, other.log, other.categories,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes and what is drawn over them.

    Parameters
    ----------
    x, y : Axis
    items : tuple of items
    marks : tuple of Mark or Zone
    title : str
    height : float
        Weight among the panels of a figure.
    equal : bool
        Whether lengths along both axes are alike, as in a drawing.
    stacked : bool
        Whether bars stand on each other.
    camera : tuple of three points, optional
        Position, focal point and upward direction for surfaces.
    """

    x: Axis
    y: Axis
    items: tuple[Item, ...]
    marks: tuple[Mark | Zone, ...] = ()
    title: str = ""
    height: float = 1.0
    equal: bool = False
    stacked: bool = False
    camera: tuple[tuple[float, float, float], ...] = ()

    @property
    def limits(self) -> tuple[float, float] | None:
        """Range of the ordinate: as the axis says, or level where curves hardly vary; None where it finds itself."""
        if self.y.limits or self.y.log or self.y.zero or self.equal:
            return self.y.limits
        found = [np.asarray(i.y)[np.isfinite(i.y)] for i in self.items if isinstance(i, (Curve, Points))]
        shown = np.concatenate([np.empty(0), *found])
        if shown.size == 0 or len(found) < len(self.items):
            return None
        size, middle = float(np.abs(shown).max()), 0.5 * float(shown.min() + shown.max())
        if np.ptp(shown) >= _LEVEL * size or size == 0.0:
            return None
        return middle - _LEVEL_HEIGHT * size, middle + _LEVEL_HEIGHT * size

    def extent(self, which: Which) -> tuple[float, float]:
        """Ends of what is drawn along an axis, or of the axis where it says them."""
        axis = self.x if which == "x" else self.y
        if axis.limits:
            return axis.limits
        drawn = [getattr(item, which) for item in self.items if hasattr(item, which)]
        found = np.concatenate([np.zeros(int(axis.zero)), *(np.ravel(values) for values in drawn)])
        found = found[np.isfinite(found)]
        return (float(found.min()), float(found.max())) if found.size else (0.0, 1.0)

    def whole_step(self, which: Which) -> int:
        """Step between the marks of an axis of whole numbers."""
        low, high = self.extent(which)
        return max(1, math.ceil((high - low) / _MOST_WHOLE))

    def written(self, mark: Mark | Zone) -> str:
        """Word of a mark; none where it would lie on that of an earlier one."""
        if isinstance(mark, Zone):
            return ""
        low, high = self.extent(mark.axis)
        placed: list[float] = []
        for one in self.marks:
            if isinstance(one, Zone) or one.axis != mark.axis or not one.label:
                continue
            free = all(abs(one.at - other) >= _ROOM_OF_WORD * (high - low) for other in placed)
            if one is mark:
                return mark.label if free else ""
            placed += [one.at] if free else []
        return ""

    @property
    def foot(self) -> float:
        """Where stems stand: at zero, or below the shortest on a logarithmic scale."""
        if not self.y.log:
            return 0.0
        return 0.5 * min((float(np.min(i.y)) for i in self.items if isinstance(i, Stems) and np.size(i.y)), default=0.0)

    def bars(self) -> Iterator[tuple[Bars, Array, Array, float]]:
        """Every row of bars with the places of their middles, their feet and their width."""
        rows = [item for item in self.items if isinstance(item, Bars)]
        if not rows:
            return
        places = np.unique(np.concatenate([np.asarray(row.x) for row in rows]))
        step = float(np.diff(places).min()) if places.size > 1 else 1.0
        width = _BAR_ROOM * step / (1 if self.stacked else len(rows))
        below = dict.fromkeys(places.tolist(), 0.0)
        for number, row in enumerate(rows):
            x, y = fixed(row.x), fixed(row.y)
            foot = np.array([below[place] for place in x.tolist()]) if self.stacked else np.zeros(x.size)
            below |= dict(zip(x.tolist(), (foot + y).tolist(), strict=True))
            shift = 0.0 if self.stacked else (number - 0.5 * (len(rows) - 1)) * width
            yield row, x + shift, foot, width


@dataclass(frozen=True, slots=True)
class View:
    """One choice of a figure: the page shows one at a time behind a menu, paper shows them side by side.

    Parameters
    ----------
    label : str
        In the menu.
    panels : tuple of Panel
    key : str
        Where every view is a picture of its own: the stem of its file.
    """

    label: str
    panels: tuple[Panel, ...]
    key: str = ""


@dataclass(frozen=True, slots=True)
class MeshField:
    """Values at the nodes of six-node triangles, for other programs: written to ``fields/<name>.vtu``.

    Parameters
    ----------
    name : str
    points : array_like, shape (2, N)
        [mm].
    triangles : ndarray of int, shape (6, M)
    values : mapping of str to ndarray
    """

    name: str
    points: ArrayLike
    triangles: NDArray[np.int64]
    values: Mapping[str, Array]


@dataclass(frozen=True, slots=True)
class Figure:
    """What one figure shows.

    Parameters
    ----------
    key : str
        Unique among the figures of a run; stem of the picture's file.
    title, caption : str
    panels : tuple of Panel
        One above the other.
    views : tuple of View
        In place of `panels`, where there is a choice; all have the same number of panels.
    columns : int
        How many panels paper has side by side.
    most_views : int
        How many views paper has at most, evenly chosen.
    field : MeshField, optional
        What it shows a part of.
    """

    key: str
    title: str
    caption: str
    panels: tuple[Panel, ...] = ()
    views: tuple[View, ...] = ()
    columns: int = 1
    most_views: int = 4
    field: MeshField | None = None

    def __post_init__(self) -> None:
        """Give a figure without a choice its only view."""
        if not self.views:
            object.__setattr__(self, "views", (View("", self.panels),))

    @property
    def all_panels(self) -> tuple[Panel, ...]:
        """The panels of every view."""
        return tuple(panel for view in self.views for panel in view.panels)

    @property
    def drawable_in_page(self) -> bool:
        """Whether a page can draw it itself; fields and surfaces stand there as pictures."""
        still = (TriangleField, Surface)
        return not any(isinstance(item, still) for panel in self.all_panels for item in panel.items)

    def _repr_html_(self) -> str | None:
        """Show it in a notebook, where a renderer has been imported (``import fegear.output.draw_plotly``)."""
        return NOTEBOOK[0](self) if NOTEBOOK else None


#: What shows a figure in a notebook; the renderer puts itself here.
NOTEBOOK: list[Callable[[Figure], str]] = []


@dataclass(frozen=True, slots=True)
class DeferredFigure:
    """A figure that costs something to describe: made only where pictures are drawn.

    Parameters
    ----------
    key, title : str
        As the figure's.
    make : callable
        Without arguments -> `Figure`.
    """

    key: str
    title: str
    make: Callable[[], Figure]


def polylines(lines: Iterable[Array]) -> Array:
    """Several lines, each of shape (2, N), as one with gaps."""
    gap = np.full((2, 1), np.nan)
    return np.hstack([part for line in lines for part in (line, gap)])


def edges(points: Array, chains: NDArray[np.int64]) -> Array:
    """Lines through chains of points (2, N), one for each column of the chains (k, M), as one with gaps."""
    gap = np.full((2, 1, chains.shape[1]), np.nan)
    return np.concatenate([points[:, chains], gap], axis=1).transpose(0, 2, 1).reshape(2, -1)


def outline(points: Array, name: str = "", role: str = "outline", width: float = 1.8, dash: str = "") -> Curve:
    """A line of a drawing, shape (2, N), without marked points."""
    return Curve(points[0], points[1], name, role, dash=dash, width=width, markers=False)


def few(count: int, keep: Sequence[int] = (), most: int = MOST_CURVES) -> list[int]:
    """At most so many of a family, evenly chosen, with those to keep."""
    if count <= most:
        return list(range(count))
    return sorted({round(i) for i in np.linspace(0, count - 1, most)} | set(keep))


def ramp(count: int) -> list[str]:
    """Roles of an ordered family, from the lowest to the highest."""
    return [f"ramp:{i / (count - 1):.3f}" if count > 1 else "ramp:0.700" for i in range(count)]
