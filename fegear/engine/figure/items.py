"""What a panel can hold: curves, points, bars, stems, maps, fields and surfaces, and marks across it.

Lines of drawings.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Alike, Array
from fegear.engine.figure.fixed import fixed

#: Curves with no more points than this show them.
_FEW = 15


class _Item(Alike):
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
        Whether paper has the notes beside the points; pages have them where they are single letters.
    labels : tuple of str
        Written beside the points, or in their place where the size is zero, on paper and in pages.
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
    labels: tuple[str, ...] = ()
    ARRAYS: ClassVar[tuple[str, ...]] = ("x", "y", "shade", "error")

    @property
    def lettered(self) -> bool:
        """Whether the points bear letters, which are read beside them on paper and in pages."""
        return self.written and all(len(note.partition("_")[0]) == 1 for note in self.notes)


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
    """Lines of a spectrum: uprights with a head; `notes` is what the reader sees on pointing at each.

    `numbers`, where there are any, are written above the heads.
    """

    x: ArrayLike
    y: ArrayLike
    name: str = ""
    role: str = "series:0"
    notes: tuple[str, ...] = ()
    numbers: tuple[str, ...] = ()


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
    name : str
        Entry of the legend, which surfaces of one name share.
    """

    points: ArrayLike
    role: str
    opacity: float = 1.0
    name: str = ""
    ARRAYS: ClassVar[tuple[str, ...]] = ("points",)


@dataclass(frozen=True, slots=True)
class Skin(_Item):
    """Values on the surface of a body in space, beside surfaces; the panel is seen in perspective.

    Parameters
    ----------
    points : array_like, shape (3, N)
    triangles : ndarray of int, shape (3, M)
    values : array_like, shape (N,)
        NaN where there is nothing: grey.
    top : float
        Where the scale of colours ends; it starts at zero.
    label, unit : str
    floor : float
        Nothing is drawn below this y.
    """

    points: ArrayLike
    triangles: NDArray[np.int64]
    values: ArrayLike
    top: float
    label: str
    unit: str = ""
    floor: float = -np.inf
    ARRAYS: ClassVar[tuple[str, ...]] = ("points", "values")


@dataclass(frozen=True, slots=True)
class Spot(_Item):
    """A point in space beside surfaces, shape (3,)."""

    points: ArrayLike
    role: str
    name: str = ""
    ARRAYS: ClassVar[tuple[str, ...]] = ("points",)


@dataclass(frozen=True, slots=True)
class Mark(Alike):
    """A dotted line across the panel at a value of an axis, with a word beside it."""

    axis: Which
    at: float
    label: str = ""


@dataclass(frozen=True, slots=True)
class Zone(Alike):
    """A grey band across the panel between two values of an axis."""

    axis: Which
    low: float
    high: float


Which: TypeAlias = Literal["x", "y"]


Item: TypeAlias = Curve | Points | Bars | Stems | HeatMap | TriangleField | Surface | Skin | Spot


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
