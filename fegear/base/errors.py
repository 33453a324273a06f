"""What fegear says when it cannot go on: the value, the rule, the remedy."""

from __future__ import annotations

import errno
from itertools import islice
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

#: What the system says of a disk that takes no more: full, over a quota or a limit, failing, read-only.
NO_ROOM = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO})
#: How to install what only notebooks need.
NOTEBOOK_EXTRA = "install it with: pip install 'fegear[notebook]'"
#: Most characters of an input that a message repeats.
_SHOWN = 60
#: Most items of a list, and levels of lists in lists, that a message can show.
_ITEMS, _DEEP = 1000, 4
#: Most characters of a path that a message repeats: its end counts as much as its beginning.
PATH = 300
#: Most characters of a value, or of a rule that repeats one.
_LONGEST = 1000


def shown(value: object, most: int = _SHOWN) -> str:
    """Return an input as messages repeat it: on one line, texts in quotes, longer ones than `most` cut short."""
    try:
        text = value if isinstance(value, str) else _written(value)
    except ValueError:  # a whole number of thousands of digits
        text = f"(a {type(value).__name__} that cannot be written)"
    text = _one_line(text, most)
    return f'"{text}"' if isinstance(value, str) else text


def _written(value: object, depth: int = 0) -> str:
    """A value as a case file has it: lists, tables, texts and truth values of TOML; of long lists the beginning."""
    if isinstance(value, list | tuple | dict) and depth < _DEEP:
        some = [*islice(value, _ITEMS)]
        if isinstance(value, dict):
            return (
                "{}"
                if not some
                else "{ " + ", ".join(f"{key} = {_written(value[key], depth + 1)}" for key in some) + " }"
            )
        return f"[{', '.join(_written(one, depth + 1) for one in some)}]"
    if depth and isinstance(value, str):
        return f'"{value}"'
    if depth and isinstance(value, bool):
        return "true" if value else "false"
    return repr(value)


def _one_line(text: str, most: int) -> str:
    cut = text if len(text) <= most else f"{text[:most]}..."
    return "".join(sign if sign.isprintable() else " " for sign in cut)


def lacks_memory(problem: BaseException) -> bool:
    """Whether something failed since memory ended; while a library is loaded the system says so in words alone."""
    if isinstance(problem, MemoryError) or getattr(problem, "errno", None) == errno.ENOMEM:
        return True
    text = str(problem).lower()
    return "failed to map" in text or ("allocate memory" in text and "static tls" not in text)


class FegearError(Exception):
    """Base of every error that fegear raises on purpose; its text is meant for the user as it is."""


class InputError(FegearError):
    """An input breaks a rule.

    Parameters
    ----------
    key : str
        Where the value came from, as the user wrote it (``gear.a.teeth``).
    value : object
        The value received.
    rule : str
        The rule that it breaks, as a clause ("must be a whole number of at least 5").
    remedy : str, optional
        What to do instead, as a sentence fragment.
    """

    def __init__(self, key: str, value: object, rule: str, remedy: str = "") -> None:
        self.key, self.value, self.rule, self.remedy = key, value, rule, remedy
        # Names and values are the user's: whatever they are, the sentence stays one, on one line.
        said_of = _written(value) if isinstance(value, list | tuple | dict) else str(value)
        said = f"{_one_line(key, PATH)} = {_one_line(said_of, _LONGEST)}: {_one_line(rule, _LONGEST)}"
        super().__init__(said + (f"; {remedy}" if remedy else "") + ".")

    def under(self, prefix: str, names: Mapping[str, str] | None = None) -> InputError:
        """The same error of a part, under the key of the whole that the part belongs to.

        Parameters
        ----------
        prefix : str
            Where the part stands (``gear.a``); without one nothing changes but names.
        names : mapping of str to str, optional
            Keys that have another name there.
        """
        key = (names or {}).get(self.key, self.key)
        return type(self)(".".join(filter(None, (prefix, key))), self.value, self.rule, self.remedy)

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str, str]]:
        """Rebuild from the four parts, so that the error crosses process boundaries."""
        return (type(self), (self.key, self.value, self.rule, self.remedy))


class GeometryError(InputError):
    """A gear or a pair of gears that cannot exist as described."""


class RangeError(InputError):
    """An argument outside the range in which a formula or a method holds."""


class UnknownNameError(InputError, KeyError):
    """A name that nothing here has; the text names the nearest that there is."""

    def __str__(self) -> str:
        """Return the sentence, which `KeyError` would put in quotes."""
        return str(self.args[0])


class UnknownPlaceError(InputError, IndexError):
    """A number of a place where nothing is."""


class MissingLibraryError(FegearError):
    """A system library or an optional package is missing; the text names what to install."""


class ConvergenceError(FegearError):
    """An iteration did not reach its tolerance; the text says by how much and what to change."""
