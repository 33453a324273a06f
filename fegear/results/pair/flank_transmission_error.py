"""Stage ``flank-transmission-error``: result ``transmission-error`` of pairs that are loaded with their width."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.loaded_flanks import FLANK_EFFECTS
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Subject
from fegear.engine.table import Column
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks, wide_pairs
from fegear.results.pair.transmission_error import (
    ErrorOverPitch,
    error_figures,
    error_tables,
    error_values,
    mesh_compliance_value,
)

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.plane.shifted_compliance import TransmissionErrorShift
    from fegear.contact.wide.transmission_error import FlankTransmissionError
    from fegear.engine.stage import Upstream, Work
    from fegear.results.pair.loaded_flanks import LoadedFlanksData


@dataclass(frozen=True)
class FlankTransmissionErrorData:
    """What the stage hands to tables and pictures.

    Parameters
    ----------
    loaded : LoadedFlanksData
    each : tuple of FlankTransmissionError
        For every load, at as many roll positions as what is stated of the base pitch needs.
    shown : tuple of FlankTransmissionError
        The same at the roll positions of the tables.
    shift : TransmissionErrorShift
        Estimated errors at the nominal load.
    mesh_compliance : float
        Mean of 1/K_T of perfect flanks [m/N].
    """

    loaded: LoadedFlanksData
    each: tuple[FlankTransmissionError, ...]
    shown: tuple[FlankTransmissionError, ...]
    shift: TransmissionErrorShift
    mesh_compliance: float


def _compute(inputs: Subject, upstream: Upstream, _work: Work) -> FlankTransmissionErrorData:
    from fegear.contact.wide.transmission_error import flank_transmission_error_shift, flank_transmission_errors

    loaded = loaded_flanks(upstream, inputs.name)
    over, i = loaded.over, loaded.nominal
    each = tuple(
        replace(te, peak_to_peak=float(swing))
        for te, swing in zip(flank_transmission_errors(over.found, over.points), over.stated.peak_to_peak, strict=True)
    )
    shown, again = (flank_transmission_errors(one, loaded.flanks.points) for one in (loaded.found, loaded.error.coarse))
    perfect = replace(loaded.flanks, positions=over.found.lines.roll.size).solve(
        [loaded.asked.nominal], None, over.found.known
    )
    compliance = float(perfect.mean_transmission_error[0]) / loaded.asked.nominal
    shift = _missed_too(flank_transmission_error_shift(each[i], shown[i], again[i]), each[i], loaded.missed)
    # What is stated of the whole base pitch is stated once.
    shift = replace(shift, mean=float(loaded.error.mean[i]), peak_to_peak=float(loaded.error.peak_to_peak[i]))
    return FlankTransmissionErrorData(loaded, each, shown, shift, compliance)


def _missed_too(shift: TransmissionErrorShift, te: FlankTransmissionError, missed: float) -> TransmissionErrorShift:
    """The same with what slices are known to miss of compliances."""
    return replace(
        shift,
        mean=shift.mean + missed * te.mean,
        peak_to_peak=shift.peak_to_peak + missed * te.peak_to_peak,
        effective=shift.effective + missed * te.effective_error,
        amplitude=shift.amplitude + missed * te.series.amplitude,
        stiffness=shift.stiffness + missed * te.mean_secant,
    )


def _present(data: FlankTransmissionErrorData, inputs: Subject) -> Outcome:
    loaded, found, i = data.loaded, data.loaded.found, data.loaded.nominal
    secant, local = (np.stack([getattr(te, key) for te in data.shown], axis=1) for key in ("secant", "local"))
    harmonics = data.each[i].series.amplitude.size
    shown = ErrorOverPitch(
        inputs.name, found.pair, loaded.asked.loads, i, data.each, found.lines.roll, found.transmission_error,
        secant, local, (found.pair_load > 0.0).sum(axis=0), data.each[i].mean_secant, data.shift,
        f"from {data.each[i].values.size} roll positions over the base pitch",
    )  # fmt: skip
    error = Column("te_error", loaded.error.transmission_error[:, i], "um", "estimated error of te")
    remarks = []
    if loaded.asked.effects.spacing_errors:
        remarks.append(
            f"Pair {inputs.name}: with spacing errors every base pitch has a transmission error of its own; this is "
            f"that of base pitch {loaded.asked.base_pitch}, its harmonics are those of a pair that repeats it, and "
            "rotational harmonics are not computed over the face."
        )
    return Outcome(
        data,
        tuple(error_tables(shown, (error,))),
        (*error_values(shown), mesh_compliance_value(shown, data.mesh_compliance)),
        {"harmonics": harmonics, "positions": data.each[i].values.size},
        tuple(remarks),
        error_figures(shown),
    )


def _check(scene: Scene, name: str) -> None:
    if scene.case.transmission_error.method == "mark-series":
        raise InputError(
            "transmission_error.method", '"mark-series"',
            f"is Mark's series of plane teeth, and pair {name} is loaded with its width", "remove it",
        )  # fmt: skip


FLANK_TRANSMISSION_ERROR = Stage(
    subjects=wide_pairs,
    needs=needs_flanks,
    inputs=Subject.of,
    compute=_compute,
    present=_present,
    check=_check,
    effects=FLANK_EFFECTS,
    cites=citing(
        Citation("mark", "static transmission error and the mean compliance", "1.1 to 1.32, A.11"),
        Citation("lin-townsend-oswald", "effective error A_e"),
        Citation("harris", "transmission error over the mesh cycle for a family of loads"),
    ),
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
