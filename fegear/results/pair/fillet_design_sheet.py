"""What a designed fillet shows: its points, the tooth with each fillet, stress along them, gain, what it depends on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from fegear.base.notes import Note, exceeding, failing
from fegear.base.printed import figures, percent, rounded
from fegear.engine.declared import axis_of
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.load_words import load_words
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.results.pair.fillet_design_data import FilletShown, StressedFillet

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen

#: Searches that differ by more do not verify each other.
_SPREAD = 5e-3
_OWNER = "{name}.{asked.gear}"


def _in_percent(share: float, error: float | None = None) -> str:
    """A share with its error, both to the error's first digit."""
    if not error:
        return percent(share)
    decimals = max(0, -math.floor(math.log10(100.0 * error)))
    return f"{100.0 * share:.{decimals}f} ± {100.0 * error:.{decimals}f} %"


def _kind(seen: Seen) -> str:
    kind = "alternating root stress" if seen.asked.objective == "alternating" else "root stress"
    return f"{kind} with pair {seen.asked.other}" if seen.asked.other else kind


def _answer(seen: Seen) -> Iterator[str]:
    """Gain over the present fillet and over that of a rack; whether it is verified."""
    shown: FilletShown = seen.data
    design, subject = shown.design, f"Pair {seen.name}"
    if not design.kept:
        yield f"{subject}: no fillet of gear {seen.asked.gear} within the limits of clearance and radius was found."
        return
    before, after = (rounded(one.stress * 1e-6, one.error * 1e-6) for one in (design.present, design.best))
    gain, rack = shown.gain_over_full_rounded, ""
    if gain is not None:
        where = "below" if gain >= 0.0 else "above"
        rack = f"; {_in_percent(abs(gain), shown.gain_over_full_rounded_error)} {where} the full fillet of a rack"
    sides = shown.designed
    which = "fillets of both sides" if shown.both else f"{sides[0].side} fillet".strip()
    yield (
        f"{subject}: {which} of gear {seen.asked.gear} by {sides[0].x.size} points: {_kind(seen)} "
        f"{before} -> {after} MPa ({_in_percent(-shown.gain, shown.gain_error)}){rack}."
    )
    if shown.spread_of_searches is not None:
        off = f"{figures(1e6 * design.off_by * shown.module, 2)} µm ({design.off_by:g} modules)"
        agree = "agree within" if shown.spread_of_searches <= _SPREAD else "differ by"
        yield (
            f"{subject}: {len(design.found)} searches {agree} {percent(shown.spread_of_searches)}; a fillet {off} off "
            f"at half its length has {_loss(shown)}."
        )
    radii = [one.minimum_tool_radius for one in shown.designed if one.minimum_tool_radius is not None]
    if len(radii) == len(shown.designed):
        tables = " and ".join(f"fillet_tool_{seen.name}_{seen.asked.gear}{one.suffix}" for one in shown.designed)
        table = "tables" if shown.both else "table"
        yield (
            f"{subject}: a rack (hob) generates it; its tip, {table} {tables}, has a radius of at least "
            f"{figures(1e3 * min(radii), 3)} mm."
        )


def _difference(_seen: Seen) -> bool:
    """A gain has the error of both stresses: relative to them, not to itself."""
    return True


def _loss(shown: FilletShown) -> str:
    """What a fillet that is off loses, at most."""
    known = [one for one in shown.design.off if math.isfinite(one)]
    return f"up to {percent(max(0.0, *known))} more stress" if known else "an unknown stress (no such fillet)"


def _remarks(seen: Seen) -> Iterator[Note | str]:
    shown: FilletShown = seen.data
    design, subject = shown.design, f"Pair {seen.name}, gear {seen.asked.gear}"
    if not design.kept:
        made = ", or set fillet_design.generated = false" if seen.asked.limits.generated else ""
        yield failing(
            f"{subject}: no fillet within the limits was found; reduce fillet_design.minimum_radius or "
            f"fillet_design.clearance{made}."
        )
    elif shown.gain <= shown.gain_error:
        yield exceeding(
            f"{subject}: the gain of {percent(shown.gain)} does not exceed its estimated error of "
            f"{percent(shown.gain_error)}; reduce accuracy.tolerance or keep the present fillet."
        )
    over_full = shown.gain_over_full_rounded
    if design.kept and over_full is not None and over_full < 0.0:
        yield exceeding(
            f"{subject}: the full fillet of a rack is less stressed by {percent(-over_full)}, so that the search was "
            "too coarse; increase fillet_design.waves and fillet_design.searches."
        )
    if shown.spread_of_searches is None:
        yield f"{subject}: the minimum by a single search is not verified; set fillet_design.searches = 3."
    elif shown.spread_of_searches > _SPREAD:
        yield exceeding(
            f"{subject}: the searches differ by {percent(shown.spread_of_searches)}, so that the minimum is not "
            "verified; increase fillet_design.waves."
        )
    if design.best.tooth.internal:
        yield (
            f"{subject}: the designed fillet is for powder metal, moulded, broached and wire-cut gears; a pinion-type "
            "cutter for it is not searched."
        )
    elif not shown.tool:
        yield (
            f"{subject}: no rack generates the designed fillet exactly (its tip would turn back near the flank); set "
            "fillet_design.generated = true for the best fillet of a hob."
        )
    if design.full is None and not design.best.tooth.internal:
        yield f"{subject}: comparison with a rack of full tip radius omitted (no such rack for this gear)."
    keys = " and ".join(
        f'gear.{seen.asked.gear}.{one.key} = {{ kind = "points", file = "designed_fillet_{seen.name}_'
        f'{seen.asked.gear}{one.suffix}.csv" }}'
        for one in shown.designed
    )
    yield (
        f"{subject}: to compute with the designed fillet, run fegear apply RESULTS --fillet --case CASE, or set {keys}."
    )


def _across(seen: Seen) -> Axis:
    return axis_of(StressedFillet, "x", limits=seen.data.window[0])


def _up(seen: Seen) -> Axis:
    return axis_of(StressedFillet, "y", limits=seen.data.window[1])


def _caption(seen: Seen) -> str:
    half = "half a tooth from the middle of the tooth space (right) up the flank"
    if seen.data.both:
        half = f"tooth from the tooth space up its {seen.data.designed[0].side.strip()} flank (right) and the other one"
    return (
        f"Pair {seen.name}, gear {seen.asked.gear}: {half} with each fillet; {_kind(seen)} along each fillet from "
        "there, maximum over the mesh; half the tip of each rack that generates one, in the colour of its fillet."
    )


def _plain(seen: Seen) -> dict[str, object]:
    """Solid lines, of the other side of asymmetric teeth dashed."""
    return {"dash": seen.one.dash, "markers": False}


_FILLETS = Family("fillets", "{one.label}", "{one.role}")
_TOOLS = Family("tools", "", "{one.role}")

FILLET_DESIGN_SHEET = Sheet(
    of=FilletShown,
    tables=(
        Rows(
            "designed_fillet_{name}_{asked.gear}{one.suffix}",
            "Designed{one.side} fillet of gear {asked.gear} in pair {name}", ("x", "y"), each="designed",
        ),
        Rows(
            "fillet_tool_{name}_{asked.gear}{one.suffix}",
            "Tool tip for the designed{one.side} fillet of gear {asked.gear} in pair {name}",
            ("half_width", "height"), each="tool",
        ),
        Rows(
            "fillet_stress_{name}_{asked.gear}", "Root stress along fillets of gear {asked.gear} in pair {name}",
            ("fillet", "arc", "diameter", "stress"), stacked="fillets",
        ),
    ),
    values=(
        Number(
            "largest", "error", owner=_OWNER, name="root_stress_{one.word}", each="largest",
            meaning=lambda seen: f"maximum {_kind(seen)} over the mesh, {seen.one.fillet}",
        ),
        Number(
            "largest", "error", owner=_OWNER, name="root_stress_{one.word}", each="of_sides",
            meaning=lambda seen: f"maximum {_kind(seen)} over the mesh, {seen.one.fillet}",
        ),
        Number("gain", "gain_error", owner=_OWNER, zero=_difference),
        Number("gain_over_full_rounded", "gain_over_full_rounded_error", owner=_OWNER, zero=_difference),
        Number("spread_of_searches", owner=_OWNER),
        Number("increase_if_deeper", owner=_OWNER),
        Number("increase_if_higher", owner=_OWNER),
        Number("minimum_radius", exact, owner=_OWNER, each="designed", ending="{one.suffix}"),
        Number("minimum_tool_radius", exact, owner=_OWNER, each="designed", ending="{one.suffix}"),
        Number("form_diameter", exact, owner=_OWNER, each="designed", ending="{one.suffix}"),
    ),
    figures=(
        Chart(
            "fillet_design_{name}", "Fillets of gear {asked.gear} in pair {name}", _caption,
            (
                Over(
                    _across, (Line("y", x="x", each=_FILLETS, look=_plain),), _up, title="Fillets",
                    panel={"height": 1.3, "equal": True},
                ),
                Over(
                    "arc", (Line("stress", each=_FILLETS, look=_plain),), "stress", options={"zero": True},
                    title="Stress", panel={"height": 1.3},
                ),
                Over(
                    "half_width",
                    (Line("height", x="half_width", x_si="drawn", each=_TOOLS, look=_plain),),
                    "height", title="Tool", panel={"height": 1.3, "equal": True}, of="tools", when="tools",
                ),
            ),
            of="fillets", columns=3, under=lambda seen: load_words(seen.data.data.load),
        ),
    ),
    answer=Answer(_answer, figure="fillet_design_{name}"),
    remarks=(_remarks,),
    settings={
        "objective": lambda seen: seen.asked.objective,
        "searches": lambda seen: len(seen.data.design.found),
        "fillets_solved": "design.tried",
        "best_search": "design.first",
        "load": "data.load",
    },
)  # fmt: skip
