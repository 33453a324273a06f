"""Stage ``transmission-error``: loaded transmission error, mesh stiffness and harmonics over one base pitch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import neglecting
from fegear.base.printed import figures
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.loaded_teeth import HARMONICS, MOST_CYCLES
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, drawn
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import LOADS, Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, EveryLoad, Off, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Reads, Upstream, Work
from fegear.geometry.relief import UNMODIFIED
from fegear.results import forecasts
from fegear.results.pair.iso_mesh_stiffness import (
    ISO_REMARK,
    ISO_VALUES,
    IsoMeshStiffness,
    iso_mesh_stiffness,
    said_beside_iso,
)
from fegear.results.pair.loaded_teeth import (
    BASE_PITCH,
    check_teeth,
    loaded_teeth,
    pitch_marks,
    teeth_stage,
)
from fegear.results.pair.mark_transmission_error import MARK_FIGURES, MARK_REMARKS, MARK_TABLES, MARK_VALUES, MarkData
from fegear.results.pair.mesh_table import MESH_REMARK, MESH_TABLE, EvenMesh, even_mesh
from fegear.results.pair.over_loads import OVER_LOADS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fegear.case.loading import TransmissionErrorPart
    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import LoadedTeeth
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.figure.items import Mark

#: One engagement solved over a base pitch [s], what corners off the path add to it, and a pair with a width.
_ERROR, _ERROR_CORNERS, _WIDE = 0.015, 0.05, 0.1
#: Harmonics in the figure.
_BARS = 16


@dataclass(frozen=True)
class TransmissionErrorData:
    """Transmission error of loaded teeth; evenly spaced and by Mark's series where the case asks for these.

    Its mean stiffness stands beside that of ISO 6336-1 where it is of finite elements; `flanks_said` is a clause of its
    sentence, that plane flanks have no relief.
    """

    found: ErrorOverPitch
    by_mark: MarkData | None
    even: EvenMesh | None = None
    iso: IsoMeshStiffness | None = None
    flanks_said: str = ""


def _compute(asked: Reads[TransmissionErrorPart], upstream: Upstream, work: Work) -> TransmissionErrorData:
    teeth = loaded_teeth(upstream, asked.name)
    found, by_mark = teeth.transmission_error(work.progress), None
    if asked.part.method == "mark-series":
        from fegear.results.pair.mark_transmission_error import mark_data

        by_mark = mark_data(cast("LoadedPair", teeth), asked.part.terms, found.rotational)
    even = None if asked.part.even_positions is None else even_mesh(found, asked.part.even_positions)
    by_fe = hasattr(teeth, "flanks") or cast("LoadedPair", teeth).spec.compliance == "fe"
    iso = iso_mesh_stiffness(found) if by_fe else None
    return TransmissionErrorData(found, by_mark, even, iso, _flanks_said(teeth))


def _flanks_said(teeth: LoadedTeeth) -> str:
    """A design beside it states the value that it leaves: which of both this is."""
    engagement = getattr(teeth, "engagement", None)
    if engagement is None:
        return ""
    # Each with the plain flank: two tables of a designed relief have no equality of their own.
    plain = all(relief == UNMODIFIED for relief in (engagement.driver_relief, engagement.driven_relief))
    return ", without relief" if plain else ""


def _marks(seen: Seen) -> Iterable[Mark]:
    return pitch_marks(seen.data.found.pair, seen.data.found.x)


def _load_with_torque(seen: Seen) -> Axis:
    """Load along the line of action, with the torque on the driver on the far side."""
    e = seen.data.found
    torque = axis_of(e, "driver_torque")
    return axis_of(e, "total_load", second=Scale(torque.label, torque.unit, e.loads, drawn(e, "driver_torque")))


_TITLE = "Transmission error of {name} over one base pitch"
_TABLES = (
    Rows(
        "transmission_error_{name}", _TITLE + ", {load:said}", (Every("pitch"), "te_error", "driver_angle", "te_0"),
        of="found", matlab=True,
    ),
    Rows(
        "transmission_error_harmonics_{name}", "Harmonics of the transmission error of {name}",
        (Every("harmonics"), Off("amplitude", "found.shift.amplitude")), of="found.harmonics",
    ),
    Rows(
        "transmission_error_summary_{name}", "Transmission error of {name} for every load",
        (
            "total_load", Every("loads", {"local_stiffness_mean": "local_stiffness"}),
            Off("te_mean", "found.mean_errors"), Off("te_peak_to_peak", "found.peak_to_peak_errors"),
            Off("te_effective", "found.effective_errors"),
        ),
        of="found",
        when=lambda seen: len(seen.loads) > 1,
    ),
    EveryLoad(
        "transmission_error_loads_{name}", _TITLE + ", every load (Harris map)", (Every("pitch"), "te_0"), "found",
        OVER_LOADS,
    ),
    Rows(
        "transmission_error_rotational_{name}", "Rotational harmonics of the transmission error of {name}",
        (
            Cell("n", meaning="harmonic of {d.found.cycles} base pitches; n = {d.found.cycles} is the tooth-mesh "
                 "frequency"),
            "mesh_order", "cosine", "sine", "amplitude",
        ),
        of="found.rotational_harmonics",
    ),
    MESH_TABLE,
)  # fmt: skip
_VALUES = (
    Number("te_mean", "found.shift.mean", "found"),
    Number("te_peak_to_peak", "found.shift.peak_to_peak", "found"),
    Number("te_effective", "found.shift.effective", "found"),
    Number("te_first_harmonic", "found.shift.first_harmonic", "found"),
    Number("mesh_stiffness_mean", "found.shift.stiffness", "found"),
    Number("local_stiffness_mean", "found.local_stiffness_error", "found"),
    Number("mesh_stiffness_on_path", "found.on_path_error", "found", when="found.off_path_stiffens"),
    Number("local_stiffness_on_path", "found.local_on_path_error", "found", when="found.off_path_stiffens"),
    # Its error is taken to be that of the mean transmission error.
    Number("mesh_compliance_mean", "found.mesh_compliance_error", "found"),
    Number(
        "largest", of="found.rotational_harmonics",
        meaning="amplitude, harmonic {d.found.rotational_harmonics.at_largest} of {d.found.cycles} base pitches",
    ),
)  # fmt: skip
_AMPLITUDE = Axis("amplitude of the transmission error", "um (amplitude)")
_FIGURES = (
    Chart(
        "transmission_error_{name}", "Transmission error of pair {name}",
        "Pair {name}: loaded transmission error over one base pitch (Harris map of its loads), and mesh stiffness at "
        "{load:said}: mean {d.found.local_stiffness_mean:.4g} (tangent). Peak to peak "
        "{d.found.te_peak_to_peak:.3g}, effective error A_e {d.found.te_effective:.3g}.",
        (
            Over(BASE_PITCH, (Line("te", each=LOADS),), marks=_marks),
            Over(
                BASE_PITCH,
                (
                    Line("mesh_stiffness", "secant stiffness", "secant"),
                    Line("local_stiffness", "local slope", "local slope"),
                ),
                options={"zero": True}, marks=_marks,
            ),
        ),
        of="found", under=LOADS,
    ),
    Chart(
        "transmission_error_harmonics_{name}", "Harmonics of the transmission error of pair {name}",
        "Pair {name}: harmonics of the static transmission error, {d.found.integrated}.",
        (
            Over("n",
                (Line("amplitude", error="found.shift.amplitude", each=LOADS, kind="bars", first=_BARS),),
                _AMPLITUDE, x_options={"whole": True},
            ),
        ),
        of="found.harmonics", under=LOADS,
    ),
    Chart(
        "transmission_error_summary_{name}", "Transmission error of {name} over load",
        "Pair {name}: mean and peak to peak of the loaded transmission error over one base pitch, for every load.",
        (
            Over(_load_with_torque, (Line("te_mean", x="total_load", error="found.mean_errors"),)),
            Over("total_load", (Line("te_peak_to_peak", error="found.peak_to_peak_errors"),)),
        ),
        of="found", when=lambda seen: len(seen.loads) > 1,
    ),
    Chart(
        "transmission_error_rotational_{name}", "Rotational harmonics of the transmission error of pair {name}",
        "Pair {name}: harmonics over the {d.found.cycles} base pitches until the same teeth mesh again, at "
        "{load:said}. Integers are mesh harmonics, the others are due to pitch deviations.",
        (Over("mesh_order", (Line("amplitude", kind="stems"),), _AMPLITUDE),),
        of="found.rotational_harmonics", under="{load:said}",
    ),
)  # fmt: skip
_REMARKS = (
    Remark(
        "Pair {name}: {name}.mesh_compliance_mean, Mark's mean of 1/K_T of ideal flanks, not available: with contact "
        "ratio {d.found.pair.contact_ratio:.4g} there are positions with corner contact only.",
        when=lambda seen: seen.data.found.mesh_compliance_mean is None,
    ),
    Remark(
        neglecting(
            "Pair {name}: hunting tooth cycle of {d.found.cycles} base pitches exceeds the maximum of "
            f"{MOST_CYCLES}; rotational harmonics of pitch deviations are neglected. Specify spacing_errors of one "
            "gear only to see its harmonics."
        ),
        when=lambda seen: seen.data.found.rotational is None and seen.data.found.cycles > MOST_CYCLES,
    ),
    Remark(
        "Pair {name}: with pitch deviations the transmission error differs for every base pitch; result for base "
        "pitch {d.found.only}, harmonics of its periodic repetition. Rotational harmonics are not computed in 3D.",
        when=lambda seen: seen.data.found.only is not None,
    ),
    MESH_REMARK,
)


def _over_loads(seen: Seen) -> Iterator[str]:
    """From the lowest to the highest of several loads, and the quietest of them."""
    e = seen.data.found
    if len(e.loads) > 1:
        low, high, quiet = np.argmin(e.loads), np.argmax(e.loads), np.argmin(e.te_peak_to_peak)
        torque, size = drawn(e, "driver_torque"), drawn(e, "te_peak_to_peak")
        yield (
            f"From {figures(torque[low])} to {figures(torque[high])} N m it changes from {figures(size[low])} to "
            f"{figures(size[high])} µm peak to peak; minimum {figures(size[quiet])} µm at {figures(torque[quiet])} N m."
        )


def _mean_stiffness(seen: Seen) -> Iterator[str]:
    """Which mean it is, and over which contact."""
    e = seen.data.found
    yield seen.said(
        "Pair {name}: mean mesh stiffness {v[mesh_stiffness_mean]} (secant: load / deflection of the pairs in "
        "contact), {v[local_stiffness_mean]} (tangent)" + _OVER_CONTACT[e.corner_contact, e.off_path_stiffens]
    )


#: Whether contact outside the path of contact is included, and what it changes.
_OVER_CONTACT = {
    (False, None): ", contact on the path of contact only.",
    (True, None): ", contact outside the path of contact included.",
    (True, False): ", contact outside the path of contact included (no influence).",
    (True, True): ", contact outside the path of contact included; {v[mesh_stiffness_mean_on_path]} and "
                  "{v[local_stiffness_mean_on_path]} without it.",
}  # fmt: skip


_ANSWER = Answer(
    "Pair {name} at {d.found.driver_torque:.3g}{d.flanks_said}: transmission error {v[te_peak_to_peak]} peak to peak, "
    "mean {v[te_mean]}.",
    _over_loads,
    _mean_stiffness,
    said_beside_iso,
    "Pair {name}: first harmonic of the mesh frequency {v[te_first_harmonic]} (amplitude).",
    figure="transmission_error_{name}", rank=lambda seen: -seen.data.found.te_peak_to_peak[seen.nominal],
    among="the largest of {count} pairs",
)  # fmt: skip
_SHEET = Sheet(
    loads="found.loads",
    nominal="found.at",
    tables=(*_TABLES, *MARK_TABLES),
    values=(*_VALUES, *ISO_VALUES, *MARK_VALUES),
    figures=(*_FIGURES, *MARK_FIGURES),
    remarks=(*_REMARKS, ISO_REMARK, *MARK_REMARKS),
    answer=_ANSWER,
    settings={
        "harmonics": lambda seen: seen.data.found.series[seen.data.found.at].amplitude.size,
        "positions": "found.positions",
        "method": lambda seen: seen.data.by_mark and seen.asked.part.method,
        "terms": "by_mark.series.terms",
    },
)


def _forecast(scene: Scene, name: str) -> Forecast:
    """One quadrature for each load of plane teeth, and its errors."""
    if name in scene.wide_pairs:
        return forecasts.constant(_WIDE)
    each = _ERROR + (_ERROR_CORNERS if scene.case.effects.corner_contact else 0.0)
    seconds = 1.5 * each * forecasts.loads(scene, name)
    if scene.case.effects.spacing_errors:
        seconds += 0.03
    return Forecast({"loads": forecasts.loads(scene, name), "harmonics": HARMONICS}, seconds)


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    if name in scene.wide_pairs and scene.case.transmission_error.method == "mark-series":
        raise InputError(
            "transmission_error.method", '"mark-series"',
            f"is defined for the plane (2D) model; pair {name} is 3D", "remove it",
        )  # fmt: skip


TRANSMISSION_ERROR = teeth_stage(
    answers=("transmission error",),
    every_load=True,
    inputs=Reads.of(lambda scene: scene.case.transmission_error),
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(
        Citation("mark", "static transmission error, its Fourier series and the mean compliance", "1.1 to 1.32, A.11"),
        Citation("lin-townsend-oswald", "effective error A_e"),
        Citation("harris", "transmission error over the mesh cycle for a family of loads"),
    ),
    forecast=_forecast,
)
