"""What a page has been told already, so that it is told again only what has become different."""

from __future__ import annotations

import json
from typing import Any

_Content = dict[str, Any]


class Sent:
    """What was sent last, by task; a figure that is the same again travels as its key alone."""

    def __init__(self) -> None:
        self._figures: dict[tuple[str, str], str] = {}
        self._empty: set[str] = set()

    def news(self, content: _Content) -> _Content | None:
        """What of a task's results is different from what was sent last; None where it has nothing to show, again.

        Parameters
        ----------
        content : dict
            Of ``found``; `whole` is the reverse.
        """
        if not (content["figures"] or content["values"] or content["loads"]):
            if content["task"] in self._empty:
                return None
            self._empty.add(content["task"])
        else:
            self._empty.discard(content["task"])
        figures = []
        for one in content["figures"]:
            place, text = (content["task"], one["key"]), json.dumps(one)
            figures.append({"key": one["key"], "same": True} if self._figures.get(place) == text else one)
            self._figures[place] = text
        return {**content, "figures": figures}

    def forget_others(self, tasks: list[str]) -> None:
        """Forget what is on the page no longer."""
        self._figures = {place: text for place, text in self._figures.items() if place[0] in tasks}
        self._empty &= set(tasks)


def whole(content: _Content, before: _Content | None) -> _Content:
    """Results of a task with all figures, the same ones from what was known before."""
    known = {one["key"]: one for one in (before or {}).get("figures", ())}
    figures = [known[one["key"]] if one.get("same") else one for one in content["figures"]]
    return {**content, "figures": figures}
