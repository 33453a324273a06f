"""What a crosscheck comes to: compliance, stiffness and root stress by formula for finite elements, in sentences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.contact.error_over_pitch import ErrorOverPitch
    from fegear.engine.sheet.seen import Seen
    from fegear.results.gear.crosscheck_rows import Extremes

#: Result that knows the mean mesh stiffness.
IN_MESH = "transmission-error"
#: Formulas of root stress as people name them, in the order in which an answer has them.
_ROOT_FORMULAS = {
    "iso-6336-3": "ISO 6336-3", "agma-908": "AGMA 908", "cornell": "Cornell", "cornell-trochoid": "Cornell (trochoid)",
    "heywood": "Heywood", "dolan-broghamer": "Dolan and Broghamer",
}  # fmt: skip


#: The same of compliance.
_COMPLIANCES = {
    "potential-energy": "potential energy", "weber-banaschek": "Weber and Banaschek", "cornell": "Cornell",
}  # fmt: skip


@dataclass(frozen=True)
class MeanStiffness:
    """Mean mesh stiffness of a pair per face width: that of ISO 6336-1, and by finite elements where it is known."""

    iso: float | None = shown("N/(mm.um)", "ISO 6336-1 c_gamma_alpha", name="mesh_stiffness_iso")
    fe: float | None = shown(
        "N/(mm.um)", "mean mesh stiffness per face width (secant), FE with the effects of the case",
        name="mesh_stiffness_fe",
    )  # fmt: skip
    fe_error: float | None = None

    @property
    @shows("", "c_gamma_alpha / FE", name="mesh_stiffness_iso.ratio_to_fe")
    def ratio_to_fe(self) -> float | None:
        """Of both."""
        return None if self.iso is None or self.fe is None else self.iso / self.fe


def mean_stiffness(over: ErrorOverPitch) -> tuple[float, float | None]:
    """Of a loaded pair per face width, secant, and its estimated error [Pa]."""
    width, error = over.pair.face_width, None if over.shift is None else over.shift.stiffness
    return over.mesh_stiffness_mean / width, None if error is None else error / width


def _ranges(extremes: Mapping[str, Extremes], labels: Mapping[str, str]) -> str:
    """Of each formula over finite elements."""
    return ", ".join(
        f"{label} {extremes[name].lowest_ratio:.2f} to {extremes[name].highest_ratio:.2f}"
        for name, label in labels.items()
        if name in extremes
    )


def said_of_compliance(seen: Seen) -> list[str]:
    """One pair: the range of each formula over finite elements."""
    ranges = _ranges(seen.one.compliance.extremes, _COMPLIANCES)
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
            f"mean mesh stiffness c_gamma_alpha {mean.iso * 1e-9:.3g} / {mean.fe * 1e-9:.3g} N/(mm µm) (secant) = "
            f"{mean.ratio_to_fe:.2f}"
        )
    elif mean.iso is not None:
        parts.append(f"c_gamma_alpha {mean.iso * 1e-9:.3g} N/(mm µm) (for FE request {IN_MESH}, too)")
    return [f"Pair {seen.key}: ISO 6336-1 over finite elements: {', '.join(parts)}."] if parts else []


def said_of_root_stress(seen: Seen) -> list[str]:
    """One gear: the range of each formula over finite elements, that of the standard first."""
    ranges = _ranges(seen.one.root_stress.extremes, _ROOT_FORMULAS)
    return [f"Gear {seen.key}: root stress by formula over finite elements: {ranges}."] if ranges else []
