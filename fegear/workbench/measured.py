"""Questions about measurements, from a script: strain under gauges, traces of encoders beside the computed error."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.workbench.given import table
from fegear.workbench.given_traces import filed_trace, is_table, of_arrays
from fegear.workbench.pair import Pair
from fegear.workbench.quantities import Force, Torque
from fegear.workbench.questions import ask_of_pair, loaded_document
from fegear.workbench.results import Results

#: Name of a gauge that has none.
_GAUGE = "g"
#: Name of the encoders.
_RIG = "rig"
#: SI units of columns of arrays, by the key that names the column.
_STRAIN_UNITS = {
    "angle_column": ("angle", "rad"), "strain_column": ("strain", "m/m"), "torque_column": ("torque", "N*m"),
    "time_column": ("time", "s"),
}  # fmt: skip
_TE_UNITS = {"angle_column": ("angle", "rad"), "te_column": ("te", "m"), "torque_column": ("torque", "N*m")}


def _units(of: Mapping[str, tuple[str, str]], given: Any) -> dict[str, str]:
    """Units of columns by their names, which a case may change."""
    keys = given if isinstance(given, Mapping) else {}
    return {str(keys.get(key, name)): unit for key, (name, unit) in of.items() if not isinstance(keys.get(name), str)}


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
        In place of the file ``measured`` takes arrays, ``{"angle": ..., "strain": ..., "fit": [...]}`` (rad and m/m;
        quantities of pint; heads with units, ``"angle [deg]"``), or a DataFrame, alone or as ``{"data": frame, ...}``.
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
    given: Any = gauges if isinstance(gauges, Mapping) else table(gauges, "gauges")
    # of one gauge only `measured` is a table
    several = bool(given) and "measured" not in given and all(isinstance(one, Mapping) for one in given.values())
    named = {name: _with_file(one, name) for name, one in (given if several else {_GAUGE: given}).items()}
    document = loaded_document(pair, torque, load)
    document["gauge"] = {name: {"gear": pair.names[0], "pair": pair.name, **one} for name, one in named.items()}
    try:
        return ask_of_pair("gauge", pair, document, effects, tolerance, progress, cache, neglected=False)
    except InputError as error:
        raise of_arrays(error) from None


def _with_file(gauge: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The keys of a gauge, its trace in a file."""
    rest, key = {one: value for one, value in gauge.items() if one != "measured"}, f"gauge.{name}.measured"
    found = table(rest, "gauges")
    if (measured := gauge.get("measured")) is None:
        return found
    arrays = is_table(measured) or isinstance(measured, Mapping)
    return {**found, "measured": filed_trace(measured, key, _units(_STRAIN_UNITS, measured)) if arrays else measured}


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
    traces : path, mapping or DataFrame, or several
        CSV files; a mapping ``{"file": ..., "torque": "60 N*m"}`` says at which torque on the driver one was taken.
        In place of a file arrays, ``{"angle": ..., "te": ..., "torque": "60 N*m"}`` (rad, and m or rad; quantities of
        pint; heads with units, ``"te [um]"``), or a DataFrame, alone or as ``{"data": frame, "torque": ...}``.
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
    each: list[Any] = [traces] if isinstance(traces, (str, os.PathLike, Mapping)) or is_table(traces) else list(traces)
    if not each:
        raise InputError("traces", shown(traces), "must name at least one file", 'use traces="trace.csv"')
    rig = table(encoders, "encoders")
    along = rig.get("te_at", "line-of-action") == "line-of-action"
    units = _units({**_TE_UNITS, "te_column": ("te", "m" if along else "rad")}, rig)
    files = [
        filed_trace(one, f"encoders.{_RIG}.traces[{i}]", units)
        if isinstance(one, Mapping) or is_table(one)
        else {"file": os.fspath(one)}
        for i, one in enumerate(each)
    ]
    document = loaded_document(pair, torque, load)
    document["encoders"] = {_RIG: {"pair": pair.name, "traces": files, **rig}}
    wanted = "measured-transmission-error"
    try:
        return ask_of_pair(wanted, pair, document, effects, tolerance, progress, cache, neglected=False)
    except InputError as error:
        raise of_arrays(error) from None
