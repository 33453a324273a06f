"""Mean mesh stiffness of a loaded 3D pair per face width beside c_gamma_alpha of ISO 6336-1.

Both are secants along the transverse line of action: what the flanks of a pair have under its load, where they touch,
and what the standard has for solid discs and contact over the whole face.
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
    """

    fe_error: float | None
    silent: str
    fe: float = shown("N/(mm.um)", "mean secant mesh stiffness per face width, 3D", name="c_gamma_fe")
    iso: float | None = shown("N/(mm.um)", "c_gamma_alpha of ISO 6336-1", name="c_gamma_iso")

    @property
    @shows("", "c_gamma_alpha of ISO 6336-1 / mean secant mesh stiffness per face width, 3D", name="c_gamma_iso_to_fe")
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
    error = None if e.shift is None else e.shift.stiffness / pair.face_width
    iso = None if found.value is None else found.value.mesh_alpha
    return IsoMeshStiffness(error, found.reason, e.mesh_stiffness_mean / pair.face_width, iso)


def said_beside_iso(seen: Seen) -> list[str]:
    """The ratio of both in a sentence, where the standard has its value."""
    one: IsoMeshStiffness | None = seen.data.iso
    if one is None or one.iso is None:
        return []
    both = f"{one.iso * 1e-9:.3g} N/(mm µm), mean mesh stiffness {one.fe * 1e-9:.3g} N/(mm µm) (secant)"
    return [f"Pair {seen.name}: c_gamma_alpha of ISO 6336-1 {both}: ratio {one.ratio:.2f}."]


ISO_VALUES = (
    Number("fe", "iso.fe_error", of="iso"),
    Number("iso", of="iso", when="iso.iso"),
    Number("ratio", "iso.ratio_error", of="iso", when="iso.iso"),
)
ISO_REMARK = Remark("Pair {name}: no c_gamma_alpha of ISO 6336-1: {d.iso.silent}.", when="iso.silent")
