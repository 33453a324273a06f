"""Hook of mkdocs: the prose writes symbols and numbers as the standards do, where case files and tables spell them.

K_Hβ for K_Hbeta, µm for um, 0.5 for .5.
Code, equations, links, comments and headings (whose anchors are linked to) stay as they are.
"""

from __future__ import annotations

import re

_LETTERS = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "varepsilon": "ε", "epsilon": "ε", "zeta": "ζ", "theta": "θ",
    "lambda": "λ", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "omega": "ω",
}  # fmt: skip
_NAME = "|".join(_LETTERS)
#: What is not prose: fenced blocks, headings, code in a line, equations, comments and tags, targets of links.
_OTHER = re.compile(
    r"^```.*?^```[^\n]*$|^#[^\n]*$|`[^`\n]*`|\$\$.*?\$\$|\$[^$\n]+\$|<!--.*?-->|<[^>\n]+>|\]\([^)\n]*\)",
    re.DOTALL | re.MULTILINE,
)
#: A symbol that is spelled: a Greek name before the underscore or at an end of what follows it.
_SYMBOL = re.compile(
    rf"(?<![\w/.-])(?:(?P<base>{_NAME})_(?P<below>[A-Za-z0-9]+)"
    rf"|(?P<latin>[A-Za-z]'?)_(?P<first>[A-Z]{{0,2}}|f)(?P<letter>{_NAME})(?P<rest>[A-Z][A-Za-z]*|[a-z]|_[a-z]+)?)(?![\w/]|-\w)"
)
#: Decimals without the zero before the point, and units without their own signs.
_PRINTED = (
    (re.compile(r"(?<![\w.)\]])\.(?=\d)"), "0."),
    (re.compile(r"\bum\b"), "µm"),
)


def with_letters(markdown: str) -> str:
    """A page whose spelled symbols have Greek letters, and whose numbers and units are written in one way."""
    made, end = [], 0
    for other in _OTHER.finditer(markdown):
        made += [_as_printed(markdown[end : other.start()]), other[0]]
        end = other.end()
    return "".join([*made, _as_printed(markdown[end:])])


def _as_printed(prose: str) -> str:
    for spelled, sign in _PRINTED:
        prose = spelled.sub(sign, prose)
    return _SYMBOL.sub(_lettered, prose)


def _lettered(symbol: re.Match[str]) -> str:
    if symbol["base"]:
        return f"{_LETTERS[symbol['base']]}_{_LETTERS.get(symbol['below'], symbol['below'])}"
    rest = symbol["rest"] or ""
    return f"{symbol['latin']}_{symbol['first']}{_LETTERS[symbol['letter']]}{_LETTERS.get(rest.lstrip('_'), rest)}"


def on_page_markdown(markdown, **_others):
    """Write symbols as the standards do."""
    return with_letters(markdown)
