"""What of a case is changed by hand beside its form: gears in mesh, reliefs over the roll angle, loads."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Literal

from fegear.output.draw_plotly import darker, plotly_json
from fegear.results.relief_handles import handled_relief
from fegear.window.case_text import value_at
from fegear.window.gears import gears_in_mesh

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene

_MEMBERS: tuple[Literal["driver"], Literal["driven"]] = ("driver", "driven")


def hands_of(scene: Scene) -> dict[str, Any]:
    """For every pair: its gears in mesh, the reliefs, and the load.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict
        By the pair's name: ``mesh``, ``reliefs``, ``load``, and ``designs``: whether reliefs are found by theory, which
        is of plane teeth.
    """
    found: dict[str, Any] = {}
    for name in scene.pairs:
        found[name] = {
            "mesh": gears_in_mesh(scene, name), "reliefs": _reliefs(scene, name), "load": _load(scene.document, name),
            "designs": name in scene.plane_pairs,
        }  # fmt: skip
    return found


def _reliefs(scene: Scene, name: str) -> list[dict[str, Any]]:
    made: list[dict[str, Any]] = []
    for member in _MEMBERS:
        relief = handled_relief(scene, name, member)
        if any(relief.gear == other["gear"] for other in made):  # a gear that meets its like has one relief
            continue
        document = value_at(scene.document, ("gear", relief.gear, "relief")) or {}
        figure = relief.figure
        made.append({
            "gear": relief.gear, "low": relief.low, "high": relief.high, "usual": relief.usual,
            "handles": [asdict(handle) for handle in relief.handles],
            "given": sorted(document), "over_face": scene.case.gear[relief.gear].over_face,
            "on": scene.case.effects.relief,
            "figure": {"key": figure.key, "heading": figure.heading, "caption": figure.caption, **plotly_json(figure)},
            "darker": darker([figure]),
        })  # fmt: skip
    return made


def _load(document: Mapping[str, Any], name: str) -> dict[str, str] | None:
    """The key of a pair's load that the case gives, and what it has."""
    for key in ("torque", "load"):
        given = value_at(document, ("pair", name, key))
        if isinstance(given, str):
            return {"key": key, "text": given}
    return None
