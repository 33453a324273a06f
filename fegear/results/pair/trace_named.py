"""What a trace has beside the curve that it is compared with: drift, runout, steps of the torque, samples left out."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures, percent, with_rough_error

if TYPE_CHECKING:
    from fegear.contact.fitted_curve import FittedCurve

#: Most samples of a figure.
_DRAWN = 2000
#: Difference of the gains of turns from which on the torque was not steady: of the gain, and in noise of a single one.
_STEPPED, _OF_NOISE = 0.15, 8.0
#: Correlation of the shapes below which the rest of a trace is no runout, and smallest part of the largest gain of its
#: turns that is still a torque: where the curve is not found in a turn at all the angle is wrong.
_OF_ITS_CURVE, _FOUND = 0.6, 0.05
#: Part of the range of the curve from which on steps and jumps are named, and hum, which stands out of the noise.
_LARGE, _HUM = 0.01, 0.002


def drawn_as(found: FittedCurve | None) -> str:
    """How figures draw a trace, a sentence after others; empty without one."""
    if found is None:
        return ""
    less = " and ".join(one for one in ("offset", "drift") if one in found.fit)
    said = " Points: strain as measured" + (f", less the fitted {less}" if less else "")
    if "scale" in found.fit:
        said += f"; thin line: the computed curve times the fitted scale, {found.scale:.3f}"
    return f"{said}." + (
        " Crosses: samples left out of the comparison, far ones nearer than they are." if found.left_out.size else ""
    )


def left_out(found: FittedCurve | None) -> str:
    """Samples that are no measurement, a sentence without a subject; empty for none."""
    if found is None or not found.spikes + found.saturated:
        return ""
    of = f"of {found.samples + found.spikes + found.saturated} samples"
    said = [f"{found.spikes} {of} are spikes or dropouts"] if found.spikes else []
    said += [f"{saturation(found, of)} (range of the amplifier)"] if found.saturated else []
    return f"{' and '.join(said)}; left out of the comparison, drawn as crosses"


def saturation(found: FittedCurve, of: str = "samples") -> str:
    """What is saturated, and where; empty for none."""
    if found.saturated_at is None:
        return ""
    return f"{found.saturated} {of} are saturated at {figures(found.saturated_at * 1e6)} µm/m"


def jump_of(found: FittedCurve) -> str:
    """By what the zero of a trace jumps, and where, a clause after others; empty where that is little."""
    if (jump := found.jump) is None or abs(jump.height) < _LARGE * _range(found):
        return ""
    return f"jumps by {figures(jump.height * 1e6)} µm/m after {jump.turn:.2f} turns"


def drift_named(found: FittedCurve | None) -> str:
    """How the zero of a trace drifts or jumps, a sentence without a subject; empty where it does not.

    A drift is named where nobody asked for it.
    """
    if found is not None and (jumps := jump_of(found)):
        return (
            f"the zero of the measured strain {jumps} (connector, slip ring, balancing of the bridge), which falsifies "
            "offset and residual; give the trace before or after it"
        )
    if found is None or found.trend_error is None or (drift := found.unfitted_drift) is None:
        return ""
    return (
        f"the measured strain drifts by {with_rough_error(drift * 1e6, found.trend_error * 1e6)} µm/m per turn "
        f"({figures(drift * found.turns * 1e6)} µm/m over {figures(found.turns)} turns), which falsifies offset and "
        'residual; add "drift" and "offset" to fit'
    )


def runout_named(found: FittedCurve | None) -> str:
    """What a trace has once per turn, a sentence without a subject; empty where that is little."""
    if found is None or (wave := found.wave) is None or not (found.wave_less or found.unfitted_runout):
        return ""
    if not found.wave_less and found.likeness < _OF_ITS_CURVE:
        return ""
    size = with_rough_error(wave.amplitude * 1e6, wave.error * 1e6)
    measured, place = (
        math.degrees(one or 0.0) for one in (found.runout_measured_angle, found.runout_angle)
    )  # fmt: skip
    said = (
        f"once per turn the measured strain has {size} µm/m with its maximum at {measured:.0f}° of the measured angle, "
        f"a rotation of {place:.0f}° from the contact of the tooth of the gauge at the pitch point"
    )
    if found.wave_less:
        return f"{said}, subtracted"
    return f'{said} (bending of the shaft, runout, slip ring), not subtracted; add "runout" and "offset" to fit'


def hum_named(found: FittedCurve | None) -> str:
    """Mains hum of a trace, a sentence without a subject; empty where that is little."""
    if found is None or (hum := found.hum) is None or hum.amplitude < _HUM * _range(found):
        return ""
    return (
        f"the measured strain has ±{figures(hum.amplitude * 1e6)} µm/m at {figures(hum.frequency)} Hz "
        f"({figures(hum.order)} times per turn, no multiple of the shaft frequency), outside the mesh as well: mains "
        "hum; check shield and earth of the leads, or use a carrier-frequency amplifier"
    )


def step_named(found: FittedCurve | None) -> str:
    """Coarse steps of a trace, a sentence without a subject; empty where they are small."""
    if found is None or found.step < _LARGE * _range(found):
        return ""
    return (
        f"the measured strain has steps of {figures(found.step * 1e6)} µm/m, {percent(found.step / _range(found))} of "
        "the range of the curve (resolution of amplifier or file): set a smaller measuring range or write more digits"
    )


def _range(found: FittedCurve) -> float:
    """Of the fitted curve, as it would be measured."""
    return float(np.ptp(found.computed)) * abs(found.gain)


def unsteady_named(found: FittedCurve | None) -> str:
    """That a gain differs from turn to turn by more than noise, a sentence without a subject; empty where not."""
    if found is None or not (gains := found.turn_gains).size:
        return ""
    low, high = float(gains.min()), float(gains.max())
    one = found.gain_noise * math.sqrt(gains.size)
    if found.gain <= 0.0 or low < _FOUND * high or high - low <= max(_STEPPED * abs(found.gain), _OF_NOISE * one):
        return ""
    return (
        f"measured / computed strain is {low:.2f} to {high:.2f} from turn to turn: the torque was not steady (add its "
        "column, torque_column, or give one file per torque), or bond or leads of the gauge came loose"
    )


def thinned(found: FittedCurve) -> FittedCurve:
    """As many samples as a figure can show; those that are left out within reach of the others."""
    some, of_left_out = (slice(None, None, max(-(-size // _DRAWN), 1)) for size in (found.samples, found.left_out.size))
    low, high = (float(edge(found.measured)) for edge in (np.min, np.max))
    room = high - low  # a dropout to -9999 would leave of the curve a line
    return replace(
        found, angle=found.angle[some], measured=found.measured[some], computed=found.computed[some],
        left_out_angle=found.left_out_angle[of_left_out],
        left_out=np.clip(found.left_out[of_left_out], low - room, high + room),
    )  # fmt: skip
