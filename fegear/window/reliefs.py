"""Changes of a case's text by the hands on its reliefs: parts that move, gears that get a name of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.window.case_text import literal, value_at, with_value

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.window.case_text import Path

#: Other ways to say where a relief starts and how much it removes.
_OTHERWISE = ("start_radius", "length", "normalised_length", "amount_over_delta")
#: Keys of a gear that modify its flanks.
_MODIFIED = {"relief", "lead", "bias", "topography"}


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
    table: Path = ("gear", gear, "relief", end)
    new = {"amount": f"{amount:.2f} um"} | ({} if end == "crowning" else {"start_roll_angle": f"{start:.3f} deg"})
    if isinstance(value_at(document, table), list):
        table = (*table, str(index))
    for key, value in new.items():
        text = with_value(text, (*table, key), f'"{value}"')
    for key in _OTHERWISE:
        if end != "crowning":
            text = with_value(text, (*table, key), None)
    return with_value(text, ("effects", "relief"), "true")


def without_relief(text: str, document: Mapping[str, Any], gear: str) -> str:
    """The text of a case with a gear without relief, and without the effect where no flank is modified any more.

    Raises
    ------
    InputError
        If the text cannot be changed there.
    """
    left = {name: {key for key in one if name != gear or key != "relief"} for name, one in document["gear"].items()}
    text = with_value(text, ("gear", gear, "relief"), None)
    if any(keys & _MODIFIED for keys in left.values()) or any(
        "modification" in one for one in document["pair"].values()
    ):
        return text
    return with_value(text, ("effects", "relief"), None)


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
