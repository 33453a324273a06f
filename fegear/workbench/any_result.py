"""Any result of the catalogue for a gear or a pair, from a script, and the comparison of formulas with FE."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.results.catalogue import STAGES
from fegear.workbench.gear import Gear
from fegear.workbench.given import cache_of, table, taken, texts, working_folder
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Force, Speed, Torque, brief
from fegear.workbench.questions import loaded_document, root_stress
from fegear.workbench.results import Results
from fegear.workbench.run import run_scene


def compute(
    of: Gear | Pair,
    results: str | Iterable[str],
    *,
    torque: Torque | Iterable[Torque] | None = None,
    load: Force | Iterable[Force] | None = None,
    speed: Speed | None = None,
    tables: Mapping[str, Any] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Compute any results of ``fegear results`` that a gear or a pair has, without a case file.

    Parameters
    ----------
    of : Gear or Pair
    results : str or iterable of str
        ``"load-distribution"``, ``["flank-surface", "gear-mesh-power-loss"]``, ...
    torque, load : torque or force, or several, optional
        On the driver, or along the line of action; required by results of loaded teeth.
    speed : speed, optional
        Of the driver; that of the pair by default.
    tables : mapping, optional
        Further tables of a case file: ``{"load_distribution": {"positions": 24}, "design": {...}}``. Keys of ``pair``
        and ``gear`` in them are added to those of the gears and the pair.
    effects, tolerance, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results

    Raises
    ------
    InputError
        If a name is no result, or a key does not fit: key, value, rule, remedy.
    """
    if isinstance(of, Pair):
        document = loaded_document(of, torque, load) if torque is not None or load is not None else of.document()
        if speed is not None:
            document["pair"][of.name] = {**document["pair"][of.name], "speed": speed}
        document["effects"] = {"start": "described", **table(effects, "effects")}
        known = of.known
    elif isinstance(of, Gear):
        for key, given in (("torque", torque), ("load", load), ("speed", speed), ("effects", effects)):
            if given is not None:
                raise InputError(key, brief(given), "applies to pairs, not to gears", "specify a fegear.Pair")
        document, known = {"gear": {of.name: of.keys}}, None
    else:
        raise InputError("of", brief(of), "must be a fegear.Gear or a fegear.Pair", "use fegear.Pair(pinion, wheel)")
    if not (wanted := texts(results, "results")):
        raise InputError("results", "[]", "must name at least one result", 'for example "load-distribution"')
    if tolerance is not None:
        document["accuracy"] = {"tolerance": tolerance}
    document = _joined(document, table(tables, "tables"))
    title = f"{', '.join(map(_spoken, wanted))} of {' and '.join(document['gear'])}"
    whole = {"title": title, "results": wanted, **document}
    scene = replace(build_scene(taken(whole, "case"), wanted[0], working_folder(), bare_si=True), neglects=False)
    return run_scene(scene, progress=progress, cache=cache_of(cache) if known is None else cache_of(cache, known))


def crosscheck(
    of: Gear | Iterable[Gear] | Pair,
    *,
    torque: Torque | None = None,
    load: Force | None = None,
    positions: int | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Compare formulas for stiffness and root stress (ISO 6336, AGMA 908, Cornell, ...) with finite elements.

    Parameters
    ----------
    of : Gear, iterable of Gear, or Pair
        Of a pair also the mesh stiffness over the mesh cycle, and while each cracked or pitted tooth passes; c' and
        c_gamma_alpha of ISO 6336-1 and the root stress of ISO 6336-3; of helical pairs only what ISO 6336 gives.
    torque, load : torque or force, optional
        Of a pair, on the driver or along the line of action; 100 N/mm by default.
    positions : int, optional
        Loads along the flank; 20 by default.
    tolerance, progress, cache
        As in `transmission_error`.

    Returns
    -------
    Results
        Tables ``crosscheck_root_stress_<gear>``, ``crosscheck_compliance_<gear>``, ``crosscheck_compliance_<pair>``,
        ``crosscheck_mesh_stiffness_<pair>``, ``crosscheck_odd_tooth_<pair>_<gear>_<tooth>``,
        ``crosscheck_iso_6336_<pair>``; values ``<gear>.root_stress.<formula>.highest_ratio``, ...
    """
    if not isinstance(of, Pair):
        for key, given in (("torque", torque), ("load", load)):
            if given is not None:
                raise InputError(key, brief(given), "applies to pairs, not to gears", "specify a fegear.Pair")
        return root_stress(of, positions=positions, tolerance=tolerance, progress=progress, cache=cache)
    return compute(
        of, "crosscheck", torque=torque, load=load, tables={"stiffness": {"positions": positions or 20}},
        tolerance=tolerance, progress=progress, cache=cache,
    )  # fmt: skip


def _spoken(result: str) -> str:
    """A result in words, as progress and reports name it."""
    return next((entry.title for entry in STAGES.entries if result in entry.results), result)


def _joined(document: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    """Tables with those of another document, key by key."""
    both = {key: _joined(document[key], more[key]) for key in document.keys() & more.keys()
            if isinstance(document[key], Mapping) and isinstance(more[key], Mapping)}  # fmt: skip
    return {**document, **more, **both}
