"""Stage ``tooth-geometry-check``: the drawing compared with rules of thumb, each with its value, limit and remedy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.case.reading import Scene
from fegear.engine.citation import citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.checks import Check, gear_checks, pair_checks
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.results.forecasts import INVOLUTE


@dataclass(frozen=True)
class Drawing:
    """Gears and pairs by name."""

    gears: Mapping[str, Gear]
    pairs: Mapping[str, GearPair]
    assumed_rims: tuple[str, ...] = ()


def _inputs(scene: Scene, _subject: str) -> Drawing:
    assumed = tuple(name for name, part in scene.case.gear.items() if not part.gives_rim)
    return Drawing(scene.gears, scene.pairs, assumed)


def _compute(drawing: Drawing, _upstream: Upstream, _work: Work) -> tuple[Check, ...]:
    found = [
        check
        for name, gear in drawing.gears.items()
        for check in gear_checks(name, gear, assumed_rim=name in drawing.assumed_rims)
    ]
    found += [check for name, pair in drawing.pairs.items() for check in pair_checks(name, pair)]
    return tuple(found)


def _present(checks: tuple[Check, ...], drawing: Drawing) -> Outcome:
    verdicts = np.array(["holds" if check.holds else "broken" for check in checks])
    broken = [check for check in checks if not check.holds]
    # Lengths and ratios share a column, so each is given over its limit as well; a limit of zero has no such ratio.
    share = np.array([check.value / check.limit if check.limit > 0.0 else np.nan for check in checks])
    scale = np.array([1e3 if check.unit == "mm" else 1.0 for check in checks])
    table = Table(
        "tooth_geometry_check",
        (
            Column("of", np.array([check.of for check in checks]), "", "gear or pair"),
            Column("rule", np.array([check.rule for check in checks]), "", "what is compared with its limit"),
            Column("value", scale * np.array([check.value for check in checks]), "", "in the unit of the next column"),
            Column("limit", scale * np.array([check.limit for check in checks]), "", "the least that is usual"),
            Column("unit", np.array([check.unit for check in checks]), "", "of value and limit; empty for ratios"),
            Column("verdict", verdicts, "", "holds or broken"),
            Column("value_over_limit", share, "", "none where the limit is zero"),
        ),
        "The drawing against rules of thumb",
    )
    values = (
        Value("rules_checked", float(len(checks)), "", 0.0, "rules that apply to this case"),
        Value("rules_broken", float(len(broken)), "", 0.0, "of them"),
    )
    remarks = tuple(
        f"{check.of}: {check.rule} is {check.finding or _below(check)}; {check.remedy}." for check in broken
    )
    remarks += tuple(
        f"Gear {name}: its rim is not checked; specify {'outer_radius' if gear.tooth.internal else 'bore_radius'}."
        for name, gear in drawing.gears.items()
        if name in drawing.assumed_rims
    )
    return Outcome(checks, (table,), values, {}, remarks, _figures(checks, share))


def _below(check: Check) -> str:
    return f"{_amount(check, check.value)}, below {_amount(check, check.limit)}"


def _amount(check: Check, value: float) -> str:
    return f"{value * 1e3:.4g} mm" if check.unit == "mm" else f"{value:.4g}"


def _figures(checks: tuple[Check, ...], share: np.ndarray) -> tuple[Figure, ...]:
    shown = [i for i in range(len(checks)) if np.isfinite(share[i])]
    if not shown:
        return ()
    names = tuple(f"{checks[i].of}: {checks[i].rule}" for i in shown)
    place = np.arange(len(shown))
    points = tuple(
        Points(share[shown][chosen], place[chosen], label, role, size=8)
        for label, role, chosen in (
            ("holds", "green", share[shown] >= 1.0),
            ("broken", "red", share[shown] < 1.0),
        )
        if chosen.any()
    )
    panel = Panel(
        Axis("value over its limit", zero=True), Axis("", categories=names), points, (Mark("x", 1.0, "limit"),)
    )
    about = "Each rule's value over its limit; left of the line a rule is broken."
    return (Figure("tooth_geometry_check", "The drawing against rules of thumb", about, (panel,)),)


TOOTH_GEOMETRY_CHECK = Stage(
    subjects=lambda scene: ("",) if scene.gears else (),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(INVOLUTE),
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
    internal=True,
)
