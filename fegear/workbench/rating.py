"""The question whether a pair holds: its rating, from a script."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from fegear.base.solution_cache import SolutionCache
from fegear.workbench.given import texts
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Force, Speed, Torque
from fegear.workbench.questions import _one_load, ask_of_pair
from fegear.workbench.results import Results


def rating(
    pair: Pair,
    *,
    speed: Speed | None = None,
    torque: Torque | None = None,
    load: Force | None = None,
    operation: Mapping[str, Any] | None = None,
    beside: str | Iterable[str] = ("agma-2101",),
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    neglected: bool = False,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Safeties against pitting and tooth breakage of a spur or helical pair by ISO 6336, with every factor.

    Parameters
    ----------
    pair : Pair
        Its gears with ``strength`` and ``face_width``.
    speed : speed, optional
        Of the driver; that of the pair by default.
    torque, load : torque or force
        On the driver, or along the transverse line of action.
    operation : mapping, optional
        Keys of ``operation`` of a case file: ``application_factor``, ``life``, ``spectrum``, ...; those of the pair by
        default.
    beside : str or iterable of str
        ``"computed"``: with the computed load distribution and root stress; ``"agma-2101"``.
    effects, tolerance, neglected, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results
        Tables ``rating_<pair>``, ``rating_safety_<pair>``, values ``<pair>.driver.S_H``, ``<pair>.driver.S_F``, ...
    """
    _one_load(pair, torque, load)
    given: dict[str, Any] = {"torque": torque, "load": load, "speed": speed, "operation": operation}
    document = pair.document(**{key: value for key, value in given.items() if value is not None})
    document["rating"] = {"beside": texts(beside, "beside")}
    return ask_of_pair("rating", pair, document, effects, tolerance, progress, cache, neglected=neglected)
