"""Papers and standards that results rest on, with the equations that were used.

A source is named for the effects that are on and the compliances that were chosen, not for all that fegear could do.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fegear.case.reading import Scene

    Cites = Callable[[Scene, str], Iterable["Citation"]]


@dataclass(frozen=True)
class Work:
    """A paper, a book or a standard."""

    key: str
    authors: str
    year: int
    published: str
    title: str = ""

    @property
    def short(self) -> str:
        """``Mark 1982``, ``Lin and others 1987``, ``ISO 6336-3:2006``."""
        if self.authors.startswith("ISO"):
            return f"{self.authors}:{self.year}"
        if self.authors.startswith("AGMA"):
            return self.authors
        names = [name.rsplit(" ", 1)[-1] for name in self.authors.removesuffix(" and others").split(", ")]
        if len(names) > 2 or self.authors.endswith(" and others"):
            return f"{names[0]} and others {self.year}"
        return f"{' and '.join(names)} {self.year}"

    @property
    def full(self) -> str:
        """``W. D. Mark (1982): The Transfer ... NASA Contractor Report 3626.``."""
        return f"{self.authors} ({self.year}): {f'{self.title}. ' if self.title else ''}{self.published}."


class Citation(NamedTuple):
    """A source of a stage: which work, where in it, and what for."""

    key: str
    what: str
    where: str = ""


@cache
def bibliography() -> dict[str, Work]:
    """All works, by key."""
    listed = resources.files("fegear.engine").joinpath("bibliography.toml").read_text("utf-8")
    return {key: Work(key, **entry) for key, entry in tomllib.loads(listed).items()}


def citing(*citations: Citation) -> Cites:
    """Sources that do not depend on the case, as `Stage.cites`."""
    return lambda _scene, _subject: citations
