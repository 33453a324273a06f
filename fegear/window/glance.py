"""What stands at one glance: small pictures that follow what is moved, and the numbers an engineer decides by.

What a page was left with is kept for each case beside what it has unsaved: no part of the case, but of its window.
"""

from __future__ import annotations

import contextlib
import json
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.base.errors import FegearError, InputError
from fegear.base.printed import rounded
from fegear.case.json_file import read_json
from fegear.case.text_file import write_file
from fegear.engine.plan import make_plan
from fegear.engine.stage import Task
from fegear.output.numbers import plain_number, pretty_unit
from fegear.output.report.blocks import value_cells
from fegear.results.catalogue import STAGES
from fegear.window.journal import journal_folder, stem_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.engine.value import Value


class Picture(NamedTuple):
    """A small picture: what it is called, the stage that makes its figure, that figure's key, its panel, of what."""

    words: str
    stage: str
    key: str
    panel: int = 1
    of: str = "pair"


#: What the column on the right may show, by name; keys are followed by the name of the pair, or of the set.
PICTURES = {
    "te": Picture("Transmission error", "transmission-error", "transmission_error_"),
    "sharing": Picture("Tooth pair load", "load-sharing", "load_sharing_"),
    "root": Picture("Root stress", "root-stress-history", "root_stress_history_"),
    "harmonics": Picture("Harmonics", "transmission-error", "transmission_error_harmonics_"),
    "pressure": Picture("Contact pressure", "load-sharing", "load_sharing_", 2),
    "stiffness": Picture("Mesh stiffness", "transmission-error", "transmission_error_", 2),
    "line-load": Picture("Load distribution over face width", "load-distribution", "load_over_face_"),
    "pattern": Picture("Contact pattern", "contact-pattern", "contact_pattern_"),
    "planet-loads": Picture("Planet load sharing", "planet-load-sharing", "planet_load_sharing_", of="set"),
    "set-te": Picture("Transmission error, planetary set", "planet-load-sharing", "planet_load_sharing_", 2, of="set"),
    "set-forces": Picture("Radial forces", "planet-load-sharing", "planet_forces_", of="set"),
}
#: What may be shown of the stress inside the teeth.
MEASURES = ("mises", "tension", "pressure", "none")
#: What it shows where nobody has chosen: of plane pairs, of those with a width, and of planetary sets.
USUAL, USUAL_WIDE = ("te", "sharing", "root", "harmonics"), ("te", "line-load", "root", "harmonics")
USUAL_SET = ("planet-loads", "set-te", "set-forces")

#: The numbers of the strip by the end of a value's name, in their order, and how they are called.
NUMBERS = {
    "te_peak_to_peak": "transmission error, p-p",
    "unloaded_te_peak_to_peak": "unloaded transmission error, p-p",
    "K_gamma": "K_gamma, planet load sharing",
    "mesh_stiffness_mean": "mesh stiffness, mean",
    "driver.largest_root_tension": "root stress, driver",
    "driven.largest_root_tension": "root stress, driven",
    "largest_hertz_pressure": "contact pressure",
    "driver.S_F": "S_F, driver",
    "driven.S_F": "S_F, driven",
    "driver.S_H": "S_H, driver",
    "driven.S_H": "S_H, driven",
}
#: Digits that a person reads, and the share of a value from which its error is shown without being asked for.
_READ, _ROUGH = 4, 5e-3
#: The stages that these come from beside the ones that are shown; a rating is asked for by the case.
_ALWAYS = ("transmission-error", "load-sharing", "root-stress-history", "planet-load-sharing", "shaft-deflection")


def keys_of(pictures: tuple[str, ...]) -> set[str]:
    """Keys of the figures that the small pictures are made of, without the pair's name, by names of `PICTURES`."""
    return {PICTURES[one].key for one in pictures or (*USUAL, *USUAL_WIDE, *USUAL_SET) if one in PICTURES}


def glance_tasks(scene: Scene, pictures: tuple[str, ...]) -> list[Task]:
    """What has to be computed for the numbers and the small pictures, as far as the case can have it.

    Parameters
    ----------
    scene : Scene
    pictures : tuple of str
        Names of `PICTURES` that are chosen; none for the usual ones.
    """
    usual = USUAL_WIDE if scene.wide_pairs else USUAL
    shown = [PICTURES[one].stage for one in pictures or usual if one in PICTURES]
    names = dict.fromkeys((*_ALWAYS, *shown))
    stages = {stage.name: stage for stage in STAGES if stage.name in names}
    # Numbers of a pair with a width stand in its load over the face, too: load sharing is drawn where it is looked at.
    spared = "load-sharing" if "load-distribution" in shown and "load-sharing" not in shown else ""
    return [
        Task(name, one)
        for name in names
        for one in stages[name].subjects(scene)
        if not (name == spared and one in scene.wide_pairs)
    ]


def field_tasks(scene: Scene) -> list[Task]:
    """What has to be computed for the stress inside the teeth, of pairs whose gears are solved by finite elements."""
    found = (one for one in scene.plane_pairs if scene.case.pair[one].compliance.source == "fe")
    return [Task("stress-inside", name) for name in found]


def crack_tasks(scene: Scene) -> list[Task]:
    """What has to be computed for the picture of cracked teeth, of gears in plane pairs."""
    found = (scene.case.pair[one] for one in scene.plane_pairs if scene.case.pair[one].compliance.source == "fe")
    meshed = {gear for part in found for gear in (part.driver, part.driven)}
    return [Task("crack-shown", gear) for gear in STAGES.called("crack-shown").subjects(scene) if gear in meshed]


def plan_with(scene: Scene, beside: list[Task], more: list[Task]) -> Plan:
    """The plan of a case with what is shown on request, and what of the glance it can have.

    Raises
    ------
    FegearError
        If the case or what is shown on request cannot be had.
    """
    try:
        return make_plan(scene, STAGES, [*beside, *more])
    except FegearError:
        possible = []
        for task in beside:
            with contextlib.suppress(FegearError):  # the case does not ask for it; its place on the page stays empty
                make_plan(scene, STAGES, [task])
                possible.append(task)
        return make_plan(scene, STAGES, [*possible, *more])


def numbers_of(values: tuple[Value, ...]) -> dict[str, dict[str, Any]]:
    """The values of a task that stand in the strip, by their names.

    Returns
    -------
    dict
        ``value``, ``text`` and ``error`` with all digits (empty where it is not known), ``short`` as a person reads it,
        ``rough`` where the error is worth a look, ``unit``, ``label`` and ``subject``.
    """
    found = {}
    for value in values:
        subject, _, name = value.name.partition(".")
        if name not in NUMBERS:
            continue
        text, error = value_cells(value)
        known = error not in ("exact", "not estimated")
        found[value.name] = {
            "value": value.value, "text": text if known else plain_number(value.value, 4),
            "error": error if known else "", "short": _short(value),
            "rough": known and (value.error or 0.0) > _ROUGH * abs(value.value),
            "unit": pretty_unit(value.unit), "label": NUMBERS[name],
            "subject": subject, "name": name,
        }  # fmt: skip
    return found


def _short(value: Value) -> str:
    return plain_number(float(rounded(value.value, value.error, _READ).partition(" ")[0]), _READ)


#: Characters of a question of the lecturer's own: what has room in its line.
LONGEST_QUESTION = 300


class View(NamedTuple):
    """How a page was left.

    Attributes
    ----------
    pictures : tuple of str
        Names of `PICTURES`; none for the usual ones.
    measure : str
        Of the stress inside the teeth, one of `MEASURES`.
    folded : bool
        Whether the form is out of the way.
    report : bool
        Whether all results are shown in place of the glance.
    middle : str
        What stands in the middle: a pair, ``set NAME`` or ``gearbox``; empty for the usual.
    large : bool
        Whether type is large, for a room.
    exercise : bool
        Whether answers are hidden until they are asked for, anew after each change.
    digits : bool
        Whether numbers have all digits and their errors.
    revealed : bool
        Whether they have been asked for since; not kept for the next time.
    question : int
        Number of the question that is asked.
    words : str
        A question of the lecturer's own in its place; empty for none.
    circles : bool
        Whether pitch, base and tip circles are drawn at gears in mesh.
    """

    pictures: tuple[str, ...] = ()
    measure: str = "mises"
    folded: bool = False
    report: bool = False
    middle: str = ""
    large: bool = False
    exercise: bool = False
    digits: bool = False
    revealed: bool = False
    question: int = 0
    words: str = ""
    circles: bool = False

    def changed(self, told: Mapping[str, Any]) -> View:
        """The same with what a page says; what is none of its values stays."""
        new = {name: told[name] for name in self._fields if isinstance(told.get(name), type(getattr(View(), name)))}
        if isinstance(told.get("pictures"), list):
            new["pictures"] = tuple(one for one in told["pictures"] if isinstance(one, str) and one in PICTURES)
        if new.get("measure") not in MEASURES:
            new.pop("measure", None)
        if "words" in new:
            new["words"] = " ".join(new["words"].split())[:LONGEST_QUESTION].rstrip()
        return self._replace(**new)


def told_of_view(view: View) -> dict[str, Any]:
    """What a page that opens has to know: how it was left, and what may be chosen."""
    return {
        "view": view._asdict(), "numbers": list(NUMBERS),
        "usual": {"plane": USUAL, "wide": USUAL_WIDE, "set": USUAL_SET},
        "pictures": {name: one._asdict() for name, one in PICTURES.items()},
    }  # fmt: skip


def read_view(case: Path | None) -> View:
    """How the page of a case file, or of cases without one, was left; the usual view where nothing is known."""
    with contextlib.suppress(InputError):
        return View().changed(read_json(_place(case), "view"))._replace(revealed=False)
    return View()


def keep_view(case: Path | None, view: View) -> None:
    """Keep it for the next time; a folder that cannot be written to keeps nothing."""
    with contextlib.suppress(OSError, InputError):
        place = _place(case)
        place.parent.mkdir(parents=True, exist_ok=True)
        write_file(place, json.dumps(view._asdict()).encode(), "view")


def _place(case: Path | None) -> Path:
    return journal_folder() / "views" / f"{stem_of(case)}.json"
