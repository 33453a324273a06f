"""Flank modifications of REXS 1.3 and later as ``relief`` and ``lead`` of a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.exchange.case_tables import Key, inline, listed, quantity, text

if TYPE_CHECKING:
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.said import Said

#: What a flank refers to and a case has a key for.
_KNOWN = ("tip_relief", "root_relief", "profile_crowning", "helix_crowning", "helix_slope")
#: What it may refer to besides.
_OTHERS = (
    "profile_slope", "profile_twist", "topographical_modification", "profile_deviation", "helix_deviation",
    "end_relief_datum_face", "end_relief_non_datum_face", "triangular_tip_relief", "triangular_root_relief",
)  # fmt: skip


def modification_keys(said: Said, gear: Component, flank: Component | None) -> list[Key]:
    """``relief`` and ``lead`` of a gear; what has no key is noted."""
    if flank is None:
        return []
    found = said.linked(flank, "origin", "reference", "referenced")
    for one in found:
        if one.type in _OTHERS:
            said.notes.append(f"{gear.said}: its {one.said} is not read; add it to relief, lead or topography.")
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
    lead = {}
    for one in found:
        if one.type == "helix_crowning":
            amount = said.number(
                one, "length", "helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"
            )
            lead["crowning"] = quantity(amount, "um") if amount else None
        elif one.type == "helix_slope":
            amount = said.number(one, "length", "helix_slope")
            lead["slope"] = quantity(amount, "um") if amount else None
    if any(lead.values()):
        also = "; positive taken to remove at end II: check the side" if lead.get("slope") else ""
        keys.append(Key("lead", inline(**lead), f"helix_crowning, helix_slope of its flank{also}"))
    return keys


def _end_relief(said: Said, gear: Component, one: Component, end: str) -> str | None:
    """Tip or root relief by depth and the diameter where it starts."""
    depth = said.number(one, "length", f"{end}_relief_depth")
    start = said.number(one, "length", f"{end}_relief_datum_diameter")
    length = said.number(one, "length", f"{end}_relief_datum_length") if start is None else None
    if not depth:
        return None
    if not start and not length:
        said.notes.append(f"{gear.said}: its {one.said} says not where it starts and is not used.")
        return None
    shape = said.word(one, "shape_of_relief") or "linear"
    if shape not in ("linear", "parabolic"):
        said.notes.append(f"{gear.said}: shape {shape} of its {one.said} is taken as parabolic.")
        shape = "parabolic"
    return inline(
        amount=quantity(depth, "um"),
        start_radius=quantity(0.5 * start, "mm") if start else None,
        length=quantity(length, "mm") if length else None,
        shape=text(shape) if shape != "linear" else None,
    )
