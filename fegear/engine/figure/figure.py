"""A figure: its panels or views, its title and the sentence below it.

A pair of axes with what is drawn over them, and the ranges, marks and bars that follow from it.

Axes of a panel: what they show, in which unit, on which scale.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Alike, Array
from fegear.engine.figure.items import (
    Bars,
    Curve,
    Item,
    Mark,
    Points,
    Skin,
    Stems,
    Surface,
    TriangleField,
    Which,
    Zone,
    fixed,
)


@dataclass(frozen=True, slots=True)
class View(Alike):
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
class MeshField(Alike):
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
class SolidMeshField(Alike):
    """Values at the nodes of fifteen-node wedges, for other programs: written to ``fields/<name>.vtu``.

    Parameters
    ----------
    name : str
    points : array_like, shape (3, N)
        [mm].
    wedges : ndarray of int, shape (15, M)
    values : mapping of str to ndarray
    """

    name: str
    points: ArrayLike
    wedges: NDArray[np.int64]
    values: Mapping[str, Array]


@dataclass(frozen=True, slots=True, repr=False)
class Figure(Alike):
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
    field : MeshField or SolidMeshField, optional
        What it shows a part of.
    under : str
        Load or speed that all of it holds for; empty where its legend says so, or nothing of the kind matters.
    case : str
        Name of the case, which stands at the head of its picture; put there by what draws a run.
    """

    key: str
    title: str
    caption: str
    panels: tuple[Panel, ...] = ()
    views: tuple[View, ...] = ()
    columns: int = 1
    most_views: int = 4
    field: MeshField | SolidMeshField | None = None
    under: str = ""
    case: str = ""

    @property
    def heading(self) -> str:
        """Its title with what it holds for."""
        return f"{self.title}, {self.under}" if self.under else self.title

    def __post_init__(self) -> None:
        """Give a figure without a choice its only view."""
        if not self.views:
            object.__setattr__(self, "views", (View("", self.panels),))

    @property
    def name(self) -> str:
        """Its key."""
        return self.key

    def __repr__(self) -> str:
        """Key and title."""
        return f"<figure {self.key}: {self.title}>"

    def made(self) -> Figure:
        """Itself, as a deferred figure makes one."""
        return self

    @property
    def all_panels(self) -> tuple[Panel, ...]:
        """The panels of every view."""
        return tuple(panel for view in self.views for panel in view.panels)

    @property
    def drawable_in_page(self) -> bool:
        """Whether a page can draw it itself; fields and surfaces stand there as pictures."""
        still = (TriangleField, Surface, Skin)
        return not any(isinstance(item, still) for panel in self.all_panels for item in panel.items)

    def _repr_mimebundle_(self, **_wishes: object) -> dict[str, Any]:
        """Show it in a notebook, where a renderer has been imported (``import fegear`` and a run do that)."""
        return NOTEBOOK[0](self) if NOTEBOOK else {}


#: What shows a figure in a notebook; the renderer puts itself here.
NOTEBOOK: list[Callable[[Figure], dict[str, Any]]] = []


@dataclass(frozen=True, slots=True, repr=False)
class DeferredFigure(Alike):
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

    @property
    def name(self) -> str:
        """Its key."""
        return self.key

    def __repr__(self) -> str:
        """Key and title."""
        return f"<figure {self.key}: {self.title}>"

    def made(self) -> Figure:
        """Describe it."""
        return self.make()

    def _repr_mimebundle_(self, **_wishes: object) -> dict[str, Any]:
        """Show it in a notebook."""
        return self.make()._repr_mimebundle_()


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


@dataclass(frozen=True, slots=True)
class Panel(Alike):
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
        if self.y.log and not self.y.limits and any(isinstance(i, Stems) and np.size(i.y) for i in self.items):
            return self.foot, 2.0 * self.extent("y")[1]
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


#: Logarithmic axes that span less have plain numbers at 1, 2, 3 and 5 times the powers of ten.
FEW_DECADES = 100.0


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
    ticks : tuple of (float, str)
        Places that bear words in place of numbers; what is drawn may stand between them.
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
    ticks: tuple[tuple[float, str], ...] = ()
    hidden: bool = False

    def like(self, other: Axis) -> bool:
        """Whether two axes show the same thing on the same scale."""
        return (self.label, self.unit, self.log, self.categories) == (
            other.label, other.unit, other.log, other.categories,
        )  # fmt: skip
