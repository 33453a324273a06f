"""Closed forms over finite elements, formula by formula and position by position: root stress and compliance."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from fegear.base.shown import shown, shows
from fegear.engine.figure.items import Mark, Zone
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Columns, Off
from fegear.results.gear.formula_names import formula_called

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.compared.crosscheck import ComplianceAnswers, PairReference, RootStressAnswers
    from fegear.contact.compared.single_contact import AtSingleContact
    from fegear.engine.sheet.seen import Seen, Text
    from fegear.engine.value import Value
    from fegear.fem.plane.table import StiffnessTable
    from fegear.geometry.pair import GearPair

#: Load positions from which on a load counts as high: about where the outer point of single pair contact begins.
HIGH = 0.5
#: Ratios that figures shade as agreement.
_AGREEMENT = (0.95, 1.05)
_C = TypeVar("_C", bound="Compared")


@dataclass(frozen=True)
class Extremes:
    """Of one formula over finite elements, over all positions at which it answers."""

    lowest_ratio: float = shown("")
    highest_ratio: float = shown("")
    largest_deviation: float = shown("")


@dataclass(frozen=True)
class Compared:
    """Formulas compared with the finite elements, formula by formula over N positions, shape (F N,).

    Parameters
    ----------
    formula, reason : ndarray of str
    result, reference, ratio_to_fe : ndarray
        By the formula, and by finite elements; declared in the unit of what is compared.
    """

    reason: NDArray[np.str_]
    result: Array
    reference: Array
    formula: NDArray[np.str_] = shown("", "formula, see crosscheck_sources")

    @property
    @shows("", "formula / FE", label="formula / FE")
    def ratio_to_fe(self) -> Array:
        """Shape (F N,)."""
        return self.result / self.reference

    def where(self: _C, of: NDArray[np.bool_]) -> _C:
        """Some of the rows."""
        return replace(self, **{one.name: getattr(self, one.name)[of] for one in fields(self)})

    def rows_of(self: _C, formula: str) -> _C:
        """The same for one formula only."""
        return self.where(self.formula == formula)

    @property
    def formulas(self: _C) -> dict[str, _C]:
        """One by one."""
        return {name: self.rows_of(name) for name in dict.fromkeys(map(str, self.formula))}

    @property
    def extremes(self) -> dict[str, Extremes]:
        """Of every formula that gives anything."""
        known = {name: one.ratio_to_fe[np.isfinite(one.ratio_to_fe)] for name, one in self.formulas.items()}
        return {
            name: Extremes(float(r.min()), float(r.max()), float(np.abs(r - 1.0).max()))
            for name, r in known.items()
            if r.size
        }

    @property
    def silent(self) -> dict[str, str]:
        """Formulas that answer nothing at some positions, with the last reason."""
        return {str(name): str(why) for name, why in zip(self.formula, self.reason, strict=True) if why}

    @property
    def out_of_range(self) -> str:
        """Names of those, as a sentence of a caption."""
        names = ", ".join(self.silent)
        return f" Out of range at some positions (see the table's reasons): {names}." if names else ""


@dataclass(frozen=True)
class RootStressRows(Compared):
    """Root stress of one gear; radii [m], angles [rad]."""

    result: Array = shown("MPa.mm/N", label="root stress per line load")
    reference: Array = shown("MPa.mm/N")
    radius: Array = shown("mm")
    roll_angle: Array = shown("deg", label="roll angle of the load")
    error: Array = shown("MPa.mm/N")
    place_radius: Array = shown("mm")
    place_radius_fe: Array = shown("mm")
    place_angle: Array = shown("deg", label="angle of fillet tangent to tooth centre line")
    place_angle_fe: Array = shown("deg")

    @property
    def upper_half(self) -> RootStressRows:
        """Loads on the upper half of the flank, by roll angle from the lowest load to the highest."""
        share = (self.roll_angle - self.roll_angle.min()) / (np.ptp(self.roll_angle) or 1.0)
        return self.where(share >= HIGH)

    @classmethod
    def of(cls, answers: Mapping[str, RootStressAnswers], fe: StiffnessTable, module: float) -> RootStressRows:
        """Answers are those of a tooth of module 1."""
        tiled = partial(np.tile, reps=len(answers))
        return cls(
            _reasons(answers), _joined(answers, "stress") * (1.0 / module), tiled(fe.root_tension),
            _names(answers, fe.radius.size), tiled(fe.radius), tiled(fe.roll_angle), tiled(fe.errors["root_tension"]),
            _joined(answers, "radius") * module, tiled(fe.root_tension_radius), _joined(answers, "tangent_angle"),
            tiled(fe.root_tension_angle),
        )  # fmt: skip


@dataclass(frozen=True)
class SingleContactRows(Compared):
    """Root stress of both gears of a pair, each loaded at its outer point of single pair contact; radii [m].

    Parameters
    ----------
    role, gear : ndarray of str
    """

    role: NDArray[np.str_] = shown("", "driver or driven")
    gear: NDArray[np.str_] = shown("", "name of the gear")
    result: Array = shown("MPa.mm/N")
    reference: Array = shown("MPa.mm/N")
    radius: Array = shown("mm", "radius of the load: outer point of single pair contact (HPSTC)", name="hpstc_radius")
    error: Array = shown("MPa.mm/N")

    @classmethod
    def of(cls, found: Sequence[AtSingleContact], pair: GearPair, gears: Sequence[str]) -> SingleContactRows:
        """Of gears with these names, driver first."""
        rows = [
            (
                answer.reasons[0], answer.stress[0] / pair.gear(one.member).module, one.fe, formula, one.member, gear,
                one.radius, one.fe_error,
            )
            for one, gear in zip(found, gears, strict=True)
            for formula, answer in one.answers.items()
        ]  # fmt: skip
        reason, result, reference, formula, role, gear, radius, error = (np.array(column) for column in zip(*rows))  # noqa: B905  (rows of one length)
        return cls(reason, result, reference, formula, role, gear, radius, error)

    @property
    @shows("", "root stress at the outer point of single pair contact, formula / FE", name="hpstc_ratio")
    def ratio_at_hpstc(self) -> Array:
        """`ratio_to_fe` under its name as a value."""
        return self.ratio_to_fe

    @property
    def ratio_error(self) -> Array:
        """Estimated: relatively that of the finite elements."""
        return self.ratio_to_fe * self.error / self.reference

    def of_gear(self, role: str) -> SingleContactRows:
        """The same of driver or driven only."""
        return self.where(self.role == role)


@dataclass(frozen=True)
class ComplianceRows(Compared):
    """Compliances [m^2/N]."""

    result: Array = shown("um.mm/N", label="deflection per line load")
    reference: Array = shown("um.mm/N")


@dataclass(frozen=True)
class GearComplianceRows(ComplianceRows):
    """Compliance of one tooth without its contact [m^2/N]; its parts are those of the formula."""

    radius: Array = shown("mm")
    roll_angle: Array = shown("deg", label="roll angle of the load")
    error: Array = shown("um.mm/N")
    contact_zone: Array = shown("um.mm/N")
    bending: Array = shown("um.mm/N")
    shear: Array = shown("um.mm/N")
    axial: Array = shown("um.mm/N")
    foundation: Array = shown("um.mm/N")

    @classmethod
    def of(cls, answers: Mapping[str, ComplianceAnswers], fe: StiffnessTable, zone: Array) -> GearComplianceRows:
        """`zone` is the approach that is taken off the finite elements."""
        tiled = partial(np.tile, reps=len(answers))
        return cls(
            _reasons(answers), _joined(answers, "total"), tiled(fe.c_self - zone), _names(answers, zone.size),
            tiled(fe.radius), tiled(fe.roll_angle), tiled(fe.errors["c_self"]), tiled(zone), *_parts(answers, 4),
        )  # fmt: skip


@dataclass(frozen=True)
class PairComplianceRows(ComplianceRows):
    """Compliance of one tooth pair with its contact [m^2/N]; `driver`, `driven`, `contact` are the formula's parts."""

    x: Array = shown("mm", label="contact point from the pitch point")
    driver_fe: Array = shown("um.mm/N")
    driven_fe: Array = shown("um.mm/N")
    half_width: Array = shown("mm")
    driver: Array = shown("um.mm/N")
    driven: Array = shown("um.mm/N")
    contact: Array = shown("um.mm/N")

    @classmethod
    def of(cls, answers: Mapping[str, ComplianceAnswers], fe: PairReference) -> PairComplianceRows:
        """Position by position."""
        tiled = partial(np.tile, reps=len(answers))
        return cls(
            _reasons(answers), _joined(answers, "total"), tiled(fe.total), _names(answers, fe.x.size), tiled(fe.x),
            tiled(fe.driver), tiled(fe.driven), tiled(fe.half_width), *_parts(answers, 3),
        )  # fmt: skip


def _names(answers: Mapping[str, Any], positions: int) -> NDArray[np.str_]:
    return np.repeat(list(answers), positions)


def _reasons(answers: Mapping[str, Any]) -> NDArray[np.str_]:
    return np.array([reason for one in answers.values() for reason in one.reasons], dtype=np.str_)


def _joined(answers: Mapping[str, Any], attribute: str) -> Array:
    return np.concatenate([getattr(one, attribute) for one in answers.values()])


def _parts(answers: Mapping[str, ComplianceAnswers], count: int) -> list[Array]:
    """Every part; formulas with fewer give their first in place of those they lack."""
    return [
        np.concatenate([one.parts[i] if len(one.parts) > i else one.parts[0] for one in answers.values()])
        for i in range(count)
    ]


def _stiffness(_seen: Seen) -> type:
    from fegear.fem.plane.table import StiffnessTable

    return StiffnessTable


def _compliance(_seen: Seen) -> type:
    from fegear.contact.compared.crosscheck import ComplianceAnswers

    return ComplianceAnswers


def _reference(_seen: Seen) -> type:
    from fegear.contact.compared.crosscheck import PairReference

    return PairReference


#: Of what has `RootStressRows` as ``root_stress``.
ROOT_STRESS_COLUMNS: Columns = (
    "formula",
    Cell("radius", si="root_stress.radius", of=_stiffness),
    Cell("roll_angle", si="root_stress.roll_angle", of=_stiffness),
    Cell(
        "root_tension",
        si="root_stress.result",
        of=_stiffness,
        meaning="root stress by the formula, per line load normal to the flank",
    ),
    Cell(
        "root_tension",
        si="root_stress.reference",
        of=_stiffness,
        name="root_tension_fe",
        meaning="maximum tangential stress in the fillet, FE",
    ),
    Off("root_tension", "root_stress.error", "estimated error of FE", of=_stiffness, name="root_tension_fe"),
    "ratio_to_fe",
    Cell(
        "root_tension_radius",
        si="root_stress.place_radius",
        of=_stiffness,
        name="place_radius",
        meaning="location by the formula",
    ),
    Cell(
        "root_tension_radius",
        si="root_stress.place_radius_fe",
        of=_stiffness,
        name="place_radius_fe",
        meaning="position of the maximum, FE",
    ),
    Cell("root_tension_angle", si="root_stress.place_angle", of=_stiffness, name="place_angle"),
    Cell(
        "root_tension_angle",
        si="root_stress.place_angle_fe",
        of=_stiffness,
        name="place_angle_fe",
        meaning="angle of the maximum, FE",
    ),
    Cell("reasons", si="root_stress.reason", of=_compliance),
)
#: Of `SingleContactRows`.
SINGLE_CONTACT_COLUMNS: Columns = (
    "gear",
    "role",
    "formula",
    "radius",
    Cell(
        "root_tension",
        si="single_contact.result",
        of=_stiffness,
        meaning="root stress by the formula, per line load normal to the flank",
    ),
    Cell(
        "root_tension",
        si="single_contact.reference",
        of=_stiffness,
        name="root_tension_fe",
        meaning="maximum tangential stress in the fillet, FE",
    ),
    Off("root_tension", "single_contact.error", "estimated error of FE", of=_stiffness, name="root_tension_fe"),
    "ratio_to_fe",
    Cell("reasons", si="single_contact.reason", of=_compliance),
)
#: Of what has `GearComplianceRows` as ``compliance``.
GEAR_COMPLIANCE_COLUMNS: Columns = (
    "formula",
    Cell("radius", si="compliance.radius", of=_stiffness),
    Cell("roll_angle", si="compliance.roll_angle", of=_stiffness),
    Cell("total", si="compliance.result", of=_compliance),
    Cell(
        "c_self",
        si="compliance.reference",
        of=_stiffness,
        name="compliance_fe",
        meaning="FE, loaded tooth without contact zone",
    ),
    Off("c_self", "compliance.error", "estimated error of FE", of=_stiffness, name="compliance_fe"),
    Cell(
        "c_self",
        si="compliance.contact_zone",
        of=_stiffness,
        name="contact_zone",
        meaning="half-plane approach subtracted from FE",
    ),
    "ratio_to_fe",
    *(
        Cell("parts", si=f"compliance.{part}", of=_compliance, name=part)
        for part in ("bending", "shear", "axial", "foundation")
    ),
    Cell("reasons", si="compliance.reason", of=_compliance),
)
#: Of what has `PairComplianceRows` as ``compliance``.
PAIR_COMPLIANCE_COLUMNS: Columns = (
    "formula",
    Cell("x", si="compliance.x", of=_reference),
    Cell("total", si="compliance.result", of=_compliance),
    Cell("total", si="compliance.reference", of=_reference),
    Cell("driver", si="compliance.driver_fe", of=_reference),
    Cell("driven", si="compliance.driven_fe", of=_reference),
    Cell("half_width", si="compliance.half_width", of=_reference),
    "ratio_to_fe",
    *(Cell("parts", si=f"compliance.{part}", of=_compliance, name=part) for part in ("driver", "driven", "contact")),
    Cell("reasons", si="compliance.reason", of=_compliance),
)


def extremes(kind: str, where: str) -> Any:
    """Values of the largest and smallest ratios of every formula; `kind` is ``root_stress`` or ``compliance``.

    `where` leads from the object of the repetition to the rows.
    """

    def of(seen: Seen) -> dict[str, tuple[str, Extremes]]:
        rows: Compared = seen.find(where)
        return {f"{seen.key}.{kind}.{name}": (name, one) for name, one in rows.extremes.items()}

    def numbers(seen: Seen) -> Any:
        for owner, (name, one) in of(seen).items():
            inner = replace(seen, key=owner, one=one)
            for quantity, meaning in (
                ("lowest_ratio", f"{name} / FE, minimum over the positions"),
                ("highest_ratio", f"{name} / FE, maximum over the positions"),
                ("largest_deviation", f"{name} relative to FE"),
            ):
                yield from Number(quantity, owner="{key}", meaning=meaning).values(inner)

    return numbers


def at_single_contact_values(seen: Seen) -> Iterator[Value]:
    """Of every formula that gives a value, for both gears of a pair."""
    rows: SingleContactRows | None = seen.one.single_contact
    if rows is None:
        return
    for i in range(rows.formula.size):
        one = replace(seen, one=rows.where(np.arange(rows.formula.size) == i))
        owner = f"{seen.key}.{rows.role[i]}.root_stress.{rows.formula[i]}"
        yield from Number(
            "ratio_at_hpstc", lambda at: at.one.ratio_error[0], si=lambda at: at.one.ratio_to_fe[0], owner=owner,
            meaning=f"{rows.formula[i]} / FE, load at the outer point of single pair contact (HPSTC)",
        ).values(one)  # fmt: skip


def comparison(name: str, title: Text, what: str, where: str, x: str, *, stress: bool = False) -> Chart:
    """Every formula compared with the finite elements, their ratio, and of a root stress its place.

    Parameters
    ----------
    name, title : text
        Of the table that it shows.
    what : str
        What is drawn, for the caption.
    where : str
        Path to the rows.
    x : str
        Quantity that all is drawn over.
    stress : bool
        Whether it is root stress.
    """
    formulas = Family(f"{where}.formulas", formula_called, most=None)

    def first(seen: Seen) -> Compared:
        return next(iter(seen.find(where).formulas.values()))

    def panel(key: str, reference: str) -> tuple[Line, Line]:
        fe = Line(reference, "finite elements", "finite elements", of=first, look={"width": 2.6})
        return fe, Line(key, each=formulas)

    def caption(seen: Seen) -> str:
        subject = seen.said(title).split(":", maxsplit=1)[0]
        return f"{subject}: {what}.{seen.find(where).out_of_range}"

    agreement = (Zone("y", *_AGREEMENT), Mark("y", 1.0, "±5 %"))

    def marks(seen: Seen) -> tuple[Zone | Mark, ...]:
        rated = [Mark("x", math.degrees(roll), words) for words, roll in seen.one.rated_loads] if stress else ()
        return *agreement, *rated

    panels = [
        Over(x, panel("result", "reference"), "result", options={"zero": not stress}, panel={"height": 1.2}),
        Over(x, (Line("ratio_to_fe", each=formulas),), "ratio_to_fe", marks=marks),
    ]
    if stress:
        panels.append(Over(x, panel("place_angle", "place_angle_fe"), "place_angle"))
    return Chart(name, title, caption, tuple(panels), of=where)
