"""Stage ``tooth-geometry-check``: the drawing compared with rules of thumb, each with its value, limit and remedy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.notes import failing
from fegear.base.shown import shown, shows
from fegear.case.reading import Scene
from fegear.engine.citation import citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
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


@dataclass(frozen=True)
class CheckRow:
    """A rule as the table has it: lengths in mm beside ratios, so each is given over its limit as well."""

    check: Check

    @property
    @shows("", "gear or pair", table="checks")
    def of(self) -> str:
        """Its name."""
        return self.check.of

    @property
    @shows("", "quantity compared with its limit", table="checks")
    def rule(self) -> str:
        """In words."""
        return self.check.rule

    @property
    @shows("", "value, in the unit of the next column", table="checks")
    def value(self) -> float:
        """[mm] or a ratio."""
        return self._scale * self.check.value

    @property
    @shows("", "usual minimum", table="checks")
    def limit(self) -> float:
        """[mm] or a ratio."""
        return self._scale * self.check.limit

    @property
    @shows("", "unit of value and limit; empty for ratios", table="checks")
    def unit(self) -> str:
        """Millimetres or none."""
        return self.check.unit

    @property
    @shows("", "met or not met", table="checks")
    def verdict(self) -> str:
        """Whether the rule is kept."""
        return "holds" if self.check.holds else "broken"

    @property
    @shows("", "value / limit; none if the limit is zero", table="checks")
    def value_over_limit(self) -> float:
        """A limit of zero has no such ratio."""
        return self.check.value / self.check.limit if self.check.limit > 0.0 else np.nan

    @property
    def _scale(self) -> float:
        return 1e3 if self.check.unit == "mm" else 1.0

    @property
    def sentence(self) -> str:
        """What is broken, and the remedy."""
        check, unit = self.check, f" {self.unit}".rstrip()
        below = f"{self.value:.4g}{unit}, below {self.limit:.4g}{unit}"
        return f"{check.of}: {check.rule} is {check.finding or below}; {check.remedy}."


@dataclass(frozen=True)
class Verdict:
    """Rules that hold, or those that are broken, as points: value over limit, and the place of the rule's name."""

    place: Array = shown("")
    share: Array = shown("", label="value / limit")


@dataclass(frozen=True)
class Checked:
    """All rules that apply to a case."""

    rows: tuple[CheckRow, ...]

    @property
    def broken(self) -> tuple[CheckRow, ...]:
        """Those that do not hold, the worst first."""
        return tuple(sorted((row for row in self.rows if not row.check.holds), key=lambda row: row.check.rank))

    @property
    @shows("", "number of applicable rules")
    def rules_checked(self) -> float:
        """How many."""
        return float(len(self.rows))

    @property
    @shows("", "number of rules not met")
    def rules_broken(self) -> float:
        """How many."""
        return float(len(self.broken))

    @property
    def drawn(self) -> tuple[CheckRow, ...]:
        """Rules with a ratio."""
        return tuple(row for row in self.rows if np.isfinite(row.value_over_limit))

    def verdict(self, *, holds: bool) -> Verdict | None:
        """Points of the rules that hold, or of those that do not; None where there are none."""
        share = np.array([row.value_over_limit for row in self.drawn])
        chosen = np.flatnonzero((share >= 1.0) == holds)
        return Verdict(chosen.astype(float), share[chosen]) if chosen.size else None


def _unchecked_rims(seen: Seen) -> Iterator[str]:
    for name, gear in seen.asked.gears.items():
        if name in seen.asked.assumed_rims:
            key = "outer_radius" if gear.tooth.internal else "bore_radius"
            yield f"Gear {name}: its rim is not checked; specify {key}."


def _exact(_seen: Seen) -> float:
    return 0.0


def _names(seen: Seen) -> Axis:
    return Axis("", categories=tuple(f"{row.of}: {row.rule}" for row in seen.data.drawn))


def _points(word: str, role: str, *, holds: bool) -> Line:
    return Line(
        "place", word, role, x="share", of=lambda seen: seen.data.verdict(holds=holds), kind="points", look={"size": 8}
    )


def _verdict(seen: Seen) -> Iterator[str]:
    broken, count = seen.data.broken, len(seen.data.rows)
    if not count:
        return
    if not broken:
        yield "Design check: the one rule is met." if count == 1 else f"Design check: all {count} rules are met."
        return
    which = ": " if len(broken) == 1 else ", the worst: "
    yield f"Design check: {len(broken)} of {count} rules not met{which}{broken[0].sentence}"


_TITLE = "Design check (rules of thumb)"
_SHEET = Sheet(
    name=lambda _asked: "",
    of=lambda checks, _asked: Checked(tuple(map(CheckRow, checks))),
    tables=(Rows("tooth_geometry_check", _TITLE, (Every("checks"),), of="rows"),),
    values=(Number("rules_checked", _exact), Number("rules_broken", _exact)),
    figures=(
        Chart(
            "tooth_geometry_check", _TITLE, "Value / limit for each check; left of the line: limit not met.",
            (
                Over(
                    Axis("value / limit", zero=True),
                    (_points("holds", "green", holds=True), _points("broken", "red", holds=False)),
                    _names, marks=lambda _: (Mark("x", 1.0, "limit"),),
                ),
            ),
            when="drawn",
        ),
    ),
    answer=Answer(_verdict, figure=lambda seen: "tooth_geometry_check" if seen.data.broken else ""),
    remarks=(Remark(failing("{one.sentence}"), each="broken"), _unchecked_rims),
)  # fmt: skip


TOOTH_GEOMETRY_CHECK = Stage(
    subjects=lambda scene: ("",) if scene.gears else (),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(INVOLUTE),
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
)
