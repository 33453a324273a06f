"""The question which fillet a gear of a pair should have, from a script."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Force, Length, Torque
from fegear.workbench.questions import ask_of_pair
from fegear.workbench.results import Results


def fillet_design(
    pair: Pair,
    gear: str | None = None,
    *,
    torque: Torque | None = None,
    load: Force | None = None,
    objective: Literal["tension", "alternating"] = "tension",
    other: Pair | None = None,
    clearance: Length | None = None,
    minimum_radius: Length | None = None,
    generated: bool = False,
    searches: int | None = None,
    waves: int | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """The fillet of one gear with the minimum root stress over the mesh, its gain, and whether searches agree.

    Parameters
    ----------
    pair : Pair
        Plane gears, external or with a ring gear.
    gear : str, optional
        Name of the gear that gets the fillet; by default the driver.
    torque, load : torque or force, optional
        On the driver, or along the line of action; one of them, here or among the keys of the pair.
    objective : {"tension", "alternating"}
        Maximum root stress, or half its range in teeth loaded on both flanks (idlers, planets).
    other : Pair, optional
        The pair, with a load of its own among its keys, that loads the other flanks of the same gear: planet and ring,
        or the same gears with driver and driven exchanged. Of asymmetric teeth both fillets are then designed.
    clearance, minimum_radius, generated, searches, waves
        As in ``[fillet_design]`` of a case file.
    effects, tolerance, progress, cache
        As in `fegear.transmission_error`.

    Returns
    -------
    Results
        Tables ``designed_fillet_<pair>_<gear>`` (points), ``fillet_stress_<pair>_<gear>``; values
        ``<pair>.<gear>.gain``, ...

    Raises
    ------
    InputError
        If a pair or a limit does not fit: key, value, rule, remedy.
    """
    for key, one in (("pair", pair), ("other", other)):
        if not isinstance(one, Pair) and not (one is None and key == "other"):
            raise InputError(key, shown(one), "must be a fegear.Pair", "use fegear.Pair(pinion, wheel)")
    given = {"torque": torque, "load": load}
    document = pair.document(**{key: value for key, value in given.items() if value is not None})
    asked: dict[str, Any] = {"pair": pair.name, "gear": gear, "objective": objective, "generated": generated}
    asked |= {"clearance": clearance, "minimum_radius": minimum_radius, "searches": searches, "waves": waves}
    if other is not None:
        if other.name == pair.name:
            raise InputError("other", f'"{other.name}"', "has the name of the pair itself", 'set its name = "II"')
        added = other.document()
        for name in document["gear"].keys() & added["gear"].keys():
            if document["gear"][name] != added["gear"][name]:
                raise InputError("other", f'"{name}"', "is another gear of the same name as in pair", "rename one")
        document["gear"] |= added["gear"]
        document["pair"] |= added["pair"]
        asked["other_pair"] = other.name
    document["fillet_design"] = {key: value for key, value in asked.items() if value is not None}
    return ask_of_pair("fillet-design", pair, document, effects, tolerance, progress, cache, neglected=False)
