"""The known names, the nearest one first, for messages about unknown ones."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable

    from fegear.case.trade_words import Meaning


#: How alike two spellings must be, 0 to 1; more where one may type a word of the trade that is no misspelt key.
_ALIKE, _ALIKE_KEYS = 0.5, 0.65
#: Names that one sentence can list; of more the most similar ones.
_MOST, _SIMILAR = 50, 20


def nearest(
    name: str,
    known: Iterable[str],
    lists_all: str = "",
    words: Callable[[str, Collection[str]], Meaning | None] | None = None,
) -> str:
    """Return a remedy that says which known name is nearest to `name` if one is, and lists them or says what does.

    Parameters
    ----------
    name : str
    known : iterable of str
    lists_all : str
        What lists all of them, where they are too many for a sentence.
    words : callable, optional
        ``words(name, known)`` -> what a word of the trade means, which comes before its spelling.
    """
    names = sorted(known)
    listed = _listed(name, names) if names else "none is defined here"
    listed = f"{lists_all} lists all {len(names)}" if lists_all else listed
    meaning = words(name, names) if words else None
    if meaning is not None:
        return f"{meaning.remedy(names)}; {listed}"
    near = difflib.get_close_matches(name.lower(), names, n=1, cutoff=_ALIKE_KEYS if words else _ALIKE)
    return f'did you mean "{near[0]}"? {listed}' if near and len(names) > 1 else listed


#: Plurals that are no singular and an s.
_IRREGULAR = {"teeth": "tooth", "radii": "radius", "axes": "axis"}


def other_number(name: str, known: Iterable[str]) -> str:
    """The known name of which another one is the singular or the plural: `teeth` for `tooth`; empty where none is."""
    single = _singular(name)
    return next((one for one in known if one != name and _singular(one) == single), "")


def _singular(name: str) -> str:
    """A name with all its words in the singular."""
    return "_".join(map(_one_singular, name.lower().split("_")))


def _one_singular(word: str) -> str:
    if word in _IRREGULAR:
        return _IRREGULAR[word]
    if word.endswith("ies"):
        return f"{word[:-3]}y"
    return word[:-1] if word.endswith("s") and not word.endswith(("ss", "us", "is")) else word


def _listed(name: str, names: list[str]) -> str:
    """All names, or the most similar ones where they are too many for a sentence."""
    if len(names) <= _MOST:
        return f"known here: {', '.join(names)}"
    similar = sorted(difflib.get_close_matches(name.lower(), names, n=_SIMILAR, cutoff=0.0))
    return f"known here, the most similar of {len(names)}: {', '.join(similar)}"
