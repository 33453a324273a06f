"""Stage ``rack-transmission-error``: loads, transmission error and root stress over the stroke of a rack."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import neglecting
from fegear.base.printed import figures, rounded
from fegear.base.shown import shown
from fegear.case.built.rack import is_wide_rack, loaded_rack_inputs, rack_inputs, racks
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ, PATCH, RING
from fegear.results.gear.solved_gear import solid_solution_of, solution_of
from fegear.results.rack.solid_rack import needs_solid_rack, solid_rack_of
from fegear.results.rack.solved_rack import compliances, needs_rack, rack_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.built.rack import RackInputs
    from fegear.case.reading import Scene
    from fegear.contact.rack.stroke import Stroke
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Forecast, Upstream, Work


#: Seconds of a 3D rack at one position of a base pitch of the stroke, both solutions; base pitches that differ.
_SECONDS_WIDE, _APART = 0.13, 10
#: Error of the root stress of 3D teeth over what coarser elements change of it, as of single entries of solid gears.
_OF_ROOTS = 1.5
#: Of root fillets.
SIDES = ("tension", "compression")


@dataclass(frozen=True)
class OverStroke:
    """Positions of the stroke at which teeth are in contact, shape (N,)."""

    travel: Array = shown(
        "mm", "travel of the rack from the first contact of its first tooth", label="travel of the rack"
    )
    tooth: NDArray[np.int64] = shown("", "tooth of the rack that came into contact last, from 1")
    error: Array = shown(
        "um", "transmission error: travel of the rack due to the load", name="te", label="transmission error"
    )
    pairs: NDArray[np.int64] = shown("", "tooth pairs in contact", name="pairs_in_contact")
    share: Array = shown("", "largest share of the load on one tooth pair", name="largest_share")
    tension: Array = shown(
        "MPa", "root stress of the pinion, tension side", name="pinion_root_stress", label="pinion root stress"
    )


@dataclass(frozen=True)
class OverTeeth:
    """Teeth of the rack over the stroke, shape (teeth,)."""

    number: NDArray[np.int64] = shown("", "tooth of the rack, from 1", name="tooth")
    tension: Array = shown(
        "MPa", "root stress, tension side: maximum over the stroke", name="root_tension", label="root stress"
    )
    compression: Array = shown("MPa", "root stress, compression side: minimum over the stroke", name="root_compression")


@dataclass(frozen=True)
class LinesOverFace:
    """Stations of the contact lines over one base pitch in the middle of the rack, shape (N,)."""

    travel: Array = shown(
        "mm", "travel of the rack from the first contact of its first tooth", label="travel of the rack"
    )
    tooth: NDArray[np.int64] = shown("", "tooth of the rack, from 1")
    z: Array = shown("mm", "face position from mid-face", name="face_position", label="face position")
    height: Array = shown("mm", "height of the contact above the reference line of the rack")
    load: Array = shown("N/mm", "line load (transverse force per face width)", name="line_load", label="line load")
    pressure: Array = shown("MPa", "maximum pressure of smooth flanks (line contact)", name="hertz_pressure")


@dataclass(frozen=True)
class StrokeNumbers:
    """What the stroke comes to; of all loads along the rack."""

    mean: float = shown("um", "mean transmission error in the middle of the rack (travel)", name="te_mean")
    peak_to_peak: float = shown(
        "um", "peak-to-peak transmission error in the middle of the rack (travel)", name="te_peak_to_peak"
    )
    largest: float = shown("um", "maximum transmission error over the stroke (travel)", name="te_max")
    stiffness: float = shown("N/um", "mean mesh stiffness along the rack, in its middle", name="mesh_stiffness")
    pinion: float = shown("MPa", "maximum root stress of the pinion, tension side", name="pinion_root_stress")
    middle: float = shown(
        "MPa", "maximum root stress in the middle of the rack, tension side", name="middle_root_stress"
    )
    rack: float = shown("MPa", "maximum root stress of all teeth of the rack, tension side", name="rack_root_stress")


@dataclass(frozen=True)
class RackStroke:
    """A loaded rack and pinion over the stroke.

    Parameters
    ----------
    positions : OverStroke
    teeth : OverTeeth
    numbers, errors : StrokeNumbers
        Errors are not numbers where they are not estimated.
    root_stress, contact_stress : float
        Nominal ones of ISO 6336 with z -> infinity [Pa]; not numbers for helical racks.
    over_face : LinesOverFace or None
        Contact lines in the middle of the rack; None of plane teeth.
    """

    positions: OverStroke
    teeth: OverTeeth
    numbers: StrokeNumbers
    errors: StrokeNumbers
    root_stress: float = shown(
        "MPa", "nominal root stress of the rack to ISO 6336-3 (z -> infinity, all K factors 1)", name="sigma_F0"
    )
    contact_stress: float = shown(
        "MPa", "nominal contact stress to ISO 6336-2 (u -> infinity, all K factors 1)", name="sigma_H0"
    )
    over_face: LinesOverFace | None = None


def _numbers(stroke: Stroke, force: float) -> StrokeNumbers:
    mean, teeth = stroke.mean_in_middle, stroke.rack_tension
    return StrokeNumbers(
        mean, stroke.peak_to_peak_in_middle, float(np.nanmax(stroke.error)), force / mean,
        float(np.nanmax(stroke.pinion_tension)), float(teeth[(teeth.size - 1) // 2]), float(teeth.max()),
    )  # fmt: skip


def _root_shares(fine: Stroke, coarse: Stroke) -> tuple[float, float, float]:
    """Relative errors of the root stress of the pinion, and twice of the rack, from those by coarser elements.

    A single number may be the same on both meshes by chance: the largest change on either side of any tooth counts.
    """
    pinion, rack = (
        max(
            float(np.nanmax(np.abs(one - other)) / np.nanmax(np.abs(one)))
            for one, other in ((getattr(of, f"{member}_{side}") for of in (fine, coarse)) for side in SIDES)
        )
        for member in ("pinion", "rack")
    )
    return _OF_ROOTS * pinion, _OF_ROOTS * rack, _OF_ROOTS * rack


def _plane(asked: RackInputs, upstream: Upstream, work: Work) -> tuple[Stroke, Stroke | None, None]:
    """The stroke, and that by the coarser elements."""
    from fegear.contact.rack.over_stroke import over_stroke
    from fegear.contact.rack.rack_contacts import RackContacts

    pair, force = asked.pair, asked.force
    fine, coarse = compliances(pair, rack_of(upstream, asked.name), solution_of(upstream, asked.pinion))
    found = RackContacts(pair)
    try:
        stroke = over_stroke(fine, found, force, asked.positions, asked.flanks)
    except InputError as error:  # of the load on one pair of teeth
        raise InputError(f"rack.{asked.name}.force", f"{force:.6g} N", error.rule, error.remedy) from None
    work.progress(0.6)
    other = None
    if coarse is not None:
        other = over_stroke(coarse, found, force, asked.positions, asked.flanks, stroke.added)
    return stroke, other, None


def _wide(asked: RackInputs, upstream: Upstream, work: Work) -> tuple[Stroke, Stroke | None, LinesOverFace]:
    """The same of teeth with their width, and their contact lines."""
    from fegear.contact.rack.rack_in_mesh import RackInMesh
    from fegear.contact.rack.wide_stroke import WideRackFlanks, wide_over_stroke

    pair, force, rack = RackInMesh(asked.pair), asked.force, solid_rack_of(upstream, asked.name)
    pinion = solid_solution_of(upstream, asked.pinion)
    fine = WideRackFlanks(pair, pinion.fine, rack.fine, asked.flanks, asked.positions)
    found = wide_over_stroke(fine, force, lambda part: work.progress(0.6 * part))
    other = None
    if pinion.coarse is not None:
        coarse = WideRackFlanks(pair, pinion.coarse, rack.coarse, asked.flanks, asked.positions)
        other = wide_over_stroke(
            coarse, force, lambda part: work.progress(0.6 + 0.4 * part), found.stroke.added
        ).stroke  # fmt: skip
    at, lines = found.middle, found.middle.lines
    on = lines.present
    row = np.broadcast_to(np.arange(lines.roll.size)[:, None], on.shape)[on]
    over = LinesOverFace(
        found.travel[row], (found.cycle - lines.pair + 1)[on], lines.z[on], lines.roll_length(at.pair, "driven")[on],
        at.line_load[on][:, 0], at.pressure[on][:, 0],
    )  # fmt: skip
    return found.stroke, other, over


def _compute(asked: RackInputs, upstream: Upstream, work: Work) -> RackStroke:
    from fegear.formulas.iso6336.rack_limit import nominal_contact_stress_on_rack, nominal_root_stress_of_rack

    pair, force = asked.pair, asked.force
    stroke, coarse, over_face = (_wide if asked.wide else _plane)(asked, upstream, work)
    numbers = _numbers(stroke, force)
    names = StrokeNumbers.__dataclass_fields__
    errors = StrokeNumbers(*(math.nan for _ in names))
    if coarse is not None:
        other = _numbers(coarse, force)
        off = {name: abs(getattr(numbers, name) - getattr(other, name)) for name in names}
        if asked.wide:
            for name, share in zip(("pinion", "middle", "rack"), _root_shares(stroke, coarse), strict=True):
                off[name] = max(off[name], share * getattr(numbers, name))
        left = stroke.beyond._asdict() | {"stiffness": numbers.stiffness * stroke.beyond.mean / numbers.mean}
        errors = StrokeNumbers(*(off[name] + left.get(name, 0.0) for name in names))
    there, tangential = ~np.isnan(stroke.error), asked.force
    tooth = np.minimum(np.broadcast_to(stroke.tooth[:, None], there.shape), pair.rack.teeth - 1)
    by_standard = (math.nan, math.nan)
    if not pair.rack.helix_angle:
        by_standard = (nominal_root_stress_of_rack(pair, tangential), nominal_contact_stress_on_rack(pair, tangential))
    count = np.arange(1, pair.rack.teeth + 1)
    return RackStroke(
        OverStroke(
            stroke.travel[there], tooth[there] + 1, stroke.error[there], stroke.pairs[there],
            stroke.largest_share[there], stroke.pinion_tension[there],
        ),
        OverTeeth(count, stroke.rack_tension, stroke.rack_compression),
        numbers, errors, *by_standard, over_face,
    )  # fmt: skip


def _answer(seen: Seen) -> Iterator[str]:
    data, error = seen.data.numbers, seen.data.errors

    def said(name: str, scale: float) -> str:
        off = getattr(error, name) * scale
        return rounded(getattr(data, name) * scale, None if math.isnan(off) else off)

    yield (
        f"Rack {seen.name}: {figures(seen.asked.force)} N moves it by {said('mean', 1e6)} µm (mesh stiffness "
        f"{said('stiffness', 1e-6)} N/µm), {said('peak_to_peak', 1e6)} µm peak to peak over a pitch."
    )
    worst = int(np.argmax(seen.data.teeth.tension)) + 1
    yield (
        f"Maximum root stress: pinion {said('pinion', 1e-6)} MPa, rack {said('middle', 1e-6)} MPa in the middle, "
        f"{said('rack', 1e-6)} MPa at tooth {worst}."
    )
    yield f"Maximum transmission error over the stroke: {said('largest', 1e6)} µm."


def _remarks(seen: Seen) -> Iterator[str]:
    name = seen.name
    if seen.asked.pair.rack.helix_angle:
        yield f"Rack {name}: nominal stresses to ISO 6336 are given for spur racks only."
    else:
        yield _by_iso(name)
    if seen.asked.wide:
        yield f"Rack {name}: sides and ends of the 3D rack follow the helix; its stroke counts at mid-face."
    yield neglecting(
        f"Rack {name}: friction, deviations and misalignment are not included; the pinion is fixed at its bore."
    )
    if seen.asked.left_out:
        yield neglecting(
            f"Rack {name}: effects.relief is off: {' and '.join(seen.asked.left_out)} neglected. Set relief = true "
            "under [effects]."
        )
    if seen.asked.pair.pinion.tooth.undercut:
        yield f"Rack {name}: the pinion is undercut; contact starts at its root form circle."


def _by_iso(name: str) -> str:
    return (
        f"Rack {name}: ISO 6336 with z -> infinity gives nominal stresses only; K factors, safety factors and life "
        "are not available."
    )


_VALUES = tuple(StrokeNumbers.__dataclass_fields__)


def _error(name: str) -> Callable[[Seen], float | None]:
    return lambda seen: None if math.isnan(found := getattr(seen.data.errors, name)) else found


_SHEET = Sheet(
    answer=Answer(_answer, figure=lambda seen: f"rack_transmission_error_{seen.name}"),
    tables=(
        Rows(
            "rack_transmission_error_{name}", "Transmission error of rack {name} over the stroke",
            ("travel", "tooth", "error", "pairs", "share", "tension"), of="positions",
        ),
        Rows("rack_root_stress_{name}", "Root stress of the teeth of rack {name}", ("number", "tension", "compression"),
             of="teeth"),
        Rows(
            "rack_line_load_{name}", "Contact lines of rack {name} in its middle, over one base pitch",
            ("travel", "tooth", "z", "height", "load", "pressure"), of="over_face",
        ),
    ),
    values=(
        *(Number(f"numbers.{one}", _error(one)) for one in _VALUES),
        Number("root_stress", exact), Number("contact_stress", exact),
    ),
    figures=(
        Chart(
            "rack_transmission_error_{name}", "Transmission error of rack {name} over the stroke",
            "Rack {name}: travel of the rack due to the load, and root stress of the pinion, over the travel; fewer "
            "teeth are in contact at both ends.",
            (Over("travel", (Line("error", look={"markers": False}),)),
             Over("travel", (Line("tension", look={"markers": False}),))),
            of="positions",
        ),
        Chart(
            "rack_root_stress_{name}", "Root stress of the teeth of rack {name}",
            "Rack {name}: maximum root stress of each tooth over the stroke, tension side.",
            (Over(Axis("tooth of the rack", whole=True), (Line("tension", x="number", kind="bars"),)),),
            of="teeth",
        ),
    ),
    remarks=(_remarks,),
    settings={"positions": "positions.travel.size"},
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    loaded_rack_inputs(scene, name)


def _forecast(scene: Scene, name: str) -> Forecast:
    asked = rack_inputs(scene, name)
    teeth = asked.pair.rack.teeth
    if asked.wide:
        return forecasts.constant(_SECONDS_WIDE * min(teeth + 1, _APART) * asked.positions)
    return forecasts.constant(0.1 + 0.001 * min(teeth, 35) * asked.positions)


RACK_TRANSMISSION_ERROR = Stage(
    subjects=racks,
    needs=lambda scene, name: (needs_solid_rack if is_wide_rack(scene, name) else needs_rack)(scene, name),
    inputs=loaded_rack_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(
        *RING, PATCH, HERTZ,
        Citation("iso-6336-3", "Y_F and Y_S in their limits", "method B"),
    ),
    forecast=_forecast,
)  # fmt: skip
