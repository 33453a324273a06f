"""Changes of a case's text by the hands on its reliefs: parts that move, gears that get a name of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.window.case_text import literal, value_at, with_value

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Other ways to say where a relief starts and how much it removes.
_OTHERWISE = ("start_radius", "length", "normalised_length", "amount_over_delta")


def moved_relief(
    text: str, document: Mapping[str, Any], gear: str, end: str, start: float, amount: float, index: int = 0
) -> str:
    """The text of a case with one part of a relief elsewhere, or of another size; the others stay.

    Parameters
    ----------
    text : str
    document : mapping
        The same as plain tables.
    gear : str
    end : str
        ``tip``, ``root`` or ``crowning``.
    start : float
        Roll angle [deg]; a crowning keeps its ends.
    amount : float
        [um].
    index : int
        Which of several.

    Raises
    ------
    InputError
        If the text cannot be changed there.
    """
    table = ("gear", gear, "relief", end)
    new = {"amount": f"{amount:.2f} um"} | ({} if end == "crowning" else {"start_roll_angle": f"{start:.3f} deg"})
    several = value_at(document, table)
    if isinstance(several, list):
        parts = [dict(one) for one in several]
        parts[index] = {key: value for key, value in parts[index].items() if key not in _OTHERWISE} | new
        text = with_value(text, table, literal(parts))
    else:
        for key, value in new.items():
            text = with_value(text, (*table, key), f'"{value}"')
        for key in _OTHERWISE:
            if end != "crowning":
                text = with_value(text, (*table, key), None)
    return with_value(text, ("effects", "relief"), "true")


def own_name(text: str, document: Mapping[str, Any], pair: str) -> str:
    """The text with the driven gear of a pair as a gear of its own, where it was the driver as well.

    Raises
    ------
    InputError
        If the text cannot be changed there.
    """
    gears = document["gear"]
    gear = value_at(document, ("pair", pair, "driven"))
    name = next(n for n in (f"{gear}_driven", *(f"{gear}_driven_{i}" for i in range(2, 99))) if n not in gears)
    text = with_value(text, ("pair", pair, "driven"), literal(name))
    lines = [f"{key} = {literal(value)}" for key, value in gears[gear].items()]
    end = text if text.endswith("\n") else f"{text}\n"
    return "\n".join([f"{end}\n[gear.{name}]", *lines, ""])
