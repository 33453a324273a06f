"""What pages have been told of the case on the desk, kept for pages that open later."""

from __future__ import annotations

from typing import Any

from fegear.window.computing import whole, with_gears
from fegear.window.on_gears import UNASKED

Content = dict[str, Any]
#: What is kept as it was said last, and told before what was found, and after it.
_BEFORE = ("plan", "hands", "assemblies", "harris", "pinned")
_AFTER = ("done", "designed", "compared", "outdated")


class Told:
    """What was said last of each kind, figures and values by their tasks, and what is shown at gears in mesh.

    Attributes
    ----------
    last : dict
        By kind.
    """

    def __init__(self) -> None:
        self.last: dict[str, Content] = {}
        self._found: dict[str, Content] = {}
        self._meshed: dict[tuple[str, str], Content] = {}

    def in_order(self, shows: tuple[tuple[str, str], ...]) -> list[tuple[str, Content]]:
        """All of it, as a page that opens now is told; of gears in mesh what is asked for (pair and kind) or always."""
        told = [(what, self.last[what]) for what in _BEFORE if what in self.last]
        for content in self._found.values():
            told.append(("found", {key: value for key, value in content.items() if key != "pictures"}))
            told += [("picture", picture) for picture in content.get("pictures", {}).values()]
        told += [("meshed", content) for key, content in self._meshed.items() if key[1] in UNASKED or key in shows]
        told += [(what, self.last[what]) for what in _AFTER if what in self.last]
        return told

    def keep(self, what: str, content: Content) -> None:
        """Remember what was said."""
        if what == "plan":
            self._found = {task: found for task, found in self._found.items() if task in content["tasks"]}
            gone = [
                key for key, mesh in self._meshed.items() if key[1] in UNASKED and mesh["task"] not in content["tasks"]
            ]
            for key in gone:
                del self._meshed[key]
        elif what == "found":
            self._found[content["task"]] = {**whole(content, self._found.get(content["task"])), "pictures": {}}
        elif what == "meshed":
            self._meshed[content["pair"], content["kind"]] = content
        elif what == "picture":
            self._found[content["task"]]["pictures"][content["key"]] = content
        if what in ("plan", "hands", "assemblies", "harris", "done"):
            self.last[what] = with_gears(content, self.last.get(what)) if what == "hands" else content

    def keep_pinned(self) -> None:
        """Keep what was found as that of variant A, which pages show beside what is found later."""
        found = [{key: value for key, value in kept.items() if key != "pictures"} for kept in self._found.values()]
        ratios = {
            f"{pair}.{name}": value
            for pair, one in self.last.get("hands", {}).get("pairs", {}).items()
            for name, value in ((one.get("mesh") or {}).get("ratios") or {}).items()
        }
        self.last["pinned"] = {"found": found, "ratios": ratios}
