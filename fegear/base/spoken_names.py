"""Identifiers of values as people say them: ``I.te_mean`` is "transmission error, mean"."""

from __future__ import annotations

import re

#: Words of identifiers, and what people say.
_WORDS = {
    "te": "transmission error,", "fe": "FE", "largest": "maximum", "highest": "maximum", "smallest": "minimum",
    "lowest": "minimum", "least": "minimum", "rms": "RMS", "iso": "ISO", "agma": "AGMA", "hertz": "Hertzian",
    "fm0": "FM0", "fm4": "FM4", "m6a": "M6A",
}  # fmt: skip
_PHRASES = {
    "root tension": "root stress, tension side",
    "root compression": "root stress, compression side",
    "mesh stiffness min ordinary": "minimum mesh stiffness of ordinary teeth",
    "mesh stiffness min": "minimum mesh stiffness",
    "mesh force max ordinary": "maximum mesh force in an ordinary base pitch",
    "mesh stiffness loss": "reduction of the mesh stiffness",
    "mesh force max": "maximum mesh force",
    "dynamic transmission error, change max": "maximum change of the dynamic transmission error",
    "dynamic transmission error, residual max": "maximum residual of the dynamic transmission error",
    "transmission error, residual max": "maximum residual of the transmission error",
}
#: Of drawn populations: the last word, where no tooth is numbered.
_SHARES = {"50": "median", "95": "95th percentile"}
#: Identifiers that are symbols: S_H, c_self, K_Hbeta.
_SYMBOL = re.compile(r"(?:[A-Za-z]|sigma|eps|mu|kappa)_\w+|[A-Z]\w?")


def spoken(name: str) -> str:
    """What a value is, in words of its identifier; empty where that is a symbol, which its meaning explains.

    Parameters
    ----------
    name : str
        ``"I.driver.largest_root_tension"``: subject, parts, what it is.

    Returns
    -------
    str
        ``"driver: maximum root stress, tension side"``.
    """
    _, *parts = name.split(".") if "." in name else ("", name)
    return "" if _SYMBOL.fullmatch(parts[-1]) else ": ".join(map(_said, parts))


def _said(part: str) -> str:
    *words, last = part.split("_")
    if words and last in _SHARES and words[-1] != "tooth":
        return f"{_said('_'.join(words))}, {_SHARES[last]}"
    said = " ".join(_WORDS.get(word, word) for word in (*words, last)).rstrip(",")
    for phrase, better in _PHRASES.items():
        said = said.replace(phrase, better)
    return said
