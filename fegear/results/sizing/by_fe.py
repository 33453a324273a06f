"""Transmission error and root stress of variants by finite elements: each the run of its own case, once.

Every variant is a point of its own (`fegear.engine.executor.map_points`): on all cores or a cluster, kept as soon as it
is finished, so that a sizing that was killed goes on where it stopped, with the same numbers.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.case.reading import build_scene
from fegear.results.sizing.variant_case import PAIR, case_of_variant

if TYPE_CHECKING:
    from fegear.base.solution_cache import SolutionCache
    from fegear.design.sizing.space import Variant
    from fegear.engine.progress import Progress
    from fegear.engine.stage import Work

#: Relative accuracy of an estimate, and the tooth model of its helical pairs.
COARSE, COARSE_WIDTH = 1e-2, "slices"
#: What is computed of a variant.
_RESULTS = ("transmission-error", "root-stress-history")


@dataclass(frozen=True)
class FromFE:
    """What finite elements say of a variant; NaN with the reason where they say nothing.

    Parameters
    ----------
    te, te_error : float
        Maximum of the peak-to-peak transmission error over the torques, its estimated error [m].
    root_stress, root_stress_error : float
        Maximum root stress of both gears at the nominal torque [Pa].
    reason : str
    source : {"FE", "atlas"}
    """

    te: float = math.nan
    te_error: float = math.nan
    root_stress: float = math.nan
    root_stress_error: float = math.nan
    reason: str = ""
    source: str = "FE"


def compute_variant(point: Mapping[str, Any], cache: SolutionCache) -> dict[str, float]:
    """Run the case of a variant; plain numbers in SI."""
    from fegear.engine.executor import Executor
    from fegear.engine.plan import make_plan
    from fegear.engine.run import run_plan
    from fegear.results.catalogue import STAGES

    scene = build_scene(point["document"], "variant", Path(point["folder"]), bare_si=True)
    scene = replace(scene, estimates=point["estimates"])
    results = run_plan(scene, make_plan(scene, STAGES), cache=cache, executor=Executor(here=True))
    values = {value.name: value for value in results.values}
    te = values[f"{PAIR}.te_peak_to_peak"]
    roots = [values[f"{PAIR}.{member}.largest_root_tension"] for member in ("driver", "driven")]
    root = max(roots, key=lambda one: one.si)
    found = {"te": float(te.si), "te_error": _error(te.si_error)}
    torques = scene.case.pair[PAIR].torques
    for table in results.tables:
        if torques is not None and table.name == f"transmission_error_summary_{PAIR}":
            columns = {column.name: np.asarray(column.si, dtype=float) for column in table.columns}
            counts = np.isclose(columns["driver_torque"][:, None], torques.array, rtol=1e-9, atol=0.0).any(axis=1)
            found["te"] = float(columns["te_peak_to_peak"][counts].max())
    return {**found, "root_stress": float(root.si), "root_stress_error": _error(root.si_error)}


def _error(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _content(point: Mapping[str, Any]) -> object:
    return [{key: value for key, value in point["document"].items() if key != "title"}, point["estimates"]]


def by_finite_elements(
    asked: Mapping[str, Any], variants: Sequence[Variant], work: Work, folder: str, progress: Progress, *,
    verified: tuple[str, float] | None = None, states: Sequence[tuple[float, float]] = ((0.0, 0.0),),
) -> tuple[FromFE, ...]:  # fmt: skip
    """Numbers of every variant, of helical ones their maximum over states.

    Parameters
    ----------
    asked : mapping
        What the cases have from the requirement, in SI.
    variants : sequence of Variant
    work : Work
    folder : str
        Where files that the case names are looked for.
    progress : callable
    verified : (str, float), optional
        Tooth model of helical pairs and tolerance of a verification, with estimated errors; else an estimate.
    states : sequence of (float, float)
        What is added to the face width of helical variants, and the deviation of their shafts over it [m].
    """
    from fegear.engine.executor import map_points
    from fegear.engine.processes import Failure

    width, tolerance = verified or (COARSE_WIDTH, COARSE)
    nominal = tuple(states)[:1]
    each = [states if one.helix_angle else nominal for one in variants]
    points = [
        {
            "document": case_of_variant(
                asked, one._replace(face_width=one.face_width + wider), _RESULTS, width=width, tolerance=tolerance,
                parallelism=shafts,
            ),
            "folder": folder, "estimates": verified is not None,
        }
        for one, those in zip(variants, each, strict=True) for wider, shafts in those
    ]  # fmt: skip
    found = map_points(
        compute_variant, points, work.executor, work.cache, key=_content, shares_cache=True, progress=progress
    )
    numbers = iter([FromFE(reason=one.reason) if isinstance(one, Failure) else FromFE(**one) for one in found])
    return tuple(_largest([next(numbers) for _ in those]) for those in each)


def _largest(states: Sequence[FromFE]) -> FromFE:
    """Maxima over the states of a variant, each with its error; the first failure where one has no number."""
    failed = next((one for one in states if one.reason), None)
    if failed is not None:
        return failed
    te, root = (max(states, key=lambda one: getattr(one, name)) for name in ("te", "root_stress"))
    return FromFE(te.te, te.te_error, root.root_stress, root.root_stress_error)
