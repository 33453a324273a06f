"""A first answer for pairs with a width: coupled slices, which take a fraction of the time of 3D gears.

The window shows it while the gears are solved; ``fegear run`` says what it comes to before a run of more than some
seconds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import forecast_seconds
from fegear.results.catalogue import STAGES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan

#: Tolerance of a slice's section, roll positions and panels of a draft.
_COARSE_SLICES, _POSITIONS, _PANELS = 0.1, 8, 10
#: A run that takes less needs no draft [s]; a draft that takes more of its time is none.
_LONG, _SHARE = 8.0, 0.3


class RunDraft(NamedTuple):
    """What a run says first.

    Attributes
    ----------
    scene : Scene
        With slices, without estimated errors.
    plan : Plan
    seconds : float
        That the run itself is expected to take [s].
    """

    scene: Scene
    plan: Plan
    seconds: float


def can_be_sliced(scene: Scene, name: str) -> bool:
    """Whether slices know a pair: of solid external gears."""
    gears = scene.pairs[name].driver, scene.pairs[name].driven
    return scene.width_of(name) == "solid" and not any(one.tooth.internal or one.body for one in gears)


def sliced(scene: Scene, results: Sequence[str]) -> Scene:
    """A case with all pairs as coarse slices that can be.

    Parameters
    ----------
    scene : Scene
    results : sequence of str
        What it asks for.

    Raises
    ------
    FegearError
        If slices refuse what solids take.
    """
    given = dict(scene.document)
    tables: dict[str, Any] = dict(given.get("pair", {}))  # type: ignore[call-overload]  # a table of the document
    pairs = [name for name in scene.wide_pairs if can_be_sliced(scene, name)]
    tables |= {name: {**tables[name], "width": "slices"} for name in pairs}
    face: dict[str, Any] = dict(given.get("load_distribution", {}))  # type: ignore[call-overload]  # a table of the document
    few = {"positions": _POSITIONS, "panels": _PANELS}
    face |= {key: min(most, face.get(key, most)) for key, most in few.items()}
    document = {
        **given, "results": list(results), "pair": tables, "accuracy": {"tolerance": _COARSE_SLICES},
        "neglected": False, "load_distribution": face,
    }  # fmt: skip
    rough = build_scene(document, scene.name, scene.folder, within=scene.within)
    return replace(rough, estimates=False)


def draft_of_run(scene: Scene, plan: Plan) -> RunDraft | None:
    """The draft of a run; None where the run is short, or slices are not much shorter.

    Parameters
    ----------
    scene : Scene
    plan : Plan
        Of the case.

    Raises
    ------
    FegearError
        If slices refuse what solids take.
    """
    whole = sum(seconds or 0.0 for seconds in forecast_seconds(scene, plan))
    if whole < _LONG or not any(can_be_sliced(scene, name) for name in scene.wide_pairs):
        return None
    rough = sliced(scene, scene.case.results)
    drafted = make_plan(rough, STAGES)
    ahead = forecast_seconds(rough, drafted)
    if None in ahead or sum(seconds or 0.0 for seconds in ahead) > _SHARE * whole:
        return None
    return RunDraft(rough, drafted, whole)
