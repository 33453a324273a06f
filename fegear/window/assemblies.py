"""Planetary sets and the gearbox for the page: how they are drawn, the loads of planets, and how shafts bend."""

from __future__ import annotations

import contextlib
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import FegearError
from fegear.results.exercises.planetary_set import exercises_of_set
from fegear.results.exercises.rack import exercises_of_rack
from fegear.results.planetary.turning_set import turning_loads, turning_set
from fegear.results.shafts.drawn_gearbox import drawn_gearbox, largest_shift, motions
from fegear.window.on_gears import packed, round_factor

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.stage import Task

#: The largest displacement of a gearbox is drawn so large, about, as a part of its size.
_DRAWN = 0.06


def assemblies_of(scene: Scene) -> dict[str, Any]:
    """How the planetary sets and the gearbox of a case are drawn; what cannot be assembled is not.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict
        ``sets`` by their names, ``gearbox``, None without shafts, and ``racks`` by their names: questions on them.
    """
    sets = {}
    for name in scene.case.planetary:
        with contextlib.suppress(FegearError):  # the case is refused for it
            exercises = [one._asdict() for one in exercises_of_set(scene, name)]
            sets[name] = _plain(asdict(turning_set(scene, name)) | {"exercises": exercises})
    gearbox = None
    if scene.case.shaft:
        with contextlib.suppress(FegearError):
            gearbox = _plain(asdict(drawn_gearbox(scene)))
            driving = {part.driver for part in scene.case.pair.values()}
            gearbox["drivers"] = sorted(driving & {body["name"] for body in gearbox["bodies"]})
    racks = {name: {"exercises": [one._asdict() for one in exercises_of_rack(scene, name)]} for name in scene.case.rack}
    return {"sets": sets, "gearbox": gearbox, "racks": racks}


def on_the_assembly(task: Task, data: Any, scene: Scene) -> dict[str, Any] | None:
    """What a task found, if it is shown at a set or at the gearbox.

    Parameters
    ----------
    task : Task
    data : object
        As the stage computed it.
    scene : Scene
    """
    if task.stage == "planet-load-sharing":
        loads = turning_loads(data)
        return {
            "pair": f"set {task.subject}", "kind": "loads", "s": np.round(loads.q, 6).tolist(),
            "force": packed(loads.force), "mean": loads.mean, "largest": float(loads.force.max()),
            "shares": np.round(loads.shares, 6).tolist(),
        }  # fmt: skip
    if task.stage == "shaft-deflection":
        box = drawn_gearbox(scene)
        moved = motions(data, box)
        largest = largest_shift(moved)
        return {
            "pair": "gearbox", "kind": "bent", "largest": largest * 1e6,
            "moved": [packed(one * 1e3) for one in moved],  # mm and mrad
            "factor": round_factor(_DRAWN * box.size / largest, 1e6) if largest > 0.0 else 1.0,
        }  # fmt: skip
    return None


def _plain(value: Any) -> Any:
    """Arrays as lists, to a nanometre; lengths stay in metres."""
    if isinstance(value, np.ndarray):
        return np.round(value, 9).tolist()
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    return [_plain(one) for one in value] if isinstance(value, (list, tuple)) else value
