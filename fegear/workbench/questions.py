"""The everyday questions about gears and pairs, each one case that is composed, run and handed back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.case.drafts.answers import ends
from fegear.case.reading import Scene, build_scene
from fegear.workbench.gear import Gear
from fegear.workbench.given import cache_of, table, taken, working_folder
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Force, Length, Torque, brief, in_si, listed
from fegear.workbench.results import Results
from fegear.workbench.run import run_scene

#: Torques of a range "150 to 300 N m": both ends and the middle.
_IN_RANGE = 3


#: What each result is called in the title of its case.
_TITLES = {
    "stiffness": "Stiffness",
    "crosscheck": "Root stress and compliance",
    "load-sharing": "Load sharing",
    "gauge": "Strain of gauges",
    "measured-transmission-error": "Measured transmission error",
    "mesh-stiffness-revolution": "Mesh stiffness over a revolution",
    "root-stress-history": "Root stress over the mesh cycle",
    "transmission-error": "Transmission error",
    "relief": "Relief",
    "fillet-design": "Fillet",
    "flank-design": "Flanks",
    "dynamic-factor": "Dynamic factor",
    "vibration-revolution": "Vibration over a revolution",
    "rating": "Rating",
}


def _scene(wanted: str, document: Mapping[str, Any], tolerance: float | None) -> Scene:
    """The case that asks for one result of what a document describes."""
    names = list(document["gear"])
    of = " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
    more = {} if tolerance is None else {"accuracy": {"tolerance": tolerance}}
    whole = {"title": f"{_TITLES[wanted]} of {of}", "results": [wanted], **more, **document}
    return build_scene(taken(whole, "case"), wanted, working_folder(), bare_si=True)


def ask_of_pair(
    wanted: str,
    pair: Pair,
    document: Mapping[str, Any],
    effects: Mapping[str, Any] | None,
    tolerance: float | None,
    progress: bool | None,
    cache: SolutionCache | None,
    *,
    neglected: bool,
) -> Results:
    """Run the case with the effects that its description calls for, and with those given."""
    start = {"start": "described", **table(effects, "effects")}
    scene = replace(_scene(wanted, {**document, "effects": start}, tolerance), neglects=neglected)
    return run_scene(scene, progress=progress, cache=cache_of(cache, pair.known))


def _one_load(pair: Pair, torque: object, load: object) -> None:
    """Refuse what is no pair, and both loads or none."""
    if not isinstance(pair, Pair):
        raise InputError("pair", shown(pair), "must be a fegear.Pair", "use fegear.Pair(pinion, wheel)")
    if (torque is None) == (load is None):
        raise InputError(
            "torque", "(not given)" if torque is None else "(given)", "is required, or load",
            'set torque="90 N*m" on the driver, or load="3 kN" along the line of action',
        )  # fmt: skip


def refuse_several(function: str, under: str, keys: Mapping[str, object]) -> None:
    """Refuse lists and ranges where a revolution is followed under one load, at one speed; a list of one passes."""
    for key, given in keys.items():
        several = listed(given, key) if given is not None else None
        both = ends(given) if isinstance(given, str) else None
        if both is not None or (several is not None and len(several) != 1):
            raise InputError(
                key, shown(given), f"must be one {key}: a revolution is followed {under} one",
                f"call it in a loop: {{one: fegear.{function}(pair, {key}=one) for one in {key}s}}; "
                "solved gears are used again",
            )  # fmt: skip


def loaded_document(
    pair: Pair, torque: Torque | Iterable[Torque] | None, load: Force | Iterable[Force] | None
) -> dict[str, Any]:
    """The pair's document under its load or loads, along the line of action."""
    _one_load(pair, torque, load)
    given, dimension = (load, "force") if torque is None else (torque, "torque")
    key = "load" if torque is None else "torque"
    both = ends(given) if isinstance(given, str) else None
    if both is not None:
        first, last = (in_si(one, dimension, key) for one in both)
        given = np.linspace(first, last, _IN_RANGE).tolist()
    several = listed(given, key)
    if several is None:
        return pair.document(**{key: given})
    radius = 1.0 if torque is None else pair.geometry.driver.base_radius
    return pair.document(loads=[in_si(one, dimension, key) / radius for one in several])


def _designed_for(
    pair: Pair, torque: Torque | Iterable[Torque] | Mapping[str, Any] | None, load: Force | Iterable[Force] | None
) -> tuple[dict[str, Any], dict[str, str]]:
    """The pair's document under what it is designed for, and what ``[design]`` says of several loads."""
    _one_load(pair, torque, load)
    both = ends(torque) if isinstance(torque, str) else None
    if both is not None:
        torque = {"start": both[0], "stop": both[1], "count": _IN_RANGE}
    if torque is not None and (isinstance(torque, Mapping) or listed(torque, "torque") is not None):
        return pair.document(torques=torque), {}
    several = load is not None and listed(load, "load") is not None
    return loaded_document(pair, torque, load), {"over": "torques"} if several else {}


def stiffness_table(
    gear: Gear,
    radii: Length | Iterable[Length] | None = None,
    *,
    positions: int | None = None,
    contact_half_width: Length | None = None,
    face_positions: int | Iterable[Length] | None = None,
    source: Literal["solid", "slices"] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Compliance of a tooth and its neighbours, and the stress at both roots, for loads along the flank.

    Parameters
    ----------
    gear : Gear
    radii : length or iterable of lengths, optional
        Where the load stands.
    positions : int, optional
        That many over the flank instead; 100 if neither is given.
    contact_half_width : length, optional
        Half the width that the load presses on; .02 modules by default.
    face_positions : int or iterable of lengths, optional
        Solve the gear, spur or helical, with its width: so many places along the face, or the places from its middle.
    source : {"solid", "slices"}, optional
        With face positions: the solid gear, or cheaper coupled slices of its plane section.
    tolerance : float, optional
        Relative error that the mesh is chosen for.
    progress, cache
        As in `run`; by default what was solved for the same gear before is recalled.

    Returns
    -------
    Results
        Table ``stiffness_<gear>``; with face positions ``stiffness_over_face_<gear>``.
    """
    if not isinstance(gear, Gear):
        raise InputError("gear", shown(gear), "must be a fegear.Gear", 'use fegear.Gear(20, "3 mm")')
    if isinstance(radii, int):
        raise InputError("radii", f"{radii}", "must be lengths", f"use positions={radii} for so many load positions")
    part: dict[str, Any] = {"gear": gear.name}
    given = {"radii": None if radii is None else listed(radii, "radii") or [radii], "positions": positions,
             "contact_half_width": contact_half_width, "face_positions": face_positions, "source": source}  # fmt: skip
    part |= {key: value for key, value in given.items() if value is not None}
    scene = _scene("stiffness", {"gear": {gear.name: gear.keys}, "stiffness": part}, tolerance)
    return run_scene(scene, progress=progress, cache=cache_of(cache, gear.known))


def root_stress(
    gears: Gear | Iterable[Gear] | Pair,
    *,
    positions: int | None = None,
    torque: Torque | Iterable[Torque] | None = None,
    load: Force | Iterable[Force] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    neglected: bool = False,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Root stress of gears under a load along the flank, or of both gears of a pair through the mesh.

    Of gears that by finite elements is compared with every formula (ISO 6336-3, AGMA 908, ...); of a pair, spur or
    helical, it is that of a tooth as it passes through the mesh under the pair's load.

    Parameters
    ----------
    gears : Gear or iterable of Gear, or Pair
        Gears each with a name of its own.
    positions : int, optional
        Loads along the flank of gears; 20 by default.
    torque, load, effects
        Of a pair, as in `transmission_error`.
    tolerance : float, optional
        Relative error that the mesh is chosen for.
    neglected : bool, optional
        Whether to estimate what effects that are off would change, for `Results.remarks`: some tenths of a second.
    progress, cache
        As in `run`; by default what was solved for the same gear before is recalled.

    Returns
    -------
    Results
        Tables ``crosscheck_root_stress_<gear>``, values ``<gear>.root_stress.<formula>.highest_ratio``; of a pair
        tables ``root_stress_history_<pair>_<gear>``, values ``<pair>.driver.largest_root_tension``, ...
    """
    if isinstance(gears, Pair):
        if positions is not None:
            raise InputError("positions", shown(positions), "applies to gears only", "remove it")
        document = loaded_document(gears, torque, load)
        return ask_of_pair(
            "root-stress-history", gears, document, effects, tolerance, progress, cache, neglected=neglected
        )
    for key, given in (("torque", torque), ("load", load), ("effects", effects)):
        if given is not None:
            raise InputError(key, brief(given), "applies to pairs, not to gears", "specify a fegear.Pair, or no load")
    found = [gears] if isinstance(gears, Gear) else list(gears) if isinstance(gears, Iterable) else []
    if not found or not all(isinstance(gear, Gear) for gear in found):
        raise InputError("gears", brief(gears), "must be gears", 'use fegear.Gear(20, "3 mm", name="z20")')
    names = [gear.name for gear in found]
    for name in names:
        if names.count(name) > 1:
            raise InputError("gears", f'"{name}"', "is the name of several gears", 'use unique names: name="z20"')
    document = {"gear": {gear.name: gear.keys for gear in found}, "stiffness": {"positions": positions or 20}}
    return run_scene(_scene("crosscheck", document, tolerance), progress=progress, cache=cache_of(cache))


def transmission_error(
    pair: Pair,
    *,
    torque: Torque | Iterable[Torque] | None = None,
    load: Force | Iterable[Force] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    neglected: bool = False,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Loaded transmission error, mesh stiffness and harmonics over one base pitch.

    Parameters
    ----------
    pair : Pair
        Spur or helical; helical ones, and spur ones with ``width``, are loaded with their width.
    torque : torque or iterable of torques
        On the driver; single values are for the largest of several. ``"150 to 300 N m"`` is both ends and the middle.
    load : force or iterable of forces
        Along the line of action, in place of the torque.
    effects : mapping, optional
        Changes of the effects, which start as the pair is described (``start = "described"`` of a case file):
        neighbours deform, contacts widen with load, corners touch early; relief, spacing errors and misalignment where
        gears or pair have them. ``{"start": "none"}`` starts without any.
    tolerance : float, optional
        Relative error that the meshes are chosen for.
    neglected : bool, optional
        Whether to estimate what effects that are off would change, for `Results.remarks`: some tenths of a second.
    progress, cache
        As in `run`; by default what was solved for the same gear before is recalled.

    Returns
    -------
    Results
        Tables ``transmission_error_<pair>``, ``transmission_error_harmonics_<pair>``; for several loads
        ``transmission_error_summary_<pair>``. Values ``<pair>.te_peak_to_peak``, ...
    """
    return ask_of_pair(
        "transmission-error",
        pair,
        loaded_document(pair, torque, load),
        effects,
        tolerance,
        progress,
        cache,
        neglected=neglected,
    )


def load_sharing(
    pair: Pair,
    *,
    torque: Torque | Iterable[Torque] | None = None,
    load: Force | Iterable[Force] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    neglected: bool = False,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Load, deflection and contact pressure of one tooth pair over the path of contact, spur or helical.

    Parameters
    ----------
    pair : Pair
    torque, load, effects, tolerance, neglected, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results
        Table ``load_sharing_<pair>``, for several loads ``load_sharing_loads_<pair>``. Values
        ``<pair>.largest_load``, ``<pair>.largest_hertz_pressure``, ...
    """
    return ask_of_pair(
        "load-sharing",
        pair,
        loaded_document(pair, torque, load),
        effects,
        tolerance,
        progress,
        cache,
        neglected=neglected,
    )


def mesh_stiffness_revolution(
    pair: Pair,
    *,
    torque: Torque | None = None,
    load: Force | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Mesh stiffness, transmission error and load sharing until the same teeth mesh again, with cracked teeth.

    Parameters
    ----------
    pair : Pair
        A crack is given by `Gear.with_crack`; of helical gears it runs along the helix.
    torque, load : torque or force
        One of them, a single value.
    effects, tolerance, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results
        Tables ``mesh_stiffness_revolution_<pair>``, ``tooth_loads_revolution_<pair>``,
        ``root_stress_teeth_<pair>_<gear>``, ``mesh_stiffness_orders_<pair>``. Values
        ``<pair>.mesh_stiffness_min``, ``<pair>.te_residual_max``, ...

    Raises
    ------
    InputError
        If several loads are given, or as in `transmission_error`.
    """
    refuse_several("mesh_stiffness_revolution", "under", {"torque": torque, "load": load})
    return ask_of_pair(
        "mesh-stiffness-revolution", pair, loaded_document(pair, torque, load), effects, tolerance, progress, cache,
        neglected=False,
    )  # fmt: skip


def relief(
    pair: Pair,
    *,
    torque: Torque | Iterable[Torque] | Mapping[str, Any] | None = None,
    load: Force | Iterable[Force] | None = None,
    design: Mapping[str, Any] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    neglected: bool = False,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """The profile relief of both gears that leaves least transmission error under a load, and what a shop can grind.

    Of teeth with a width, helical ones too, only what can be ground: tip reliefs.

    Parameters
    ----------
    pair : Pair
    torque, load : torque or force, or several
        The load that the relief is made for. Several, or a range of torques, ``"120 to 320 N m"`` (both ends and the
        middle) or ``{"start": "120 N*m", "stop": "320 N*m", "count": 5}``: what can be ground is designed for all.
    design : mapping, optional
        Keys of ``[design]`` of a case file: ``family``, ``peak``, ``grind``, ``metric``, ...
    effects, tolerance, neglected, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results
        Tables ``relief_<pair>_<gear>`` (plane teeth), ``grindable_<pair>`` and ``grinding_<pair>``; `Pair.relieved`
        applies them.
    """
    document, several = _designed_for(pair, torque, load)
    document["design"] = {"pair": pair.name, **several, **table(design, "design")}
    return ask_of_pair("relief", pair, document, effects, tolerance, progress, cache, neglected=neglected)


def flank_design(
    pair: Pair,
    *,
    torque: Torque | Iterable[Torque] | Mapping[str, Any] | None = None,
    load: Force | Iterable[Force] | None = None,
    design: Mapping[str, Any] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Modifications of profile and lead with the minimum transmission error of a helical pair, or of a spur pair in 3D.

    Parameters
    ----------
    pair : Pair
        Helical, or with ``width="solid"`` or ``"slices"``.
    torque, load : torque or force, or several
        As in `relief`: several, or a range, are designed for together.
    design : mapping, optional
        Keys of ``[flank_design]`` of a case file: ``families``, ``scatter``, ``positions``, ``gear``, ...
    effects, tolerance, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results
        Tables ``flank_topography_<pair>_<gear>`` (exact), ``flank_designs_<pair>`` and ``grinding_<pair>``;
        `Pair.relieved` applies a design of the latter.
    """
    document, _ = _designed_for(pair, torque, load)
    loads = {"loads": document["pair"][pair.name]["loads"]} if "loads" in document["pair"][pair.name] else {}
    document["flank_design"] = {"pair": pair.name, **loads, **table(design, "design")}
    return ask_of_pair("flank-design", pair, document, effects, tolerance, progress, cache, neglected=False)
