"""Stage ``geometry``: the numbers of every gear and pair that a drawing would carry."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.notes import assuming, failing
from fegear.base.printed import figures
from fegear.base.shown import shows
from fegear.case.gear import GearPart
from fegear.case.reading import Scene
from fegear.case.working_flanks import coast_name
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Table
from fegear.engine.value import Value
from fegear.geometry.checks import undercut_of
from fegear.geometry.gear import Gear
from fegear.geometry.gear_data import MODIFICATIONS, GearData, MeshData, measured
from fegear.geometry.inspection import usual_span
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_side import Flank
from fegear.geometry.mass import MassProperties
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.shaped_side import ShapedSide
from fegear.geometry.tip_interference import interference
from fegear.results.forecasts import INVOLUTE
from fegear.results.gear.drawing_data import Drawing

if TYPE_CHECKING:
    from fegear.engine.figure.figure import DeferredFigure, Figure


def _everything(scene: Scene) -> tuple[str, ...]:
    return ("",) if scene.gears else ()


def gears_of(drawing: Drawing, names: Sequence[str]) -> tuple[GearData, ...]:
    """Numbers of some gears that stand beside each other in a table."""
    helical = any(drawing.gears[name].helix_angle != 0.0 for name in names)
    ground = {key for name in names for key in drawing.ground.get(name, {})}
    amounts = {name: {key: drawing.ground.get(name, {}).get(key, 0.0) for key in ground} for name in names}
    return tuple(
        GearData(
            drawing.gears[name], helical, drawing.balls.get(name), drawing.spans.get(name), amounts[name], name
        )
        for name in names
    )  # fmt: skip


@dataclass(frozen=True)
class PairData:
    """Numbers of both gears of a pair, driver first, alone and in mesh."""

    pair: GearPair
    gears: tuple[GearData, ...]

    @property
    def mesh(self) -> tuple[MeshData, ...]:
        """Driver first."""
        return tuple(MeshData(self.pair, member) for member in MEMBERS)

    @property
    def helical(self) -> GearPair | None:
        """The pair, if it is one of helical gears."""
        return self.pair if self.pair.driver.helix_angle != 0.0 else None

    @property
    @shows("", "contact ratio of the non-working flanks")
    def back_contact_ratio(self) -> float | None:
        """Of asymmetric teeth, under reversed torque."""
        return self.pair.from_the_back.contact_ratio if self.pair.asymmetric else None

    @property
    @shows("deg", "working pressure angle of the non-working flanks")
    def back_working_pressure_angle(self) -> float | None:
        """[rad]."""
        return self.pair.from_the_back.working_pressure_angle if self.pair.asymmetric else None

    @property
    @shows("", "tooth loss factor H_V (rigid gears)")
    def rigid_loss_factor(self) -> float | None:
        """Of teeth without deflection; None where at times none of them is in contact, and of internal pairs."""
        from fegear.formulas.friction import wimmer

        return None if self.pair.contact_ratio < 1.0 or self.pair.internal else wimmer(self.pair)


def pair_data(drawing: Drawing, name: str) -> PairData:
    """Numbers of a pair."""
    return PairData(drawing.pairs[name], gears_of(drawing, drawing.members[name]))


def _pairs(seen: Seen) -> dict[str, PairData]:
    return {name: pair_data(seen.data, name) for name in seen.data.pairs}


def _lone(seen: Seen) -> tuple[GearData, ...] | None:
    """Gears that are in no pair."""
    paired = {name for names in seen.data.members.values() for name in names}
    return gears_of(seen.data, [name for name in seen.data.gears if name not in paired]) or None


def _beside(where: str | None) -> Callable[[Seen], tuple[GearData, ...]]:
    """The gears of a table, by where it finds them."""
    return lambda seen: seen.one.gears if where else _lone(seen) or ()


def _all(seen: Seen) -> tuple[GearData, ...]:
    return gears_of(seen.data, list(seen.data.gears))


def _gear_columns(gears: Callable[[Seen], tuple[GearData, ...]]) -> tuple[tuple[Cell | str, ...], tuple[Cell, ...]]:
    """Columns of teeth and of measurement, under the words that gears beside each other have."""

    def normal(word: str) -> Callable[[Seen], str]:
        return lambda seen: f"normal {word}" if gears(seen)[0].helical else word

    def where(seen: Seen) -> str:
        kinds = {one.gear.tooth.internal for one in gears(seen)}
        over = "over (internal gears: between)" if len(kinds) == 2 else "between" if kinds == {True} else "over"
        return f"{over} balls or pins M_dK"

    def symbol(word: str, ending: str) -> Callable[[Seen], str]:
        return lambda seen: f"normal {word}_n{ending}" if gears(seen)[0].helical else f"{word}{ending}"

    teeth = (
        Cell("name", meaning="gear"), "teeth", Cell("module", meaning=symbol("module m", "")),
        Cell("pressure_angle", meaning=symbol("pressure angle α", "")), "helix_angle", "hand", "lead",
        "transverse_module", "transverse_pressure_angle", "base_helix_angle", "back_pressure_angle", "profile_shift",
        "face_width", "reference_diameter", "base_diameter", "back_base_diameter", "tip_diameter", "root_diameter",
        "root_form_diameter", "back_root_form_diameter", "tip_form_diameter",
    )  # fmt: skip
    measures = (
        Cell("tooth_thickness", of=gears, meaning=symbol("tooth thickness s", " at d")),
        Cell("tip_thickness", of=gears, meaning=normal("tooth thickness at d_Fa")),
        *(Cell(key, of=gears) for key in ("span_teeth", "span", "ball_diameter")),
        Cell("over_balls", of=gears, meaning=where),
        *(Cell(key, of=gears) for key in ("over_pins", "chordal_thickness", "chordal_height")),
    )
    return teeth, measures


def drawing_of(scene: Scene) -> Drawing:
    """What a case says of its gears and pairs."""
    parts = scene.case.pair
    members = {name: (parts[name].driver, parts[name].driven) for name in scene.pairs}
    balls = {name: d for name in scene.gears if (d := scene.case.gear[name].ball_diameter) is not None}
    ground = {
        name: amounts
        for name, gear in scene.gears.items()
        if (amounts := ground_off(scene.case.gear[name], gear.tooth.working_flank))
    }
    spans = {name: k for name in scene.gears if (k := scene.case.gear[name].span_teeth) is not None}
    assumed = (*assumed_cutters(scene), *assumed_bodies(scene))
    return Drawing(scene.gears, scene.pairs, members, balls, spans, ground, assumed)


def assumed_cutters(scene: Scene) -> tuple[str, ...]:
    """Sentences on ring gears whose cutter the case leaves open."""
    return tuple(
        assuming(
            f"Gear {name}: cutter.teeth not specified, {gear.tooth.cutter.teeth} assumed (largest cutter that does not "
            "trim the ring tips); affects the fillet only."
        )
        for name, gear in scene.gears.items()
        if isinstance(gear.tooth, InternalTooth)
        and (part := scene.case.gear[name].cutter) is not None
        and part.teeth is None
    )


def assumed_bodies(scene: Scene) -> tuple[str, ...]:
    """Sentences on gears whose mass is that of an assumed bore or face width."""
    found = []
    for name, part in scene.case.gear.items():
        if name in scene.written:  # the same gear seen from its other flank
            continue
        gear, lacking = scene.gears[name], []
        if not part.gives_rim:
            key = "outer_radius" if part.internal else "bore_radius"
            lacking.append(f"{key} = {gear.bore_radius * 1e3:.6g} mm")
        if part.face_width is None:
            lacking.append(f"face_width = {gear.face_width * 1e3:.6g} mm")
        if lacking:
            found.append(assuming(f"Gear {name}: mass and inertia computed with the default {' and '.join(lacking)}."))
    return tuple(found)


def unmeasured_remarks(drawing: Drawing) -> tuple[str, ...]:
    """Which gears have no span or no dimension over balls, and why."""
    twins = {coast_name(name) for name in drawing.gears}  # the same gears seen from their coast flanks
    spanless = tuple(
        f"Gear {name}: span measurement not possible, face width too small for the helix angle."
        for name, gear in drawing.gears.items()
        if usual_span(gear) is None and not gear.tooth.internal and not gear.asymmetric
    ) + tuple(
        f"Gear {name}: asymmetric teeth have no span and no chordal thickness (two base circles); dimension over balls."
        for name, gear in drawing.gears.items()
        if gear.asymmetric and name not in twins
    )
    return spanless + tuple(
        f"Gear {name} has no dimension over or between balls: no ball that contacts both flanks protrudes from the "
        "tooth space."
        if gear.tooth.internal
        else f"Gear {name}: no dimension over balls; balls touching both flanks do not protrude beyond the tip circle."
        for name, gear in drawing.gears.items()
        if name not in twins and measured(gear, drawing.balls.get(name)) is None
    )


def ground_off(part: GearPart, flank: Flank | None) -> dict[str, float]:
    """Amounts that a case gives for a gear [m], by `MODIFICATIONS`; tables, files and amounts in Delta have none.

    Those of asymmetric teeth are for the working flank.
    """
    profile = part.relief_of(flank)
    found: dict[str, float] = {}

    def add(key: str, amount: float | None) -> None:
        if amount:
            found[key] = found.get(key, 0.0) + amount

    if profile is not None:
        for key, ends in (("tip_relief", profile.tip), ("root_relief", profile.root)):
            for end in ends:
                add(key, end.amount)
        for crown in profile.crowning:
            add("profile_crowning", crown.amount)
    lead, _ = part.lead_of(flank)
    if lead is not None:
        add("crowning", lead.crowning)
        add("helix_slope", lead.slope)
        for relief in lead.end_relief:
            for side in ("I", "II"):
                if relief.end in (side, "both"):
                    add(f"end_relief_{side}", relief.amount)
    if part.bias is not None:
        add("bias", part.bias.amount)
    return found


_IN_PAIR, _MEASURED = _gear_columns(_beside("pair"))
_ALONE, _MEASURED_ALONE = _gear_columns(_beside(None))
_THICKNESS, _TIP, *_SPAN_AND_BALLS = _gear_columns(_all)[1]
_IN_MESH = (
    "active_root_diameter", "lpstc_diameter", "hpstc_diameter", "active_tip_diameter", "tip_clearance",
    "specific_sliding_start", "specific_sliding_end",
)  # fmt: skip
#: Gear data of a pair: driver first, driven gear second.
PAIR_TABLE = Rows(
    "gear_data_{key}", "Gear data of pair {key}",
    (*_IN_PAIR, *(Cell(key, of="mesh") for key in _IN_MESH), *_MEASURED, *MODIFICATIONS), of="gears", each=_pairs,
)  # fmt: skip
#: Gear data of the gears that are in no pair.
LONE_TABLE = Rows("gear_data", "Gear data", (*_ALONE, *_MEASURED_ALONE, *MODIFICATIONS), of=_lone)


def _exact(_seen: Seen) -> float:
    return 0.0


#: The numbers of a pair as a whole.
PAIR_VALUES = (
    *(
        Number(key, _exact, "pair", each=_pairs, owner="{key}")
        for key in ("contact_ratio", "centre_distance", "working_pressure_angle", "path_length", "base_pitch")
    ),
    Number(
        "normal_backlash", _exact, "pair", each=_pairs, owner="{key}",
        meaning=lambda seen: "" if seen.one.helical else "backlash along the line of action",
    ),
    *(
        Number(key, _exact, "helical", each=_pairs, owner="{key}")
        for key in ("overlap_ratio", "total_contact_ratio", "working_helix_angle", "circumferential_backlash")
    ),
    *(
        Number(key, _exact, each=_pairs, owner="{key}")
        for key in ("back_contact_ratio", "back_working_pressure_angle", "rigid_loss_factor")
    ),
)  # fmt: skip


def pair_table(name: str, drawing: Drawing) -> Table:
    """Gear data of a pair: driver first, driven gear second."""
    (table,) = replace(PAIR_TABLE, each=lambda _: {name: pair_data(drawing, name)}).tables(Seen(drawing))
    return table


def lone_table(drawing: Drawing) -> Table | None:
    """Gear data of the gears that are in no pair, if any."""
    return next(LONE_TABLE.tables(Seen(drawing)), None)


def pair_values(name: str, drawing: Drawing) -> tuple[Value, ...]:
    """The numbers of a pair as a whole."""
    only = Seen(drawing, name=name, one=pair_data(drawing, name), key=name)
    return tuple(value for number in PAIR_VALUES for value in replace(number, each=None).values(only))


def _values(seen: Seen) -> Iterator[Value]:
    """Pair by pair."""
    for name in seen.data.pairs:
        yield from pair_values(name, seen.data)


def _tips_in_roots(named: str, pair: GearPair) -> Iterator[str]:
    for member in MEMBERS:
        if sentence := interference(pair, member).sentence:
            yield failing(f"{named}: {sentence}.")


def _on_pairs(seen: Seen) -> Iterator[str]:
    """Say what is wrong with pairs: contact that is interrupted, tips that interfere."""
    pairs = seen.data.pairs
    for name, pair in pairs.items():
        if pair.total_contact_ratio < 1.0:
            yield (
                failing(
                    f"Pair {name}: contact ratio {pair.total_contact_ratio:.4f} is below 1, motion is not transmitted "
                    "continuously. Increase tooth depth or number of teeth, or reduce the centre distance."
                )
            )
    for name, pair in pairs.items():
        yield from _tips_in_roots(f"Pair {name}", pair)
        if pair.asymmetric:
            yield from _tips_in_roots(f"Pair {name}, non-working flanks", pair.from_the_back)
    for name, pair in pairs.items():
        for one in pair.internal_checks:
            if one.margin < 0.0 and (one.fouls(pair.driver.module) or not one.refused):
                yield failing(f"Pair {name}: {one.of_pinion.sentence(pair.driver.module)}.")
    for name, pair in pairs.items():
        if pair.clearing:
            yield failing(f"Pair {name}: tip interference; {pair.clearing} to avoid it.")


def _fillets(seen: Seen) -> Iterator[str]:
    """Numbers of fillets that no tool generates, beside those of the tool."""
    twins = {coast_name(name) for name in seen.data.gears}
    for name, gear in seen.data.gears.items():
        sides = (gear.tooth, gear.tooth.back) if gear.asymmetric else (gear.tooth,)
        for tooth in sides if name not in twins else ():
            if not isinstance(tooth, ShapedSide) or tooth.fillet_key is None:
                continue
            m, made = 1e3 * gear.module, tooth.as_generated
            corner = ", the involute starts in a corner" if tooth.undercut else ""
            which = f"{tooth.working_flank} fillet" if gear.asymmetric else "fillet"
            yield (
                f"Gear {name}: {which} as specified, root form diameter {2.0 * m * tooth.form_radius:.6g} mm (tool: "
                f"{2.0 * m * made.form_radius:.6g}), root diameter {2.0 * m * tooth.root_radius:.6g} mm (tool: "
                f"{2.0 * m * made.root_radius:.6g}), minimum radius of curvature "
                f"{figures(m * tooth.smallest_radius, 3)} mm{corner}."
            )


def _figures(seen: Seen) -> Iterator[Figure | DeferredFigure]:
    from fegear.results.gear.body_section import body_figures
    from fegear.results.gear.drawing import pair_figure

    yield from (pair_figure(name, seen.data) for name in seen.data.pairs)
    yield from body_figures(seen.data.gears)


def _bodies(seen: Seen) -> tuple[MassProperties, ...]:
    return tuple(gear.mass_properties for gear in seen.data.gears.values())


def _in_mesh(seen: Seen) -> Iterator[str]:
    """What a drawing of each pair begins with."""
    for name, pair in seen.data.pairs.items():
        z = f"{abs(pair.driver.tooth.teeth)} and {abs(pair.driven.tooth.teeth)} teeth"
        z += "".join(_undercut(member, pair.gear(member)) for member in MEMBERS)
        ratio = f"contact ratio {figures(pair.contact_ratio)}"
        if pair.driver.helix_angle != 0.0:
            ratio += f", overlap ratio {figures(pair.overlap_ratio)}"
        if pair.total_contact_ratio < 1.0:
            ratio += " (below 1: motion is not transmitted continuously)"
        backlash = pair.normal_backlash if abs(pair.normal_backlash) >= _LEAST_BACKLASH else 0.0
        yield (
            f"Pair {name}: {z}, {ratio}, centre distance {figures(pair.centre_distance * 1e3, 6)} mm, normal backlash "
            f"{figures(backlash * 1e3, 2)} mm."
        )


def _undercut(name: str, gear: Gear) -> str:
    """A clause of a sentence where the tool cuts into the involute of a gear; else empty."""
    found = undercut_of(gear)
    if found is None or not found.lost > 0.0:
        return ""
    return (
        f", {name} undercut ({figures(found.lost * 1e3, 2)} mm of the involute; none from profile_shift = "
        f"{found.enough:.4f} on)"
    )


def _lone_gears(seen: Seen) -> Iterator[str]:
    """Of each gear in no pair."""
    for one in _lone(seen) or ():
        gear = one.gear
        yield (
            f"Gear {one.name}: {abs(gear.tooth.teeth)} teeth of module {figures(gear.module * 1e3, 5)} mm, tip "
            f"diameter {figures(2e3 * gear.tip_radius, 6)} mm{_undercut(one.name, gear)}."
        )


#: Backlash below this is none: profile shifts are given to some digits [m].
_LEAST_BACKLASH = 1e-7
_SHEET = Sheet(
    name=lambda _asked: "",
    tables=(
        Rows(
            "geometry", "Gears",
            (
                Cell("name", of=_all),
                "teeth", "module", Cell("profile_shift", of=_all),
                "tip_radius", "involute_tip_radius", "pitch_radius", "base_radius", "form_radius",
                "root_radius", "bore_radius", "face_width", *_SPAN_AND_BALLS, _THICKNESS, _TIP,
            ),
            of=lambda seen: tuple(seen.data.gears.values()), printed=True,
        ),
        Rows(
            "mass_and_inertia", "Mass and inertia of gears",
            (Cell("name", of=_all), "mass", "inertia", "transverse_inertia", "centre_of_gravity"),
            of=_bodies, printed=True,
        ),
        PAIR_TABLE,
        LONE_TABLE,
    ),
    values=(_values,),
    figures=(_figures,),
    answer=Answer(_in_mesh, _lone_gears, background=True),
    remarks=(_on_pairs, _fillets, lambda seen: seen.data.assumed, lambda seen: unmeasured_remarks(seen.data)),
)  # fmt: skip


GEOMETRY = Stage(
    subjects=_everything,
    inputs=lambda scene, _subject: drawing_of(scene),
    compute=lambda drawing, _upstream, _work: drawing,
    present=_SHEET.present,
    cites=citing(INVOLUTE, Citation("iso-53", "standard basic racks", "Table 1")),
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
)
