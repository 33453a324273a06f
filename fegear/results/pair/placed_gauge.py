"""What results of gauges share: grids on a solved fillet, and a trace laid over a computed curve and shown with it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.angle_of_time import steady_turning
from fegear.case.built.gauges import Gauge, place_gauge
from fegear.contact.curve_fit import NothingToCompareError, fit_curve
from fegear.contact.fitted_line import FITTED
from fegear.contact.mains_hum import mains_hum
from fegear.contact.once_per_turn import once_per_turn
from fegear.contact.trace_alternatives import alternatives, unexplained
from fegear.contact.trace_low_pass import low_pass
from fegear.contact.turns import going_on, turns_along
from fegear.contact.zero_jump import zero_jump
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Rows
from fegear.fem.plane.gauge import FilletProfile, GaugesOnFillet
from fegear.results.pair.gauge_data import GaugePlace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.fitted_line import Fitted
    from fegear.contact.trace_alternatives import Alternative
    from fegear.contact.trace_low_pass import LowPass
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.trace import LoadedFlank
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair, Member

#: Places to either side of the grid's at which the peak is computed.
_PLACES = 10
#: Part of the variance left unexplained, and relative error of an angle, above which an encoder may miscount.
_UNEXPLAINED, _MISCOUNTED = 2e-3, 2e-4
#: Looks of displaced grids, towards the root and towards the tip, and of samples.
DASHED, DOTTED = {"dash": "dash", "width": 1.0}, {"dash": "dot", "width": 1.6}
#: Of a computed curve times a fitted scale.
TIMES = {"dash": "solid", "width": 1.2, "markers": False}
_DOTS = {"size": 5.0, "symbol": "circle"}


@dataclass(frozen=True)
class PlacedGauge:
    """Where a gauge lies on the fillet of a solved gear, and grids within its placement tolerance.

    Parameters
    ----------
    middle : float
        Place of the middle of the grid up the fillet [m].
    displacement : ndarray, shape (G,)
        Zero is among them [m].
    place : GaugePlace
    above : float
        From the end of the grid to the end of the fillet [m].
    clipped : bool
        Whether the placement tolerance reaches beyond the fillet.
    """

    middle: float
    displacement: Array
    place: GaugePlace
    above: float
    clipped: bool

    @property
    def arc(self) -> Array:
        """Middles of all grids [m]."""
        return self.middle + self.displacement

    def clearance(self, pair: GearPair, member: Member, side: Side, flank: LoadedFlank) -> float:
        """From the end of the grid to the lowest contact on the flank above it, along the profile [modules]."""
        if side == "compression":
            return math.inf
        module = pair.driver.module
        ends = pair.radius(np.array([pair.x_start, pair.x_end]), member) / module
        return float(np.min(flank.arc_of_radius(ends)) - flank.flank_start) + self.above / module


def placed(gauge: Gauge, profile: FilletProfile, half: float) -> PlacedGauge:
    """A gauge on a fillet, of which its grid covers `half` to either side of its middle [m].

    Raises
    ------
    InputError
        If it does not lie on the fillet.
    """
    middle, length = place_gauge(gauge, profile), float(profile.arc[-1])
    low = min(max(-gauge.placement, half - middle), 0.0)
    high = max(min(gauge.placement, length - half - middle), 0.0)
    displacement = np.unique(np.concatenate([np.linspace(low, 0.0, _PLACES + 1), np.linspace(0.0, high, _PLACES + 1)]))
    at = profile.at(middle)
    return PlacedGauge(
        middle, displacement, GaugePlace(middle, 2.0 * at["radius"], at["tangent_angle"], at["centre_angle"], gauge.z),
        length - half - middle, high - low < 2.0 * gauge.placement * (1.0 - 1e-9),
    )  # fmt: skip


def placed_gauge(gauge: Gauge, solved: GearInfluence) -> PlacedGauge:
    """A gauge on the fillet of a plane gear as it is meshed."""
    profile = FilletProfile.of_mesh(solved.fine.fillets[gauge.side], solved.gear)
    return placed(gauge, profile, gauge.grid.half)


def placed_on_face(gauge: Gauge, solved: SolidInfluence, gear: Gear) -> PlacedGauge:
    """A gauge on the fillet of a 3D gear as it is solved, in its transverse section."""
    from fegear.fem.solid.gauge import half_up_fillet, lean_at, profile_of_solid

    fillet = solved.fine.fillets[gauge.side]
    profile = profile_of_solid(fillet, gear)
    skew, across = lean_at(fillet, solved.fine.tau, place_gauge(gauge, profile) / gear.module)
    half = half_up_fillet(gauge.grid, skew / across)
    place = placed(gauge, profile, half)
    profile.check(place.middle, gauge.grid, half)
    return place


def gauges_on(gauge: Gauge, at: PlacedGauge, solved: GearInfluence) -> tuple[GaugesOnFillet, GaugesOnFillet]:
    """A gauge at all of its places on a plane gear, and one like it in the other fillet."""
    other: Side = "compression" if gauge.side == "tension" else "tension"
    return (
        GaugesOnFillet(solved, gauge.side, gauge.grid, at.arc),
        GaugesOnFillet(solved, other, gauge.grid, np.array([at.middle])),
    )


def compared(gauge: Gauge, angle: Array, strain: Array, speed: float | None = None) -> FittedCurve | None:
    """What the gauge measured beside a computed curve; None where it measured nothing.

    Parameters
    ----------
    gauge : Gauge
    angle, strain : ndarray, shape (P,)
        Computed.
    speed : float, optional
        Of its gear during the trace [rad/s].

    Raises
    ------
    InputError
        If the trace is elsewhere.
    """
    measured = gauge.measured
    if measured is None:
        return None
    try:
        found = fit_curve(measured.angle, measured.strain, angle, strain, measured.fit)
        turns = turns_along(measured.angle)
        wave = once_per_turn(measured.angle, measured.strain, turns, found.shift, angle)
        if wave is not None and measured.runout:
            less = measured.strain - wave.at(measured.angle)
            found = fit_curve(measured.angle, less, angle, strain, measured.fit, found.step)
        jump = zero_jump(measured.angle, measured.strain, turns, found.shift, angle)
        found = replace(found, wave=wave, wave_less=measured.runout, jump=jump)
        hum = mains_hum(measured.angle, measured.strain, turns, speed, found.shift, angle)
        if hum is None:
            return found
        # whether torque and gauge were steady shows without it
        less = measured.strain - hum.at(turns)
        steady = fit_curve(measured.angle, less, angle, strain, measured.fit, found.step)
        return replace(found, hum=hum, turn_gains=steady.turn_gains)
    except NothingToCompareError:
        ends = np.rad2deg(angle[[0, -1]])
        raise InputError(
            f"gauge.{gauge.name}.measured.file", f'"{measured.file}"',
            f"has too few samples within the computed engagement, {ends[0]:.4g} to {ends[1]:.4g} deg",
            "check the unit of the angle" if "shift" in measured.fit else 'set fit = ["shift"]',
        ) from None  # fmt: skip


def better_described(
    gauge: Gauge, found: FittedCurve | None, pair: GearPair, angle: Array, strain: Array, opposite: Array | None = None
) -> tuple[Alternative, ...]:  # fmt: skip
    """Descriptions of a trace that fit clearly better than the given one; none without a trace.

    Parameters
    ----------
    gauge : Gauge
    found : FittedCurve or None
        Its trace as described.
    pair : GearPair
    angle, strain : ndarray, shape (P,)
        Computed.
    opposite : ndarray, shape (P,), optional
        Of an equal gauge in the other fillet.
    """
    measured = gauge.measured
    if measured is None or found is None:
        return ()
    curves = {"": strain} if opposite is None else {"": strain, "opposite": opposite}
    own, mate = abs(pair.gear(gauge.member).teeth), abs(pair.mate(gauge.member).teeth)
    turnings = {"twice": 0.5, "half": 2.0}
    if own != mate:
        turnings = {"mate": mate / own, **turnings}
        if measured.of_mate:  # the angle has been multiplied by that already
            turnings["own"] = own / mate
    if not gauge.over_time and (counted := counted_angle(measured.angle, measured.strain, found)) is not None:
        turnings["counted"] = counted
    return alternatives(
        found, measured.angle, measured.strain, angle, curves, measured.fit, turnings=turnings
    )  # fmt: skip


def counted_angle(angle: Array, strain: Array, found: FittedCurve) -> float | None:
    """Factor by which the angle would repeat with the trace, of an encoder that loses pulses; None where it does."""
    if unexplained(found) < _UNEXPLAINED:
        return None
    going = going_on(angle)
    turned = going - going[0] if going[-1] >= going[0] else going[0] - going
    turning = steady_turning(turned, strain, 1.0)
    return turning.speed if turning.found and abs(turning.speed - 1.0) > _MISCOUNTED else None


def behind_low_pass(
    gauge: Gauge, found: FittedCurve | None, better: Sequence[Alternative], angle: Array, strain: Array
) -> LowPass | None:  # fmt: skip
    """The low pass that explains a trace which no other description does; None without one.

    Parameters
    ----------
    gauge : Gauge
    found : FittedCurve or None
        Its trace as described.
    better : sequence of Alternative
    angle, strain : ndarray, shape (P,)
        Computed.
    """
    if gauge.measured is None or found is None or better:
        return None
    return low_pass(found, gauge.measured.angle, gauge.measured.strain, angle, strain, gauge.measured.fit)


def comparison_values(prefix: str = "", at: str = "compared", fit: str = "") -> tuple[Number | Each, ...]:
    """Values of a comparison, which stands there; their names begin with the prefix.

    Parameters
    ----------
    prefix, at : str
    fit : str
        Where the comparison is whose fitted numbers say something. Default: the same.
    """
    fit = fit or at
    names = {
        "offset": "measured_offset", "scale": "measured_scale", "shift": "measured_shift", "gain": "measured_gain",
        "drift": "measured_drift", "rms": "residual_rms", "correlation": "correlation", "samples": "measured_samples",
        "noise": "measured_noise", "spikes": "measured_spikes", "saturated": "measured_saturated",
    }  # fmt: skip

    def name(quantity: str) -> str:
        known = quantity.removesuffix("_error")
        return prefix + names[known] + ("_standard_error" if known != quantity else "")

    def fitted(quantity: Fitted) -> Each:
        return Each(
            lambda seen: [seen.find(fit)],
            Number(quantity, name=name(quantity)), Number(f"{quantity}_error", name=name(f"{quantity}_error")),
            when=lambda seen: seen.one is not None and quantity in seen.one.fit,
        )  # fmt: skip

    def counted(quantity: str) -> Number:
        return Number(
            quantity, exact, of=at, name=name(quantity),
            when=lambda seen: (found := seen.find(at)) is not None and getattr(found, quantity) > 0,
        )  # fmt: skip

    others = ("gain", "gain_error")
    return (
        *map(fitted, FITTED),
        *(Number(one, of=fit, name=name(one), when=lambda seen: seen.find(fit) is not None) for one in others),
        # over a fitted scale near zero a residual is without limit
        Number(
            "rms",
            name=name("rms"),
            of=lambda seen: seen.find(fit) or seen.find(at),
            when=lambda seen: getattr(seen.find(fit) or seen.find(at), "fits", False),
        ),
        Number("correlation", of=lambda seen: seen.find(fit) or seen.find(at), name=name("correlation")),
        Number("samples", exact, of=at, name=name("samples")),
        *(
            Number(one, of=fit, name=prefix + declared, when=_has_runout(fit))
            for one, declared in (
                ("runout", "measured_runout"),
                ("runout_error", "measured_runout_standard_error"),
                ("runout_angle", "measured_runout_angle"),
                ("runout_measured_angle", "measured_runout_at_measured_angle"),
            )
        ),
        counted("spikes"),
        counted("saturated"),
    )


def _has_runout(at: str) -> Callable[[Seen], bool]:
    """Whether a trace has a part once per turn that is certain, or less which it is compared."""

    def certain(seen: Seen) -> bool:
        found: FittedCurve | None = seen.find(at)
        return found is not None and (found.wave_less or found.unfitted_runout is not None)

    return certain


def comparison_table(name: str, title: str) -> Rows:
    """Samples beside the computed curve."""
    return Rows(name, title, ("angle", "measured", "computed", "residual"), of="compared")


#: Samples of a comparison, which stands thinned at `drawn`, as measured (less offset and drift), those that are
#: left out, the computed curve times a fitted scale, and a panel of what that leaves: a scale that is wrong shows.
LEFT_OUT = Line(
    "left_out_as_measured", "left out", "series:4", x="left_out_angle", of="drawn", kind="points",
    look={"size": 6.0, "symbol": "x"}, when=lambda seen: bool(seen.data.without),
)  # fmt: skip
MEASURED = Line("as_measured", "measured", "series:1", of="drawn", kind="points", look=_DOTS)
TIMES_SCALE = (
    Line(
        "fitted", lambda seen: f"computed times the fitted scale {seen.data.compared.scale:.3f}", "series:3",
        x="drawn_angle", of="drawn", look=TIMES,
        when=lambda seen: seen.data.compared is not None and "scale" in seen.data.compared.fit,
    ),
)  # fmt: skip
RESIDUAL = Over(
    "angle", (Line("left_by_fit", "measured less fitted", "series:1", kind="points", look=_DOTS),), of="drawn",
    marks=lambda _seen: (Mark("y", 0.0),), when="compared",
)  # fmt: skip
