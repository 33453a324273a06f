"""Bearings of a REXS model that prints of them what catalogues do: dimensions and load ratings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import inline, quantity, text
from fegear.exchange.rexs.said import RIGID
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import envelope_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.said import Said
    from fegear.shafts.designations import Envelope
    from fegear.shafts.printed_bearing import Kind

#: Parts of the types of bearings, by the kind whose inside can be estimated; the first that is found counts.
_KINDS: tuple[tuple[str, Kind | None], ...] = (
    ("axial", None), ("spherical", None), ("self_aligning", None), ("needle", None), ("toroidal", None),
    ("four_point", None), ("tapered_roller", "tapered"), ("roller", "cylindrical"), ("ball", "ball"),
)  # fmt: skip


def printed_bearing(said: Said, one: Component, rows: Sequence[Component], clearance: float) -> CatalogueBearing | None:
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
    known = _dimensions(said, one)
    if known is None or count > 1.0 or len(rows) > 1 or said.yes(one, "radial_force_absorption") is False:
        return None
    kind, bore, outside, width = known
    angle = said.number(rows[0], "angle", "pressure_angle") if rows else None
    slope = said.number(one, "number", "catalogue_value_e")
    if kind == "tapered" and not angle and slope:
        angle = math.atan(slope / 1.5)  # ISO 281: e = 1.5 tan(alpha)
    angular = "angular_contact" in (said.word(one, "bearing_type") or "")
    if angular and not angle:
        return None
    c = said.number(one, "force", "radial_dynamic_load_rating", "dynamic_capacity")
    c_0 = said.number(one, "force", "radial_static_load_rating", "static_load_rating", "static_capacity")
    made_angle = abs(angle) if angle and (kind == "tapered" or angular) else None
    try:
        made = CatalogueBearing(kind, bore, outside, width, c or None, c_0 or None, made_angle, clearance)
        _ = made.inside
    except InputError as error:
        said.notes.append(f"{one.said}: rolling elements not estimated; {error}")
        return None
    return made


def _dimensions(said: Said, one: Component) -> tuple[Kind, float, float, float] | None:
    """Kind, d, D and B as the model says, else of its designation."""
    spoken = said.word(one, "bearing_type") or ""
    kind = next((kind for part, kind in _KINDS if part in spoken), None)
    bore, outside, width = (
        said.number(one, "length", *names)
        for names in (("inner_diameter", "bore_diameter"), ("outer_diameter",), ("width",))
    )
    if kind and bore and outside and width:
        return kind, bore, outside, width
    known = _designated(said.word(one, "catalogue_designation", "name") or one.name)
    if known is None or (spoken and kind != known.kind):
        return None
    return known.kind, bore or known.bore, outside or known.outside_diameter, width or known.width


def _designated(name: str) -> Envelope | None:
    try:
        return envelope_of(name)
    except InputError:
        return None


def catalogue_table(printed: CatalogueBearing) -> str:
    """``catalogue`` of a case."""
    rated, static, angle = printed.dynamic_rating, printed.static_rating, printed.contact_angle
    return inline(
        kind=text(printed.kind), bore=quantity(printed.bore, "mm"),
        outside_diameter=quantity(printed.outside_diameter, "mm"), width=quantity(printed.width, "mm"),
        dynamic_rating=quantity(rated, "kN") if rated else None,
        static_rating=quantity(static, "kN") if static else None,
        contact_angle=quantity(angle, "deg") if angle else None,
        clearance=quantity(printed.clearance, "um") if printed.clearance else None,
    )  # fmt: skip
