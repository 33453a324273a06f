"""Mesh stiffness while a cracked or pitted tooth passes, in the result ``crosscheck``: formulas and finite elements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.results.gear.formula_names import COMPLIANCES, formula_called

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.contact.compared.odd_cycle import OddAndOrdinary, OddPassage
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.value import Value


_SECANT = "mesh stiffness (secant, sum over the pairs in contact)"
_FE_APART = "FE without the coupling of neighbouring teeth"


@dataclass(frozen=True)
class PassageCompared:
    """Mesh stiffness of one pair while one odd tooth passes."""

    pair: str
    found: OddPassage

    @property
    def key(self) -> str:
        """Of its table and figure."""
        return f"{self.pair}_{self.found.tooth.gear}_{self.found.tooth.tooth}"

    @property
    def title(self) -> str:
        """In words."""
        tooth = self.found.tooth
        return f"Mesh stiffness of pair {self.pair}, tooth {tooth.tooth} of gear {tooth.gear} {tooth.what}"

    @property
    def formulas(self) -> dict[str, OddByFormula]:
        """Those that give anything."""
        return {
            name: OddByFormula(
                name, one.value, self.found.tooth.what, self.found.driver_angle, one.value.odd, one.value.ordinary
            )
            for name, one in self.found.formulas.items()
            if one.value is not None
        }

    @property
    def silent(self) -> dict[str, str]:
        """Formulas that give nothing, with their reasons."""
        return {name: one.reason for name, one in self.found.formulas.items() if one.reason}


@dataclass(frozen=True)
class OddByFormula:
    """Mesh stiffness by one formula, shape (P,)."""

    name: str
    found: OddAndOrdinary
    what: str
    driver_angle: Array = shown("deg")
    odd: Array = shown("N/um")
    ordinary: Array = shown("N/um")

    @property
    def column(self) -> str:
        """A name that is one in MATLAB, too."""
        return f"mesh_stiffness_{self.name.replace('-', '_')}"


def said_of_passage(seen: Seen) -> list[str]:
    """Minimum mesh stiffness with the odd tooth, and its reduction, by finite elements and by formulas."""
    one: PassageCompared = seen.one
    tooth, fe = one.found.tooth, one.found.fe
    by = [("FE", fe), *((COMPLIANCES[name], its.found) for name, its in one.formulas.items())]
    said = ", ".join(f"{name} {found.odd.min() * 1e-6:.4g} N/µm (-{percent(found.loss)})" for name, found in by)
    said += "".join(f", {COMPLIANCES[name]} not valid here" for name in _silent_here(seen))
    return [
        (
            f"Pair {one.pair}, tooth {tooth.tooth} of gear {tooth.gear} {tooth.what}: minimum mesh stiffness on the "
            f"path of contact (and change from ordinary teeth) {said}."
        )
    ]


def passage_values(seen: Seen) -> Iterator[Value]:
    """Reduction of the minimum mesh stiffness by finite elements and by each formula."""
    one: PassageCompared = seen.one
    which = f"tooth {one.found.tooth.tooth} of gear {one.found.tooth.gear} {one.found.tooth.what}"
    for name, of, words in (
        ("fe", "found.fe", "FE"), ("fe_uncoupled", "found.uncoupled", _FE_APART),
        *((name, f"formulas.{name}.found", name) for name in one.formulas),
    ):  # fmt: skip
        yield from Number(
            "loss", of=of, owner="{key}", name=f"mesh_stiffness_loss.{name}",
            meaning=f"reduction of the minimum mesh stiffness on the path of contact, {which}, {words}",
        ).values(seen)  # fmt: skip


def silent_on_odd_teeth(seen: Seen) -> list[str]:
    """Formulas without a column, and why, where that is not said of the compliance of one tooth pair."""
    return [f"{seen.one.title}: {name} gives no value: {why}" for name, why in _silent_here(seen).items()]


def _silent_here(seen: Seen) -> dict[str, str]:
    """Formulas that give nothing of the odd tooth but something of ordinary ones, with their reasons."""
    one: PassageCompared = seen.one
    known = seen.data.pairs[one.pair].compliance.silent
    return {name: why for name, why in one.silent.items() if name not in known}


ODD_TABLE = Rows(
    "crosscheck_odd_tooth_{key}", "{one.title}: formulas and finite elements",
    (
        "x", "driver_angle",
        Cell("fe.odd", name="mesh_stiffness_fe", meaning=_SECANT + " with the odd tooth, FE"),
        Cell("fe.ordinary", name="mesh_stiffness_fe_ordinary", meaning=_SECANT + " of ordinary teeth, FE"),
        Cell(
            "uncoupled.odd", name="mesh_stiffness_fe_uncoupled",
            meaning=_SECANT + " with the odd tooth, " + _FE_APART,
        ),
        Cell(
            "uncoupled.ordinary", name="mesh_stiffness_fe_uncoupled_ordinary",
            meaning=_SECANT + " of ordinary teeth, " + _FE_APART,
        ),
        Each(
            "formulas",
            Cell("odd", name="{one.column}", meaning=_SECANT + " with the odd tooth, {key}"),
            Cell("ordinary", name="{one.column}_ordinary", meaning=_SECANT + " of ordinary teeth, {key}"),
        ),
    ),
    of="found", matlab=True,
)  # fmt: skip
ODD_CHART = Chart(
    "crosscheck_odd_tooth_{key}", "{one.title}: formulas and finite elements",
    "{one.title}: mesh stiffness (secant, sum over the pairs in contact) over the rotation, from a base pitch before "
    "this tooth comes into mesh. Dashed: ordinary teeth. Perfect flanks, contact on the path of contact only.",
    (
        Over(
            "driver_angle",
            (
                Line("fe.odd", "finite elements, {one.found.tooth.what}", "finite elements", look={"width": 2.6}),
                Line(
                    "fe.ordinary", "finite elements, ordinary", "finite elements",
                    look={"dash": "dash", "width": 2.0},
                ),
                Bundle(
                    Family("formulas", formula_called, most=None),
                    (  # dashes of their own: those of families tell formulas apart where colours do not
                        Line("odd", lambda seen: f"{formula_called(seen)}, {seen.one.what}", look={"dash": "solid"}),
                        Line("ordinary", lambda seen: f"{formula_called(seen)}, ordinary", look={"dash": "dash"}),
                    ),
                ),
            ),
            options={"zero": True},
        ),
    ),
    of="found",
)  # fmt: skip
