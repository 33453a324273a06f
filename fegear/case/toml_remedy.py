"""What to change in a line that is no TOML: values without quotes, and other words for true and false."""

from __future__ import annotations

import re

#: Without a better one.
_USUAL = "quantities with a unit must be quoted"
_LINE = re.compile(r"at line (\d+)")
#: The last key of a line and what stands behind it, up to a comment.
_GIVEN = re.compile(r"(?:^|[{,])\s*([\w.-]+)\s*=\s*([^\s\"'\[{#,}=][^\"'\[{#,}]*?)\s*(?=[,}#]|$)")
_TRUTH = {"true": "true", "yes": "true", "on": "true", "false": "false", "no": "false", "off": "false"}
_NUMBER = re.compile(r"[-+]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?$")
#: Values that need no quotes.
_BARE = re.compile(r"true$|false$|[-+]?(?:inf|nan)$|\d{4}-\d\d-\d\d|\d\d:\d\d")


def toml_remedy(text: str, error: Exception) -> str:
    """What to change where a case is no TOML.

    Parameters
    ----------
    text : str
    error : Exception
        Of the reader; it names the line.
    """
    found = _LINE.search(str(error))
    lines = text.splitlines()
    if found is None or not 0 < int(found[1]) <= len(lines):
        return _USUAL
    for key, value in _GIVEN.findall(lines[int(found[1]) - 1]):
        if value.lower() in _TRUTH and not _BARE.match(value):
            return f"set {key} = {_TRUTH[value.lower()]}"
        if not (_NUMBER.match(value) or _BARE.match(value)):
            kind = "quantities with a unit" if value[0].isdigit() or value[0] in "+-." else "texts"
            return f'set {key} = "{value}" ({kind} must be quoted)'
    return _USUAL
