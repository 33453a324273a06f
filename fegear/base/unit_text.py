"""``number unit`` as engineers type it, taken apart: the number, and the unit in one spelling.

Nothing else is read: no sums, no fractions, no separators of thousands and no decimal comma, since what one reader
takes for 3.175 mm is 3175 mm to the next.
"""

from __future__ import annotations

import re

from fegear.base.errors import shown

#: Longest text that is looked at; no quantity needs as many characters.
_LONGEST = 100
_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_QUANTITY = re.compile(rf"({_NUMBER})(\s*)(.*)", re.DOTALL)
_FACTOR = r"[A-Za-z]+(?:\^-?[1-4])?"
_PRODUCT = rf"{_FACTOR}(?:\*{_FACTOR})*"
_UNIT = re.compile(rf"(?:1(?=/)|{_PRODUCT})(?:/(?:{_FACTOR}|\({_PRODUCT}\)))*")
_BELOW_THE_LINE = re.compile(rf"(?:1|{_PRODUCT})/{_FACTOR}\*.*")
_THOUSANDS = re.compile(r"([-+]?[0-9]{1,3}(?:[ ,'_\u00a0\u2009\u202f][0-9]{3})+(?:\.[0-9]+)?)\s*(\D.*|1\s*/.*)")
_DECIMAL_COMMA = re.compile(r"([-+]?[0-9]*),([0-9]+(?:[eE][-+]?[0-9]+)?)\s*([^0-9.,].*)?")
_FRACTION = re.compile(r"(?:([0-9]{1,6})\s+)?([0-9]{1,6})\s*/\s*([0-9]{1,6})\s*([A-Za-z].*)")
_SIGNS = str.maketrans({
    "\u00b5": "u", "\u03bc": "u",  # the micro sign and the Greek letter, which look alike
    "\u03b5": "strain",  # as in \u00b5\u03b5
    "\u00b7": "*", "\u22c5": "*", "\u00d7": "*",
    "\u00b0": " deg ", "\u2032": "'", "\u2033": '"',
    "\u2212": "-", "\u207b": "-", "\u00b9": "1", "\u00b2": "2", "\u00b3": "3", "\u2074": "4",
})  # fmt: skip


class UnreadableError(ValueError):
    """A text that is no ``number unit``, or a unit in no known form.

    Parameters
    ----------
    rule, remedy : str
        As those of an `InputError`.
    """

    def __init__(self, rule: str, remedy: str = "") -> None:
        self.rule, self.remedy = rule, remedy
        super().__init__(rule)


def plain_number(text: str) -> float | None:
    """A number as `split` reads it in front of a unit, or nan and inf; None for anything else."""
    stripped = text.strip()
    known = re.fullmatch(rf"{_NUMBER}|[-+]?(?:nan|inf|infinity)", stripped, re.IGNORECASE)
    return float(stripped) if known and len(stripped) <= _LONGEST else None


def split(text: str) -> tuple[float, str]:
    """Take ``number unit`` apart.

    Returns
    -------
    float, str
        The number, which may be infinite, and the unit as `canonical` spells it; empty without one.

    Raises
    ------
    UnreadableError
        If there is anything else in the text.
    """
    if len(text) > _LONGEST:
        raise UnreadableError(f"is longer than the {_LONGEST} characters that a quantity may have")
    stripped = text.strip().replace("\u2212", "-")
    match = _QUANTITY.fullmatch(stripped)
    if match is None or "," in stripped:
        raise _unreadable(stripped)
    number, blank, unit = match.groups()
    try:
        name = canonical(unit) if unit else ""
    except UnreadableError as error:
        raise _unreadable(stripped, error) from None
    if not blank and unit.startswith("/") and len(number) > 1 and number.endswith("1"):
        raise UnreadableError(
            f"is ambiguous: {number} {unit} or {number[:-1]} 1{unit}", f'write "{number} / {unit.strip("/ ")}"'
        )
    return float(number), name


def canonical(unit: str) -> str:
    """Return a unit in one spelling: ``N*m``, ``N/mm^2``, ``1/min``, ``N/(mm*um)``.

    Raises
    ------
    UnreadableError
        If it is not made of names, whole exponents and one kind of grouping.
    """
    text = re.sub(r"(?<=[A-Za-z])\.(?=[A-Za-z])", "*", unit.translate(_SIGNS).replace("**", "^")).strip()
    text = re.sub(r"\s*([*/^()])\s*", r"\1", text.replace("''", '"').replace("'", " arcmin").replace('"', " arcsec"))
    text = re.sub(r"\s+", "*", text.strip())
    text = re.sub(r"(?<=[A-Za-z])(-?[1-4])(?![0-9.])", r"^\1", text)
    if text.startswith("/"):
        text = f"1{text}"
    if _UNIT.fullmatch(text) is None:
        if _BELOW_THE_LINE.fullmatch(text):
            raise UnreadableError(f"is ambiguous: denominator unclear in {shown(unit)}", "use parentheses: N/(mm*um)")
        raise UnreadableError("is not a number and a unit")
    alone = re.fullmatch(r"([A-Za-z]+)\^-1", text)
    return f"1/{alone[1]}" if alone else text


def names(unit: str) -> list[str]:
    """Names in a canonical unit."""
    return re.findall(r"[A-Za-z]+", unit)


def _unreadable(text: str, why: UnreadableError | None = None) -> UnreadableError:
    """Say what is wrong with a text, and what was probably meant."""
    if match := _DECIMAL_COMMA.fullmatch(text):
        whole, decimals, unit = match.groups(default="")
        remedy = f'write "{whole or "0"}.{decimals} {unit}"'
        if whole.strip("+-0") and len(decimals) == 3 and len(whole.strip("+-")) <= 3:
            remedy += f', or "{whole}{decimals} {unit}" if the comma separates thousands'
        return UnreadableError("contains a comma", remedy)
    if match := _THOUSANDS.fullmatch(text):
        plain = re.sub(r"[^-+0-9.]", "", match[1])
        return UnreadableError("contains thousands separators", f'write "{plain} {match[2]}"')
    if match := _FRACTION.fullmatch(text):
        whole, above, below, unit = match.groups()
        if int(below):
            value = int(whole or 0) + int(above) / int(below)
            return UnreadableError("contains a fraction", f'write "{value:.9g} {unit}"')
    if "," in text:
        return UnreadableError("contains a comma", "use a decimal point and no thousands separator")
    return why or UnreadableError("must begin with a number")
