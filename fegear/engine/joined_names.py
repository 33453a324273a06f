"""Names of a case that would join to one name of two tables: pairs "I" and "harmonics_I".

Tables and figures are called by what they hold and whose it is, ``transmission_error_I`` and
``transmission_error_harmonics_I``, and files are called after them. A pair "harmonics_I" would write its transmission
error over the harmonics of pair "I", after all of it has been computed.
"""

from __future__ import annotations

from collections.abc import Iterable

from fegear.base.errors import InputError, shown

#: What names of tables and figures go on with where shorter ones end: a test looks for them in all results.
WORDS = frozenset({
    "agma", "asymptotes", "bearings", "candidates", "changes", "chart", "charts", "contact", "contact_kinds",
    "contact_pieces", "contact_single", "convergence", "critical_speeds", "curves", "curves_summary", "cutters",
    "design", "design_roll", "designs", "determinants", "deviations", "distribution", "distribution_loads",
    "distribution_roll", "distributions", "draws", "face", "factors", "families", "first_harmonic", "force",
    "force_of_teeth", "force_power", "force_series", "force_spectrum", "force_waterfall", "forces", "foretold",
    "fracture", "frequencies", "frequency_causes", "friction", "functions", "geometry", "geometry_check", "growth",
    "halves", "harmonic", "harmonics", "histogram", "history", "in_ring", "influences", "intensity", "iso_6336",
    "kinds", "line_load", "lines", "load_sharing", "loads", "loads_revolution", "loss", "loss_loads", "map",
    "matrix", "max", "mean", "mean_over_scatter", "members", "meshes", "mode_shapes", "modes", "motion", "numbers",
    "of", "on_teeth", "optimum", "order", "orders", "over_face", "over_face_loads", "over_holes", "over_torque",
    "parallel", "passing", "path", "peak_to_peak", "peak_to_peak_max", "peak_to_peak_rounded", "peaks",
    "percentiles", "phases", "phasing", "pieces", "places", "points", "pressure", "quantiles", "ratios", "reliefs",
    "response", "revolution", "revolution_lines", "revolution_orders", "ripple", "ripple_critical_speeds",
    "ripple_spectrum", "ripple_waterfall", "roll", "root_stress", "rotational", "rotational_series", "rounded",
    "safety", "series", "set", "shafts", "shapes", "shares", "sharing", "sharing_loads", "sidebands", "single",
    "sn", "spectra", "spectrum", "spectrum_factors", "speeds", "spread", "stiffness", "stiffness_harmonics",
    "stiffness_loads", "stiffness_matrix", "stiffness_mean", "stiffness_orders", "stiffness_over_face",
    "stiffness_revolution", "stress", "stress_histogram", "stress_history", "stress_over_face", "stress_ratios",
    "stress_spread", "stress_study", "stress_teeth", "study", "study_quantiles", "summary", "surface",
    "surface_over_face", "table", "te", "te_harmonics", "te_orders", "te_summary", "teeth", "tool", "tooth",
    "tooth_response", "tooth_stiffness", "tooth_vibration", "topography", "torques", "trade_off",
    "transmission_error", "unequal", "vibration", "vibration_revolution", "waterfall",
})  # fmt: skip


def refuse_joined(subjects: Iterable[str]) -> None:
    """Refuse gears, pairs and meshes of which one is called like another with a word of a table before it.

    Parameters
    ----------
    subjects : iterable of str
        Names that tables of a run are made for.

    Raises
    ------
    InputError
    """
    names = sorted({name for name in subjects if name})
    for name in names:
        for other in names:
            word = name.removesuffix(f"_{other}")
            if word != name and word in WORDS:
                rule = (
                    f"joins to names of tables that {shown(other)} has, such as those of its {word.replace('_', ' ')}"
                )
                raise InputError("gear, pair", shown(name), rule, "rename one of them")
