"""Bearings of a REXS model that prints of them what catalogues do: dimensions and load ratings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, inline, quantity, text
from fegear.exchange.rexs.said import RIGID
from fegear.shafts.axial_factors import ribs_of
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import envelope_of, plain_designation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.said import Said
    from fegear.shafts.designations import Envelope
    from fegear.shafts.printed_bearing import Kind

#: Parts of the types of bearings, by the kind whose inside can be estimated; the first that is found counts.
_KINDS: tuple[tuple[str, Kind | None], ...] = (
    ("axial", None), ("spherical_roller", "spherical"), ("spherical", None), ("self_aligning", None), ("needle", None),
    ("toroidal", None), ("four_point", None), ("tapered_roller", "tapered"), ("roller", "cylindrical"),
    ("ball", "ball"),
)  # fmt: skip


#: Contact angles that differ by less are one [rad].
_SAME_ANGLE = 1e-6


@dataclass(frozen=True, slots=True)
class Printed:
    """A bearing by what catalogues print.

    Parameters
    ----------
    bearing : CatalogueBearing
    designation : str
        With these dimensions; empty where none is known.
    """

    bearing: CatalogueBearing
    designation: str = ""

    @property
    def locates(self) -> bool:
        """Whether its ribs (NUP) or two rows of rollers hold a shaft both ways."""
        return self.bearing.inside.aligning or ribs_of(plain_designation(self.designation)) is not None


@dataclass(frozen=True, slots=True)
class _Size:
    """Kind, d, D and B [m] of a bearing; its designation and the envelope of that, if they are the same."""

    kind: Kind
    bore: float
    outside_diameter: float
    width: float
    designation: str = ""
    known: Envelope | None = None


def printed_bearing(said: Said, one: Component, rows: Sequence[Component], clearance: float) -> Printed | None:
    """What a model prints of a bearing that it holds for rigid; a note where no inside can be estimated from it.

    Parameters
    ----------
    said : Said
    one : Component
    rows : sequence of Component
        Rows of the bearing, if the model has them.
    clearance : float
        Diametral [m].
    """
    radial = said.number(one, "stiffness", "radial_stiffness")
    if not one.type.startswith("rolling_bearing") or (radial is not None and radial < RIGID):
        return None
    count = said.number(one, "number", "number_of_bearing_rows") or 1.0
    size = _size(said, one)
    if size is None or said.yes(one, "radial_force_absorption") is False:
        return None
    kind = size.kind
    if (count > 1.0 or len(rows) > 1) and kind != "spherical":
        return None
    angle = said.number(rows[0], "angle", "pressure_angle") if rows else None
    slope = said.number(one, "number", "catalogue_value_e")
    rolls = kind in ("tapered", "spherical")
    if rolls and not angle and slope:
        angle = math.atan(slope / 1.5)  # ISO 281: e = 1.5 tan(alpha)
    angular = "angular_contact" in (said.word(one, "bearing_type") or "") or (
        kind == "ball" and size.known is not None and size.known.contact_angle > 0.0
    )
    if (rolls or angular) and not angle and size.known is not None:
        angle = size.known.contact_angle
    if angular and not angle:
        return None
    c = said.number(one, "force", "radial_dynamic_load_rating", "dynamic_capacity")
    c_0 = said.number(one, "force", "radial_static_load_rating", "static_load_rating", "static_capacity")
    made_angle = abs(angle) if angle and (rolls or angular) else None
    try:
        made = CatalogueBearing(
            kind, size.bore, size.outside_diameter, size.width, c or None, c_0 or None, made_angle, clearance
        )
        _ = made.inside
    except InputError as error:
        said.notes.append(f"{one.said}: rolling elements not estimated; {error}")
        return None
    return Printed(made, size.designation)


def _size(said: Said, one: Component) -> _Size | None:
    """Kind, d, D and B as the model says, else of its designation."""
    spoken = said.word(one, "bearing_type") or ""
    kind = next((kind for part, kind in _KINDS if part in spoken), None)
    bore, outside, width = (
        said.number(one, "length", *names)
        for names in (("inner_diameter", "bore_diameter"), ("outer_diameter",), ("width",))
    )
    named = said.word(one, "catalogue_designation") or plain_designation(said.word(one, "name") or one.name)
    known = _designated(named)
    if known is not None and spoken and (
        kind != known.kind or (kind == "ball" and ("angular_contact" in spoken) != bool(known.contact_angle))
    ):  # fmt: skip
        known = None
    if not (kind and bore and outside and width):
        if known is None:
            return None
        kind, bore = known.kind, bore or known.bore
        outside, width = outside or known.outside_diameter, width or known.width
    if known is None or not known.has(bore, outside, width):
        return _Size(kind, bore, outside, width)
    return _Size(kind, bore, outside, width, named.strip(), known)


def _designated(name: str) -> Envelope | None:
    try:
        return envelope_of(name)
    except InputError:
        return None


def catalogue_keys(printed: Printed, about: str) -> list[Key]:
    """``designation`` of a case with what it does not say, else all in ``catalogue``.

    Parameters
    ----------
    printed : Printed
    about : str
        Where dimensions come from.
    """
    one, angle = printed.bearing, printed.bearing.contact_angle
    designated = bool(printed.designation)
    if designated and angle and abs(angle - envelope_of(printed.designation).contact_angle) < _SAME_ANGLE:
        angle = None
    rated = None if designated else one.dynamic_rating  # beside a designation that of `life` is enough
    said = {
        "dynamic_rating": quantity(rated, "kN") if rated else None,
        "static_rating": quantity(one.static_rating, "kN") if one.static_rating else None,
        "contact_angle": quantity(angle, "deg") if angle else None,
        "clearance": quantity(one.clearance, "um") if one.clearance else None,
    }
    if not designated:
        envelope = {
            "kind": text(one.kind), "bore": quantity(one.bore, "mm"),
            "outside_diameter": quantity(one.outside_diameter, "mm"), "width": quantity(one.width, "mm"),
        }  # fmt: skip
        return [Key("catalogue", inline(**envelope, **said), about)]
    keys = [Key("designation", text(printed.designation), "dimensions agree; rolling elements estimated")]
    return [*keys, Key("catalogue", inline(**said), "of the model")] if any(said.values()) else keys
