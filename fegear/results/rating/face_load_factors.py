"""Face load factors K_Hbeta of a rated pair beside each other: what each includes, and which safety factors use it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.shown import shown

if TYPE_CHECKING:
    from fegear.formulas.iso6336.part1_face_load import Alignment


@dataclass(frozen=True)
class FaceLoadFactor:
    """One K_Hbeta of a pair."""

    method: str = shown("", "method")
    factor: float = shown("", "face load factor", name="K_Hbeta")
    includes: str = shown("", "effects included")
    excludes: str = shown("", "effects not included")
    used_for: str = shown("", "safety factors that contain it")


def face_load_factors(alignment: Alignment, by_iso: float, computed: float | None) -> tuple[FaceLoadFactor, ...]:
    """That of ISO 6336, and the one of the computed flanks where there are any.

    Parameters
    ----------
    alignment : Alignment
        What the one of ISO 6336 is made of.
    by_iso : float
    computed : float or None
        At the load with K_A, K_gamma and K_v.
    """
    rows = [FaceLoadFactor(_method(alignment), by_iso, *_counted(alignment), "S_H, S_F by ISO 6336")]
    if computed is not None:
        rows.append(
            FaceLoadFactor(
                "FE load distribution, load with K_A, K_gamma and K_v", computed,
                "deflection of teeth and bodies; misalignment, shafts and flank modifications of the case",
                "manufacturing deviations, running-in", "S_H, S_F with the FE load distribution",
            )
        )  # fmt: skip
    return tuple(rows)


def _method(alignment: Alignment) -> str:
    return "ISO 6336-1, method C" if alignment.face_load_factor is None else "operation.face_load_factor"


def _counted(alignment: Alignment) -> tuple[str, str]:
    """Included and left out by that of ISO 6336."""
    if alignment.face_load_factor is not None:
        return "as specified", ""
    if alignment.deformation is not None:
        shaft = "pinion shaft (f_sh as specified)" if alignment.deformation else ""
    else:
        shaft = "pinion shaft (shaft calculation)" if alignment.computed is not None else "pinion shaft (formula)"
    counted = [shaft, "manufacturing deviations (f_ma)", f"flank modification: {alignment.modification}", "running-in"]
    left_out = ["deflection of the wheel, its shaft and the housing"] if alignment.computed is None else []
    return ", ".join(filter(None, counted)), ", ".join([*([] if shaft else ["pinion shaft"]), *left_out])
