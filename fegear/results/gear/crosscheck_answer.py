"""What a crosscheck comes to: compliance, stiffness and root stress by formula for finite elements, in sentences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows
from fegear.geometry.pair import MEMBERS
from fegear.results.gear.formula_names import COMPLIANCES, ROOT_FORMULAS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.engine.sheet.seen import Seen
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.results.gear.crosscheck_rows import Extremes, SingleContactRows


@dataclass(frozen=True)
class MeanStiffness:
    """Mean mesh stiffness of a pair per face width: that of ISO 6336-1, and by finite elements where it is known."""

    iso: float | None = shown("N/(mm.um)", "ISO 6336-1 c_gamma_alpha", name="mesh_stiffness_iso")
    fe: float | None = shown(
        "N/(mm.um)", "mean mesh stiffness per face width, FE (secant, perfect flanks, without corner contact)",
        name="mesh_stiffness_fe",
    )  # fmt: skip
    #: Of helical pairs [m].
    face_width: float | None = None

    @classmethod
    def of(cls, iso: Stiffness | None, fe: float | None, face_width: float | None = None) -> MeanStiffness:
        """Of what the standard gives, if anything."""
        return cls(None if iso is None else iso.mesh_alpha, fe, face_width)

    @property
    @shows("", "c_gamma_alpha / FE", name="mesh_stiffness_iso.ratio_to_fe")
    def ratio_to_fe(self) -> float | None:
        """Of both."""
        return None if self.iso is None or self.fe is None else self.iso / self.fe


def _ranges(extremes: Mapping[str, Extremes], labels: Mapping[str, str]) -> str:
    """Of each formula over finite elements."""
    return ", ".join(
        f"{label} {extremes[name].lowest_ratio:.2f} to {extremes[name].highest_ratio:.2f}"
        for name, label in labels.items()
        if name in extremes
    )


def said_of_compliance(seen: Seen) -> list[str]:
    """One pair: the range of each formula over finite elements."""
    ranges = _ranges(seen.one.compliance.extremes, COMPLIANCES)
    said = f"Pair {seen.key}: compliance of one tooth pair by formula over finite elements: {ranges}."
    return [said] if ranges else []


def said_of_stiffness(seen: Seen) -> list[str]:
    """One pair: c' and c_gamma_alpha of ISO 6336-1 over finite elements; what to ask for where these are not there."""
    single, mean = seen.data.pairs.get(seen.key), seen.one
    parts = []
    if single is not None and single.ratio_to_fe is not None:
        parts.append(
            f"c' {single.single_stiffness_iso * 1e-9:.3g} / {single.single_stiffness_fe * 1e-9:.3g} N/(mm µm) = "
            f"{single.ratio_to_fe:.2f}"
        )
    if mean.ratio_to_fe is not None:
        parts.append(
            f"mean mesh stiffness c_gamma_alpha {mean.iso * 1e-9:.3g} / {mean.fe * 1e-9:.3g} N/(mm µm) "
            f"(secant, without tip contact off the path of contact) = {mean.ratio_to_fe:.2f}"
        )
    elif mean.iso is not None and mean.face_width is not None:
        over_face = mean.iso * mean.face_width * 1e-6
        said = (
            f"Pair {seen.key}: mean mesh stiffness c_gamma_alpha of ISO 6336-1 {mean.iso * 1e-9:.3g} N/(mm µm), over "
            f"the face width {over_face:.3g} N/µm (compare mesh_stiffness_mean of transmission-error)."
        )
        return [said]
    return [f"Pair {seen.key}: ISO 6336-1 over finite elements: {', '.join(parts)}."] if parts else []


def said_of_single_contact(seen: Seen) -> list[str]:
    """Both gears of one pair, each formula at the load for which ratings take it, and the standard over all loads."""
    rows: SingleContactRows | None = seen.one.single_contact
    if rows is None:
        return []
    found: dict[str, str] = {}
    for role, name in zip(MEMBERS, seen.one.check.gears, strict=True):
        own = rows.of_gear(role)
        ratios = dict(zip(own.formula, own.ratio_to_fe, strict=True))
        known = [(label, ratios.get(key, np.nan)) for key, label in ROOT_FORMULAS.items()]
        said = ", ".join(f"{label} {ratio:.2f}" for label, ratio in known if np.isfinite(ratio))
        where = f"loaded at its outer point of single pair contact (HPSTC, diameter {2e3 * own.radius[0]:.5g} mm)"
        if said:
            found.setdefault(name, f"{name} {where}: root stress by formula / FE {said}")
    return [f"Pair {seen.key}, {sentence}." for sentence in found.values()]


def said_of_helical(seen: Seen) -> list[str]:
    """Virtual spur teeth of one helical pair, each at its outer point of single pair contact, by the standard."""
    if seen.key in seen.data.pairs:
        return []
    known = [(row.role, row.ratio_to_fe) for row in seen.one.rows if np.isfinite(row.ratio_to_fe)]
    if not known:
        return []
    ratios = ", ".join(f"{role} {ratio:.2f}" for role, ratio in known)
    said = (
        f"Pair {seen.key}, virtual spur teeth loaded at their outer points of single pair contact: root stress "
        f"F_t/(b m_n) Y_F Y_S of ISO 6336-3 / FE {ratios}."
    )
    return [said]


def said_of_root_stress(seen: Seen) -> list[str]:
    """One gear without an outer point of single pair contact: loads on the upper half of the flank."""
    if seen.one.rated_loads:
        return []
    ranges = _ranges(seen.one.root_stress.upper_half.extremes, ROOT_FORMULAS)
    said = f"Gear {seen.key}, loads on the upper half of the flank: root stress by formula / FE {ranges}."
    return [said] if ranges else []
