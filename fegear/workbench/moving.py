"""Questions about a pair in motion: its dynamic factor over speed, and its vibration over a revolution."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from fegear.base.solution_cache import SolutionCache
from fegear.workbench.given import table
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Speed, Torque, listed
from fegear.workbench.questions import ask_of_pair, loaded_document, refuse_several
from fegear.workbench.results import Results

#: Mesh damping ratio when none is given: that of NASA TM-89901's dynamic model.
DAMPING_RATIO = 0.1


def dynamic_factor(
    pair: Pair,
    *,
    torque: Torque,
    speeds: Speed | Iterable[Speed] | Mapping[str, Any],
    damping_ratio: float | None = None,
    train: Mapping[str, Any] | None = None,
    dynamics: Mapping[str, Any] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    neglected: bool = False,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Largest force on a tooth pair over the mean mesh force, at each speed; teeth may part.

    Parameters
    ----------
    pair : Pair
    torque : torque
        On the driver.
    speeds : speed, iterable of speeds, or mapping
        Of the driver; a mapping as in a case file, ``{"start": "2000 rpm", "stop": "16000 rpm", "count": 57}``.
    damping_ratio : float, optional
        Of the mesh. The default, which a remark reports, is that of NASA TM-89901; measure or compare before you
        promise anything.
    train : mapping, optional
        ``[train]`` of a case file. By default the two gears turn, with the inertia of their
        teeth and bodies, between steady torques, without shafts.
    dynamics : mapping, optional
        More keys of ``[dynamics]``: ``direction``, ``tolerance``, ...
    effects, tolerance, neglected, progress, cache
        As in `transmission_error`; stiffness varies over the mesh cycle and teeth may part.

    Returns
    -------
    Results
        Table ``dynamic_factor_<pair>``, values ``<pair>.largest_dynamic_factor``, ``<pair>.speed_of_largest``.
    """
    several = speeds if isinstance(speeds, Mapping) else listed(speeds, "speeds") or [speeds]
    document = _moving(pair, torque, damping_ratio, train, {"speeds": several, **table(dynamics, "dynamics")})
    found = ask_of_pair("dynamic-factor", pair, document, effects, tolerance, progress, cache, neglected=neglected)
    return found if train is not None else _without_train(found, damping_ratio)


def vibration_revolution(
    pair: Pair,
    *,
    torque: Torque,
    speed: Speed,
    damping_ratio: float | None = None,
    train: Mapping[str, Any] | None = None,
    dynamics: Mapping[str, Any] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Motion in time at one speed until the same teeth mesh again, with cracked or pitted teeth.

    Parameters
    ----------
    pair : Pair
        Odd teeth are given by `Gear.with_crack`, `Gear.with_pit`, ...
    torque : torque
        On the driver.
    speed : speed
        Of the driver.
    damping_ratio, train, dynamics
        As in `dynamic_factor`: without ``train`` both gears turn with their own inertia between constant torques.
    effects, tolerance, progress, cache
        As in `transmission_error`; stiffness varies over the mesh cycle, loss of contact is included.

    Returns
    -------
    Results
        Tables ``vibration_revolution_<pair>`` (dynamic transmission error, its residual, mesh force and acceleration
        over time and rotation) and ``vibration_orders_<pair>``. Values ``<pair>.mesh_force_max``,
        ``<pair>.dynamic_residual_kurtosis``, ...
    """
    refuse_several("vibration_revolution", "under", {"torque": torque})
    refuse_several("vibration_revolution", "at", {"speed": speed})
    document = _moving(pair, torque, damping_ratio, train, {"speed": speed, **table(dynamics, "dynamics")})
    found = ask_of_pair("vibration-revolution", pair, document, effects, tolerance, progress, cache, neglected=False)
    return found if train is not None else _without_train(found, damping_ratio)


def _moving(
    pair: Pair, torque: Torque, damping_ratio: float | None, train: Mapping[str, Any] | None, dynamics: dict[str, Any]
) -> dict[str, Any]:
    """The pair's document in motion; without a train, between two bodies of its gears."""
    document = loaded_document(pair, torque, None)
    if train is not None:
        return {**document, "train": table(train, "train"), "dynamics": dynamics}
    driver, driven = pair.names
    ratio = DAMPING_RATIO if damping_ratio is None else damping_ratio
    document["train"] = {
        "body": {"driver": {"gears": [driver]}, "driven": {"gears": [driven]}},
        "mesh": {pair.name: {"driver": "driver", "driven": "driven", "damping_ratio": ratio}},
        "torque": {"driver": torque}, "balance": "driven",
    }  # fmt: skip
    document["dynamics"] = {"speed_of": "driver", **dynamics}
    return document


def _without_train(found: Results, damping_ratio: float | None) -> Results:
    """The results with the note of what stands in place of a train."""
    said = "Train not specified: gears with their own inertia under constant torques, without shafts."
    if damping_ratio is None:
        said += f" Damping ratio of the mesh not specified, {DAMPING_RATIO:g} assumed."
    return replace(found, plan=replace(found.plan, remarks=(*found.plan.remarks, said)))
