"""A figure: its panels or views, its title and the sentence below it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Alike, Array
from fegear.engine.figure.items import (
    Skin,
    Surface,
    TriangleField,
)
from fegear.engine.figure.panel import Panel

if TYPE_CHECKING:
    import numpy as np


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
