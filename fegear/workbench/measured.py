"""Questions about measurements, from a script: strain under gauges, traces of encoders beside the computed error."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.workbench.given import table
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Force, Torque
from fegear.workbench.questions import ask_of_pair, loaded_document
from fegear.workbench.results import Results

#: Name of a gauge that has none.
_GAUGE = "g"
#: Name of the encoders.
_RIG = "rig"


def gauge(
    pair: Pair,
    gauges: Mapping[str, Any],
    *,
    torque: Torque | Iterable[Torque] | None = None,
    load: Force | Iterable[Force] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Strain under gauges in root fillets over the rotation of their gear, and the comparison with what they measured.

    Parameters
    ----------
    pair : Pair
        Spur or helical, plane or 3D.
    gauges : mapping
        Keys of ``[gauge.NAME]`` of a case file, for one gauge, or by the names of several: ``gear`` (by default the
        driver), ``fillet``, ``tangent_angle``, ``grid_length``, ``face_position``, ``measured = {"file": ...}``, ...
    torque, load, effects, tolerance, progress, cache
        As in `fegear.transmission_error`.

    Returns
    -------
    Results
        Tables ``gauge_<name>``, ``gauge_places_<name>``, ``gauge_measured_<name>``; values ``<name>.peak_strain``,
        ``<name>.measured_scale``, ... A gauge without a name is called ``g``.

    Raises
    ------
    InputError
        If a key does not fit: key, value, rule, remedy.
    """
    given = table(gauges, "gauges")
    # of one gauge only `measured` is a table
    several = bool(given) and "measured" not in given and all(isinstance(one, Mapping) for one in given.values())
    named = given if several else {_GAUGE: given}
    document = loaded_document(pair, torque, load)
    document["gauge"] = {name: {"gear": pair.names[0], "pair": pair.name, **one} for name, one in named.items()}
    return ask_of_pair("gauge", pair, document, effects, tolerance, progress, cache, neglected=False)


def measured_transmission_error(
    pair: Pair,
    traces: str | os.PathLike[str] | Mapping[str, Any] | Iterable[str | os.PathLike[str] | Mapping[str, Any]],
    *,
    torque: Torque | Iterable[Torque] | None = None,
    load: Force | Iterable[Force] | None = None,
    encoders: Mapping[str, Any] | None = None,
    effects: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    progress: bool | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Traces of two encoders beside the computed transmission error: verdict, orders, mesh harmonics over torque.

    Parameters
    ----------
    pair : Pair
    traces : path or mapping, or several
        CSV files; a mapping ``{"file": ..., "torque": "60 N*m"}`` says at which torque on the driver one was taken.
    torque, load, effects, tolerance, progress, cache
        As in `fegear.transmission_error`: every torque of the traces.
    encoders : mapping, optional
        Further keys of ``[encoders.NAME]`` of a case file: ``fit``, ``shaft``, ``te_at``, ``angle_column``, ...

    Returns
    -------
    Results
        Tables ``measured_te_rig``, ``measured_te_summary_rig``, ``measured_te_orders_rig``,
        ``measured_te_harmonics_rig``; values ``rig.measured_to_computed``, ``rig.measured_scale``, ...

    Raises
    ------
    InputError
        If a key or a file does not fit: key, value, rule, remedy.
    """
    each = [traces] if isinstance(traces, (str, os.PathLike, Mapping)) else list(traces)
    if not each:
        raise InputError("traces", shown(traces), "must name at least one file", 'use traces="trace.csv"')
    files = [table(one, "traces") if isinstance(one, Mapping) else {"file": os.fspath(one)} for one in each]
    document = loaded_document(pair, torque, load)
    document["encoders"] = {_RIG: {"pair": pair.name, "traces": files, **table(encoders, "encoders")}}
    wanted = "measured-transmission-error"
    return ask_of_pair(wanted, pair, document, effects, tolerance, progress, cache, neglected=False)
