"""The gears in mesh for the page: outlines and how they turn, and what is switched on at them."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.plan import make_plan
from fegear.engine.stage import Task
from fegear.errors import FegearError
from fegear.results.catalogue import STAGES
from fegear.results.moving_pair import moving_pair
from fegear.results.tool_envelope import tool_envelope
from fegear.window.on_gears import millimetres

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.case.reading import Scene

#: What is switched on at the gears, and the stage that computes it for plane teeth, and for those with a width.
_PLANE = {"stress": "stress-in-mesh", "deformed": "deformed-in-mesh"}
_WIDE = {"stress": "flank-stress-in-mesh"}
#: Why deformed teeth are not shown of gears with a width.
_NOT_PLANE = (
    "It is shown only of pairs of plane teeth: of gears with a width flanks and fillets are known, not how tips and "
    "the flanks behind move."
)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return np.round(value, 9).tolist()  # to a nanometre
    return value


def gears_in_mesh(scene: Scene, name: str) -> dict[str, Any]:
    """Outlines of both gears and how they turn, for the page to draw, and what can be switched on in vain.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the pair.
    """
    found = {key: _plain(value) for key, value in asdict(moving_pair(scene.pairs[name])).items()}
    return found | {"refused": {kind: _NOT_PLANE for kind in _PLANE if kind not in _stages(scene, name)}}


def _stages(scene: Scene, name: str) -> dict[str, str]:
    """The stages that compute what is switched on at the gears of a pair."""
    return _PLANE if name in scene.plane_pairs else _WIDE


def wanted_on_gears(scene: Scene, shows: Iterable[tuple[str, str]]) -> tuple[list[Task], list[dict[str, Any]]]:
    """What is switched on at the gears: tasks that compute it, and what can be told of it at once.

    Parameters
    ----------
    scene : Scene
    shows : iterable of (str, str)
        Pair and kind: ``stress``, ``deformed`` or ``tool``.

    Returns
    -------
    tasks : list of Task
    told : list of dict
        For the page: the tool's positions, and why a kind cannot be had.
    """
    tasks: list[Task] = []
    told: list[dict[str, Any]] = []
    for pair, kind in shows:
        if pair not in scene.pairs:
            continue
        if kind == "tool":
            gears = scene.pairs[pair]
            lines = {member: millimetres(at) for member, at in tool_envelope(gears).items()}
            tips = {member: gears.gear(member).tip_radius * 1e3 for member in lines}
            told.append({"pair": pair, "kind": kind, "lines": lines, "tips": tips})
        elif kind not in (stages := _stages(scene, pair)):
            told.append({"pair": pair, "kind": kind, "refused": _NOT_PLANE})
        else:
            task = Task(stages[kind], pair)
            try:
                make_plan(scene, STAGES, [task])
                tasks.append(task)
            except FegearError as error:
                told.append({"pair": pair, "kind": kind, "refused": str(error)})
    return tasks, told
