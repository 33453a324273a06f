"""Mean mesh stiffness of a loaded pair per face width, by finite elements, beside c_gamma_alpha of ISO 6336-1.

Both are secants along the transverse line of action: what the flanks of a pair have under its load, where they touch,
and what the standard has for solid discs and contact over the whole face. The standard knows contact on the path only;
of plane (2D) pairs with contact outside it the mean without is compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from fegear.base.shown import shown, shows
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.sheet import Remark
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.formulas.outcome import attempt

if TYPE_CHECKING:
    from fegear.contact.error_over_pitch import ErrorOverPitch
    from fegear.engine.sheet.seen import Seen


@dataclass(frozen=True)
class IsoMeshStiffness:
    """Under the nominal load, without application factor.

    Parameters
    ----------
    fe, fe_error : float
        By finite elements, and its estimated error; None where none is known [Pa].
    iso : float or None
        c_gamma_alpha [Pa]; None where the standard gives none.
    silent : str
        Why it gives none.
    on_path : bool
        Whether contact outside the path of contact, which the pair has, is left out of `fe`.
    """

    fe_error: float | None
    silent: str
    on_path: bool
    fe: float = shown(
        "N/(mm.um)", "mean secant mesh stiffness per face width, finite elements, contact on the path of contact",
        name="c_gamma_fe",
    )  # fmt: skip
    iso: float | None = shown("N/(mm.um)", "c_gamma_alpha of ISO 6336-1", name="c_gamma_iso")

    @property
    @shows(
        "", "c_gamma_alpha of ISO 6336-1 / mean secant mesh stiffness per face width, finite elements",
        name="c_gamma_iso_to_fe",
    )  # fmt: skip
    def ratio(self) -> float | None:
        """Of both."""
        return None if self.iso is None else self.iso / self.fe

    @property
    def ratio_error(self) -> float | None:
        """Estimated: relatively that of the finite elements."""
        return None if self.ratio is None or self.fe_error is None else self.ratio * self.fe_error / self.fe


def iso_mesh_stiffness(e: ErrorOverPitch) -> IsoMeshStiffness:
    """Of the curves of a loaded pair."""
    pair = e.pair
    found = attempt(partial(pair_stiffness, pair, specific_load=pair.specific_load(e.load)))
    on_path = e.mesh_stiffness_on_path
    fe, error = e.mesh_stiffness_mean, None if e.shift is None else e.shift.stiffness
    if on_path is not None:
        fe, error = on_path, e.on_path_error
    iso = None if found.value is None else found.value.mesh_alpha
    return IsoMeshStiffness(
        None if error is None else error / pair.face_width, found.reason, bool(e.off_path_stiffens),
        fe / pair.face_width, iso,
    )  # fmt: skip


def said_beside_iso(seen: Seen) -> list[str]:
    """The ratio of both in a sentence, where the standard has its value."""
    one: IsoMeshStiffness | None = seen.data.iso
    if one is None or one.iso is None:
        return []
    contact = ", contact on the path only" if one.on_path else ""
    both = f"{one.iso * 1e-9:.3g} N/(mm µm), mean mesh stiffness {one.fe * 1e-9:.3g} N/(mm µm) (secant{contact})"
    return [f"Pair {seen.name}: c_gamma_alpha of ISO 6336-1 {both}: ratio {one.ratio:.2f}."]


ISO_VALUES = (
    Number("fe", "iso.fe_error", of="iso"),
    Number("iso", of="iso", when="iso.iso"),
    Number("ratio", "iso.ratio_error", of="iso", when="iso.iso"),
)
ISO_REMARK = Remark("Pair {name}: no c_gamma_alpha of ISO 6336-1: {d.iso.silent}.", when="iso.silent")
