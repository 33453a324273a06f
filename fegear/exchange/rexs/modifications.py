"""Flank modifications of REXS 1.3 and later as ``relief`` and ``lead`` of a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from fegear.exchange.case_tables import Key, inline, listed, quantity, text

if TYPE_CHECKING:
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.said import Said

End = Literal["I", "II"]
#: What a flank may refer to that a case has no key for.
_OTHERS = (
    "profile_slope", "profile_twist", "topographical_modification", "profile_deviation", "helix_deviation",
    "triangular_tip_relief", "triangular_root_relief",
)  # fmt: skip
#: Shapes of a relief that a case knows.
_SHAPES = ("linear", "parabolic")


def modification_keys(said: Said, gear: Component, flank: Component | None, far: End | None) -> list[Key]:
    """``relief`` and ``lead`` of a gear; what has no key is noted.

    Places over the face count from the datum face, at which coordinates are negative, to the other one, `far`. There
    a positive helix_slope removes material, which follows from results that its authors publish with a model: by the
    displacements of its shafts a gap of 14.1 um opens over a face of 74 mm toward the datum face, the load that is
    stated with it grows by 136 N/mm at 20 N/(mm um) toward the other, and a slope of 7 um is what is missing.
    """
    if flank is None:
        return []
    found = said.linked(flank, "origin", "reference", "referenced")
    for one in found:
        if one.type in _OTHERS:
            said.notes.append(f"{gear.said}: {one.said} not imported; add it to relief, lead or topography.")
    ends = {
        end: [made for one in found if one.type == f"{end}_relief" and (made := _end_relief(said, gear, one, end))]
        for end in ("tip", "root")
    }
    crowns = [
        inline(amount=quantity(amount, "um"))
        for one in found
        if one.type == "profile_crowning"
        and (amount := said.number(one, "length", "profile_crowning_at_tip", "profile_crowning_at_root"))
    ]
    parts = {"tip": ends["tip"], "root": ends["root"], "crowning": crowns}
    keys = []
    if any(parts.values()):
        value = inline(**{key: listed(values) if values else None for key, values in parts.items()})
        keys.append(Key("relief", value, "tip_relief, root_relief and profile_crowning of its flank"))
    lead: dict[str, str | None] = {}
    for one in found:
        if one.type == "helix_crowning":
            amount = said.number(
                one, "length", "helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"
            )
            lead["crowning"] = quantity(amount, "um") if amount else None
        elif one.type == "helix_slope":
            amount = said.number(one, "length", "helix_slope")
            lead["slope"] = quantity(-amount if far == "I" else amount, "um") if amount else None
    datum: End = "II" if far == "I" else "I"
    reliefs = [
        made
        for one in found
        for face, end in (("datum_face", datum), ("non_datum_face", far or "II"))
        if one.type == f"end_relief_{face}" and (made := _face_relief(said, gear, one, face, end))
    ]
    lead["end_relief"] = listed(reliefs) if reliefs else None
    if any(lead.values()):
        sided = lead.get("slope") or reliefs
        where = f"; datum face is end {datum} (zero of slopes)" if sided and far else ""
        if sided and not far:
            said.notes.append(f"{gear.said}: datum face not specified; end I assumed.")
        keys.append(Key("lead", inline(**lead), f"helix_crowning, helix_slope, end_relief of its flank{where}"))
    return keys


def _face_relief(said: Said, gear: Component, one: Component, face: str, end: End) -> str | None:
    """Relief at an end of the face by depth and length."""
    depth = said.number(one, "length", f"end_relief_depth_{face}")
    length = said.number(one, "length", f"end_relief_length_{face}")
    if not depth or not length:
        if depth:
            said.notes.append(f"{gear.said}: {one.said} without length ignored.")
        return None
    shape = _shape(said, gear, one)
    return inline(amount=quantity(depth, "um"), length=quantity(length, "mm"), end=text(end), shape=shape)


def _shape(said: Said, gear: Component, one: Component) -> str | None:
    shape = said.word(one, "shape_of_relief") or "linear"
    if shape not in _SHAPES:
        said.notes.append(f"{gear.said}: shape {shape} of {one.said} approximated as parabolic.")
        shape = "parabolic"
    return text(shape) if shape != "linear" else None


def _end_relief(said: Said, gear: Component, one: Component, end: str) -> str | None:
    """Tip or root relief by depth and the diameter where it starts."""
    depth = said.number(one, "length", f"{end}_relief_depth")
    start = said.number(one, "length", f"{end}_relief_datum_diameter")
    length = said.number(one, "length", f"{end}_relief_datum_length") if start is None else None
    if not depth:
        return None
    if not start and not length:
        said.notes.append(f"{gear.said}: {one.said} without start ignored.")
        return None
    return inline(
        amount=quantity(depth, "um"),
        start_radius=quantity(0.5 * start, "mm") if start else None,
        length=quantity(length, "mm") if length else None,
        shape=_shape(said, gear, one),
    )
