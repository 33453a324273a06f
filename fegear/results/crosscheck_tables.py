"""Tables and single values of the result ``crosscheck``: closed forms over finite elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Table, Value

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fegear.arrays import Array
    from fegear.contact.crosscheck import ComplianceAnswers, RootStressAnswers
    from fegear.fem import StiffnessTable
    from fegear.geometry import Gear
    from fegear.results.crosscheck_data import GearAnswers, PairAnswers, PairCheck

COMPLIANCE, STRESS = "um.mm/N", "MPa.mm/N"


def root_stress_table(
    name: str, gear: Gear, fe: StiffnessTable, answers: Mapping[str, RootStressAnswers]
) -> tuple[Table, tuple[Value, ...]]:
    """Every root-stress formula over the finite elements of one gear."""
    count, m = fe.radius.size, gear.module
    times = len(answers)

    def tiled(values: Array) -> Array:
        return np.tile(values, times)

    def joined(attribute: str, scale: float) -> Array:
        return np.concatenate([getattr(a, attribute) for a in answers.values()]) * scale

    stress = joined("stress", 1.0 / m)
    ratio = stress / tiled(fe.root_tension)
    columns = (
        Column("formula", np.repeat(list(answers), count), "", "name of the formula, see crosscheck_sources"),
        Column("radius", tiled(fe.radius), "mm", "radius of the contact point"),
        Column("roll_angle", tiled(fe.roll_angle), "deg", "roll angle of the contact point"),
        Column("root_tension", stress, STRESS, "by the formula, per line load normal to the flank"),
        Column("root_tension_fe", tiled(fe.root_tension), STRESS, "largest tangential stress of the fillet by FE"),
        Column("root_tension_fe_error", tiled(fe.errors["root_tension"]), STRESS, "estimated error of FE"),
        Column("ratio_to_fe", ratio, "", "formula over FE"),
        Column("place_radius", joined("radius", m), "mm", "where the formula puts it"),
        Column("place_radius_fe", tiled(fe.root_tension_radius), "mm", "where FE puts it"),
        Column("place_angle", joined("tangent_angle", 1.0), "deg", "fillet tangent to tooth centre line there"),
        Column("place_angle_fe", tiled(fe.root_tension_angle), "deg", "the same by FE"),
        Column("reason", _words(answers), "", "why the formula gives nothing; empty where it does"),
    )
    title = f"Root stress of gear {name}: closed forms over finite elements"
    values = _extremes(f"{name}.root_stress", ratio.reshape(times, count), tuple(answers))
    return Table(f"crosscheck_root_stress_{name}", columns, title), values


def _words(answers: Mapping[str, RootStressAnswers] | Mapping[str, ComplianceAnswers]) -> NDArray[np.str_]:
    return np.array([reason for a in answers.values() for reason in a.reasons], dtype=np.str_)


def _extremes(prefix: str, ratio: Array, names: tuple[str, ...]) -> tuple[Value, ...]:
    """Smallest and largest ratio and the largest deviation of every formula that gives anything."""
    found = []
    for name, row in zip(names, ratio, strict=True):
        r = row[np.isfinite(row)]
        if r.size:
            key = f"{prefix}.{name}"
            found += [
                Value(f"{key}.lowest_ratio", float(r.min()), "", None, f"{name} over FE, smallest over the positions"),
                Value(f"{key}.highest_ratio", float(r.max()), "", None, f"{name} over FE, largest over the positions"),
                Value(
                    f"{key}.largest_deviation", float(np.abs(r - 1.0).max()), "", None, f"{name} against FE, relative"
                ),
            ]
    return tuple(found)


def _compliance_table(
    name: str,
    what: str,
    first: tuple[Column, ...],
    reference: tuple[Column, ...],
    answers: Mapping[str, ComplianceAnswers],
    parts: tuple[str, ...],
) -> tuple[Table, tuple[Value, ...]]:
    times, count = len(answers), len(first[0].si)
    total = np.concatenate([a.total for a in answers.values()])
    ratio = total / np.tile(reference[0].si, times)
    split = [
        np.concatenate([a.parts[i] if len(a.parts) > i else a.parts[0] for a in answers.values()])
        for i in range(len(parts))
    ]
    columns = (
        Column("formula", np.repeat(list(answers), count), "", "name of the formula, see crosscheck_sources"),
        *(Column(c.name, np.tile(c.si, times), c.unit, c.meaning) for c in first),
        Column("compliance", total, COMPLIANCE, "by the formula, deflection along the line of action per line load"),
        *(Column(c.name, np.tile(c.si, times), c.unit, c.meaning) for c in reference),
        Column("ratio_to_fe", ratio, "", "formula over FE"),
        *(Column(p, s, COMPLIANCE, "part of the formula's sum") for p, s in zip(parts, split, strict=True)),
        Column("reason", _words(answers), "", "why the formula gives nothing; empty where it does"),
    )
    table = Table(f"crosscheck_compliance_{name}", columns, f"{what}: closed forms over finite elements")
    return table, _extremes(f"{name}.compliance", ratio.reshape(times, count), tuple(answers))


def gear_compliance_table(name: str, gear: Gear, found: GearAnswers) -> tuple[Table, tuple[Value, ...]]:
    """Every compliance formula of one tooth, without its contact, over the finite elements."""
    fe, zone = found.table, found.contact_zone
    first = (
        Column("radius", fe.radius, "mm", "radius of the contact point"),
        Column("roll_angle", fe.roll_angle, "deg", "roll angle of the contact point"),
    )
    reference = (
        Column("compliance_fe", fe.c_self - zone, COMPLIANCE, "FE, the loaded tooth without its contact zone"),
        Column("compliance_fe_error", fe.errors["c_self"], COMPLIANCE, "estimated error of FE"),
        Column("contact_zone", zone, COMPLIANCE, "half-plane approach that was taken off from FE"),
    )
    parts = ("bending", "shear", "axial", "foundation")
    what = f"Compliance of one tooth of gear {name} without its contact, plane {gear.plane_assumption}"
    return _compliance_table(name, what, first, reference, found.compliance, parts)


def pair_table(name: str, check: PairCheck, found: PairAnswers) -> tuple[Table, tuple[Value, ...], str]:
    """Table and values of a pair, and what is to be remarked about ISO's c'; empty if nothing."""
    fe, w = found.reference, check.line_load
    first = (Column("x", fe.x, "mm", "contact point from the pitch point, positive toward the driver's tip"),)
    reference = (
        Column("compliance_fe", fe.total, COMPLIANCE, "FE, one tooth pair with its contact"),
        Column("driver_fe", fe.driver, COMPLIANCE, "FE, the driver's tooth with its side of the contact"),
        Column("driven_fe", fe.driven, COMPLIANCE, "FE, the driven tooth with its side of the contact"),
        Column("contact_half_width", fe.half_width, "mm", "Hertz's half-width under the line load"),
    )
    what = f"Compliance of one tooth pair of pair {name} under {w * 1e-3:.6g} N/mm"
    parts = ("driver", "driven", "contact")
    table, values = _compliance_table(name, what, first, reference, found.compliance, parts)
    greatest = float(1.0 / fe.total.min())
    unit = "N/(mm.um)"
    own = Value(f"{name}.single_stiffness_fe", greatest, unit, None, "greatest stiffness of one tooth pair by FE")
    iso = found.iso.value
    if iso is None:
        return table, (*values, own), f"Pair {name}: ISO 6336-1 gives no c': {found.iso.reason}"
    extra = (
        *values,
        own,
        Value(f"{name}.single_stiffness_iso", iso.single, unit, None, "ISO 6336-1 c', solid blank, with C_M = 0.8"),
        Value(f"{name}.theoretical_stiffness_iso", iso.theoretical, unit, None, "ISO 6336-1 c'_th"),
        Value(f"{name}.single_stiffness_iso.ratio_to_fe", iso.single / greatest, "", None, "c' over FE"),
    )
    return table, extra, f"Pair {name}: {iso.remark}." if iso.remark else ""


def sources_table() -> Table:
    """Where each closed form comes from and what it compares."""
    from fegear.formulas.root_stress_sources import ROOT_STRESS_SOURCES
    from fegear.formulas.sources import SOURCES

    rows = [(s.name, "root stress", s.citation, s.compared) for s in ROOT_STRESS_SOURCES.values()]
    rows += [(s.name, "compliance", s.citation, s.remark) for s in SOURCES.values()]
    heads = ("formula", "gives", "source", "what_is_compared")
    columns = (Column(head, np.array(values)) for head, values in zip(heads, zip(*rows, strict=True), strict=True))
    return Table("crosscheck_sources", tuple(columns), "The closed forms and what each compares")
