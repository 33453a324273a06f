"""A figure, described once and as data: what is drawn over which axes, in the units in which it is read.

Renderers draw a description as PNG, as SVG and as the report's interactive plot; they take everything from it, so they
cannot disagree. Names, labels and titles are plain text, in which ``_{...}`` sets what it holds lower.
"""

from fegear.engine.figure.axes import FEW_DECADES, Axis, Scale
from fegear.engine.figure.figure import NOTEBOOK, DeferredFigure, Figure, MeshField, SolidMeshField, View
from fegear.engine.figure.items import (
    Bars,
    Curve,
    HeatMap,
    Item,
    Mark,
    Points,
    Skin,
    Spot,
    Stems,
    Surface,
    TriangleField,
    Which,
    Zone,
)
from fegear.engine.figure.lines import edges, few, outline, polylines, ramp
from fegear.engine.figure.panel import Panel

__all__ = [
    "FEW_DECADES", "NOTEBOOK", "Axis", "Bars", "Curve", "DeferredFigure", "Figure", "HeatMap", "Item", "Mark",
    "MeshField", "Panel", "Points", "Scale", "Skin", "SolidMeshField", "Spot", "Stems", "Surface", "TriangleField",
    "View", "Which", "Zone", "edges", "few", "outline", "polylines", "ramp",
]  # fmt: skip
