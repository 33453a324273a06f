"""Mesh stiffness over the mesh cycle in the result ``crosscheck``: every formula beside finite elements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.shown import shown, shows
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.results.gear.formula_names import COMPLIANCES, formula_called

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.contact.compared.mesh_cycle import MeshCycle
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.value import Value


@dataclass(frozen=True)
class CycleCompared:
    """Mesh stiffness of one pair over one base pitch.

    Parameters
    ----------
    found : MeshCycle
    iso : float or None
        c_gamma_alpha of ISO 6336-1 over the face width [N/m].
    """

    found: MeshCycle
    iso: float | None = shown("N/um", "ISO 6336-1 c_gamma_alpha times face width")

    @property
    def formulas(self) -> dict[str, ByFormula]:
        """Those that give anything."""
        fe = self.found.fe.mean
        return {
            name: ByFormula(name, one.value.mean / fe, self.found.driver_angle, one.value.stiffness)
            for name, one in self.found.formulas.items()
            if one.value is not None
        }

    @property
    def silent(self) -> dict[str, str]:
        """Formulas that give nothing, with their reasons."""
        return {name: one.reason for name, one in self.found.formulas.items() if one.reason}

    @property
    @shows(
        "", "mean mesh stiffness over the mesh cycle, FE without the coupling of neighbouring teeth / FE",
        name="mesh_stiffness_fe_uncoupled.ratio_to_fe",
    )  # fmt: skip
    def uncoupled_ratio(self) -> float:
        """What the coupling alone changes."""
        return self.found.uncoupled.mean / self.found.fe.mean


@dataclass(frozen=True)
class ByFormula:
    """Mesh stiffness over the mesh cycle by one formula, shape (P,), and its mean over that by finite elements."""

    name: str
    ratio: float = shown("", "mean mesh stiffness over the mesh cycle, formula / FE")
    driver_angle: Array = shown("deg")
    stiffness: Array = shown("N/um")

    @property
    def column(self) -> str:
        """A name that is one in MATLAB, too."""
        return f"mesh_stiffness_{self.name.replace('-', '_')}"


def said_of_cycle(seen: Seen) -> list[str]:
    """Means over the mesh cycle by all formulas, and what the coupling of neighbouring teeth changes."""
    cycle: CycleCompared = seen.one
    ratios = [f"{COMPLIANCES[name]} {one.ratio:.2f}" for name, one in cycle.formulas.items()]
    if not ratios:
        return []
    return [
        (
            f"Pair {seen.key}: mean mesh stiffness over the mesh cycle by formula / FE {', '.join(ratios)}; "
            f"FE without the coupling of neighbouring teeth, as in formulas, {cycle.uncoupled_ratio:.2f}."
        )
    ]


def cycle_values(seen: Seen) -> Iterator[Value]:
    """Mean of each formula over finite elements."""
    for name in seen.one.formulas:
        yield from Number(
            "ratio", of=f"formulas.{name}", owner="{key}", name=f"mesh_stiffness.{name}.ratio_to_fe",
            meaning=f"mean mesh stiffness over the mesh cycle, {name} / FE",
        ).values(seen)  # fmt: skip
    yield from Number("uncoupled_ratio", owner="{key}").values(seen)


def silent_formulas(seen: Seen) -> list[str]:
    """Which formulas have no column, and why, where that is not said of the compliance of one tooth pair."""
    said = seen.data.pairs[seen.key].compliance.silent
    return [
        f"Mesh stiffness of pair {seen.key} over the mesh cycle: {name} gives no value: {why}"
        for name, why in seen.one.silent.items()
        if name not in said
    ]


def _iso(seen: Seen) -> tuple[Mark, ...]:
    iso = seen.one.iso
    return () if iso is None else (Mark("y", iso * 1e-6, "ISO 6336-1 c_γα"),)


_TITLE = "Mesh stiffness of pair {key}: formulas and finite elements"
_SECANT = "mesh stiffness (secant, sum over the pairs in contact)"
CYCLE_TABLE = Rows(
    "crosscheck_mesh_stiffness_{key}", _TITLE,
    (
        "x", "driver_angle",
        Cell("fe.stiffness", name="mesh_stiffness_fe", meaning=_SECANT + ", FE"),
        Cell(
            "uncoupled.stiffness", name="mesh_stiffness_fe_uncoupled",
            meaning=_SECANT + ", FE without the coupling of neighbouring teeth",
        ),
        Cell("stiffness", each="formulas", name="{one.column}", meaning=_SECANT + ", {key}"),
    ),
    of="found", matlab=True,
)  # fmt: skip
CYCLE_CHART = Chart(
    "crosscheck_mesh_stiffness_{key}", _TITLE,
    "Pair {key}: mesh stiffness over one base pitch (secant, sum over the pairs in contact), perfect flanks, contact "
    "on the path of contact only. Formulas add tooth pairs as springs in parallel; dashed: finite elements without "
    "the coupling of neighbouring teeth. Dotted: c_gamma_alpha of ISO 6336-1.",
    (
        Over(
            "driver_angle",
            (
                Line("fe.stiffness", "finite elements", "finite elements", look={"width": 2.6}),
                Line("uncoupled.stiffness", "finite elements, uncoupled", "finite elements", look={"dash": "dash"}),
                Line("stiffness", each=Family("formulas", formula_called, most=None)),
            ),
            options={"zero": True}, marks=_iso,
        ),
    ),
    of="found",
)  # fmt: skip
