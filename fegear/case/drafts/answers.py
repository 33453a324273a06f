"""What is asked before a case is drafted: questions, their defaults, and answers that have been checked."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from fegear.base.errors import InputError
from fegear.base.unit_text import plain_number
from fegear.base.units import to_si
from fegear.case.drafts.first_size import face_for, module_for
from fegear.case.drafts.kinds import KINDS, STAGES, THREE_STAGES, TWO_STAGES
from fegear.case.nearest import nearest
from fegear.geometry.rack import BasicRack

#: Line load that is assumed where no torque is given [N/m]: what case-hardened gears carry for ever.
_LINE_LOAD = 200e3
#: Share of it on the first stage of each kind: the last one has about as much as one of a single stage.
_FIRST_STAGE = {TWO_STAGES: 0.5, THREE_STAGES: 0.35}


#: Face width that is assumed, in modules.
_FACE = 10.0


#: Kinds whose gears are helical.
HELICAL = ("helical", *STAGES)


#: Kinds whose driven gear may be a ring gear.
_WITH_RING = ("pair", "relief")


#: Answer to a question about what a drawing need not have.
_NONE = "none"
#: What only an option gives, although it has a value otherwise: requirements, not of the drawing.
_UNASKED = ("life",)


#: Between both ends of a range of torques; the first end may leave the unit to the second.
_BETWEEN = re.compile(r"\s*(?:\.\.\.?|…|–|\bto\b)\s*")


class Question(NamedTuple):
    """A question.

    Attributes
    ----------
    name : str
        Of the answer, and of the option that gives it.
    prompt : str
    default : str
    dimension : str
        Of the quantity; "teeth", "numbers" or "rack" for what is none.
    ranges : bool
        Whether it may be a range, "120 to 320 N m".
    ring : bool
        Whether the last number of teeth may be negative: a ring gear.
    """

    name: str
    prompt: str
    default: str
    dimension: str
    ranges: bool = False
    ring: bool = False

    @property
    def optional(self) -> bool:
        """Whether a drawing need not have it: an option gives it, the terminal does not ask."""
        return self.default == _NONE or self.name in _UNASKED


#: How the module is asked for, where that is of one stage only.
_MODULES = dict.fromkeys((TWO_STAGES, THREE_STAGES), "Normal module of the first stage")
#: Teeth that are asked for where there are more than those of a pinion and its wheel.
_TEETH = {
    "planetary": ("Teeth of sun and planet", "25 29"),
    TWO_STAGES: ("Teeth of both pinions and wheels", "21 53 19 61"),
    THREE_STAGES: ("Teeth of all pinions and wheels", "21 101 20 63 21 52"),
}

#: Speed of the pinion that is assumed, also for the torque of a power.
ASSUMED_SPEED = "1500 rpm"

_ALL = {
    "pressure_angle": ("Pressure angle", "20 deg", "angle"),
    "profile_shift": ("Profile shift x", "0", "numbers"),
    "rack": ("Basic rack, ISO 53 A to D", "C", "rack"),
    "helix_angle": ("Helix angle", "20 deg", "angle"),
    "speed": ("Speed of the pinion", ASSUMED_SPEED, "speed"),
    "life": ("Required life of gears and bearings", "20000 h", "time"),
    "tip_relief": ("Tip relief of both gears, at the tip", _NONE, "length"),
    "relief_length": ("Length of the relief along the line of action", _NONE, "length"),
    "lead_error": ("Helix deviation over the face width", _NONE, "length"),
}


@dataclass(frozen=True, slots=True)
class Answers:
    """Checked answers, as texts; what no one gave is assumed, and said to be.

    Parameters
    ----------
    kind : str
    given : mapping of str to str
        Answers by the name of their question.
    suited : mapping of str to str
        In place of defaults: a module with which bodies have room.
    """

    kind: str
    given: Mapping[str, str]
    suited: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse what cannot be read, or has no meaning for this kind."""
        if self.kind not in KINDS:
            raise InputError("--kind", f'"{self.kind}"', "is an unknown kind of case", nearest(self.kind, KINDS))
        if self.kind == "ring":
            _refuse_pair(self.given)
        asked = {question.name: question for question in self._questions}
        for name, text in self.given.items():
            if name not in asked:
                raise InputError(
                    _option(name), f'"{text}"', f'is not used for a case of kind "{self.kind}"', "remove it"
                )
            check(asked[name], len(KINDS[self.kind].gears), text, stages=self.kind == "gearbox")
        if self.has("lead_error") and not self.helical:
            told = f'"{self["lead_error"]}"'
            raise InputError("--lead-error", told, "requires a helical pair", "specify --helix-angle, or remove it")
        if self.internal and self.helical:
            told = f'"{self["helix_angle"]}"'
            raise InputError("--helix-angle", told, "is not drafted for a ring gear", "remove it")
        if self.has("tip_relief") != self.has("relief_length"):
            told = f'"{self["tip_relief"]}" over "{self["relief_length"]}"'
            raise InputError("--tip-relief", told, "must have both amount and length", 'for example "20 um" "4 mm"')

    def __getitem__(self, name: str) -> str:
        """Return an answer, given or assumed."""
        known = self.given.get(name) or self.suited.get(name)
        return known or next(q.default for q in self._questions if q.name == name)

    @property
    def _questions(self) -> list[Question]:
        return questions(self.kind, {**self.suited, **self.given})

    def assumed(self, name: str) -> bool:
        """Whether no one gave it."""
        return not self.given.get(name)

    def has(self, name: str) -> bool:
        """Whether the drawing has it: a question of this kind, and not answered by "none"."""
        return name in {q.name for q in self._questions} and self[name] != _NONE

    @property
    def helical(self) -> bool:
        """Whether the gears are helical: always, or where an angle is given."""
        return self.kind in HELICAL or (self.kind == "relief" and self.has("helix_angle"))

    @property
    def internal(self) -> bool:
        """Whether the driven gear is a ring gear, whose number of teeth is negative."""
        return self.numbers("teeth")[-1].startswith("-")

    @property
    def sized(self) -> bool:
        """Whether module and face width follow from a given torque."""
        return self.kind in STAGES and self.assumed("module") and not self.assumed("torque")

    @property
    def rounded(self) -> bool:
        """Whether profile shifts make centre distances whole: of a gearbox for a torque, where none are given."""
        return self.kind in STAGES and self.assumed("profile_shift") and not self.assumed("torque")

    def numbers(self, name: str) -> list[str]:
        """The numbers of an answer, one for each gear: two are those of each stage, else the last one is repeated."""
        found, gears = _split(self[name]), len(KINDS[self.kind].gears)
        if len(found) == 2:
            found *= STAGES.get(self.kind, 1)
        return (found + found[-1:] * gears)[:gears]

    def si(self, name: str) -> float:
        """An answer that is a quantity, in SI; of a range its upper end."""
        question = next(q for q in self._questions if q.name == name)
        return to_si((ends(self[name]) or (self[name],))[-1], question.dimension, _option(name))


def with_torque_of_power(given: Mapping[str, str]) -> dict[str, str]:
    """Answers with the torque of a power at the speed, where a power is given.

    Raises
    ------
    InputError
        If a torque is given, too, or is a power.
    """
    found = dict(given)
    if (power := found.pop("power", None)) is None:
        if _is_power(torque := found.get("torque", "")):
            raise InputError("--torque", f'"{torque}"', "is a power", f'use --power "{torque}"')
        return found
    if "torque" in found:
        raise InputError("--power", f'"{power}"', "contradicts --torque", "remove one of them")
    watts, speed = to_si(power, "power", "--power"), found.get("speed", ASSUMED_SPEED)
    turning = to_si(speed, _ALL["speed"][2], "--speed")
    for option, text, size in (("--power", power, watts), ("--speed", speed, turning)):
        if not size > 0.0:
            raise InputError(option, f'"{text}"', "must be positive")
    found["torque"] = f"{watts / turning:.6g} N*m"
    return found


def _is_power(text: str) -> bool:
    try:
        to_si(text, "power", "--power")
    except InputError:
        return False
    return True


def kind_of(kind: str | None, given: Mapping[str, str]) -> str:
    """The kind of case that answers are for: by the numbers of teeth, where none or a gearbox is asked for.

    Parameters
    ----------
    kind : str or None
    given : mapping of str to str
        Answers by the name of their question.
    """
    gears = len(_split(given.get("teeth", "")))
    if kind in (None, "gearbox"):
        for several in (TWO_STAGES, THREE_STAGES):
            if gears == len(KINDS[several].gears):
                return several
    return kind or ("helical" if given.get("helix_angle") else "gear" if gears == 1 else "pair")


def questions(kind: str, given: Mapping[str, str]) -> list[Question]:
    """Questions of a kind, in order; defaults follow what has been answered.

    Parameters
    ----------
    kind : str
        A name in `KINDS`.
    given : mapping of str to str
        Answers so far, all of them readable.

    Returns
    -------
    list of Question
    """
    several = len(KINDS[kind].gears) > 1
    found = [
        Question(
            "teeth",
            *(
                _TEETH.get(kind, ("Teeth of pinion and wheel", "21 53"))
                if several
                else ("Teeth", "60" if kind == "ring" else "28")
            ),
            "teeth",
            ring=kind in _WITH_RING,
        ),
        Question(
            "module",
            _MODULES.get(kind, "Normal module" if kind in HELICAL else "Module"),
            _module(kind, given),
            "length",
        ),
    ]
    module = _readable(given.get("module", found[1].default), "length")
    face = f"{_face(kind, given, module) * 1e3:.3g} mm"
    for name in KINDS[kind].asks:
        if name == "face_width":
            found.append(Question(name, "Face width", face, "length"))
        elif name == "torque":
            width = _readable(given.get("face_width", face), "length")
            radius = 0.5 * module * (plain_number((_split(given.get("teeth", "21")) or ["21"])[0]) or 21.0)
            default = f"{float(f'{_line_load(kind) * width * radius:.2g}'):g} N*m"
            ranges = kind == "relief"
            prompt = 'Torque on the pinion, or a range ("120 to 320 N m")' if ranges else "Torque on the pinion"
            found.append(Question(name, prompt, default, "torque", ranges))
        else:
            prompt, default, dimension = _ALL[name]
            default = _NONE if name == "helix_angle" and kind not in HELICAL else default
            plural = "s of pinion and wheel" if several and dimension == "numbers" else ""
            plural = "s of all gears" if plural and STAGES.get(kind, 1) > 1 else plural
            found.append(Question(name, prompt + plural, default, dimension))
    return found


def _line_load(kind: str) -> float:
    return _FIRST_STAGE.get(kind, 1.0) * _LINE_LOAD


def _module(kind: str, given: Mapping[str, str]) -> str:
    """The module that is assumed: of a gearbox that for its torque, where there is one."""
    torque = _readable(given.get("torque", ""), "torque")
    if kind not in STAGES or not torque > 0.0:
        return "3 mm"
    teeth = plain_number((_split(given.get("teeth", "21")) or ["21"])[0]) or 21.0
    return f"{module_for(torque, int(teeth)) * 1e3:.6g} mm"


def _face(kind: str, given: Mapping[str, str], module: float) -> float:
    """The face width that is assumed [m]: of a gearbox whose module follows from its torque what that needs."""
    torque = _readable(given.get("torque", ""), "torque")
    if kind not in STAGES or "module" in given or not torque > 0.0:
        return _FACE * module
    teeth = plain_number((_split(given.get("teeth", "21")) or ["21"])[0]) or 21.0
    return face_for(torque, int(teeth), module)


def ends(text: str) -> tuple[str, str] | None:
    """Both ends of a range, as in "120 to 320 N m" and "120 N m..320 N m"; None for a single quantity."""
    found = _BETWEEN.split(text.strip())
    if len(found) != 2 or not all(found):
        return None
    first, last = found
    return (f"{first} {last.lstrip('+-.0123456789eE').strip()}".strip() if _number(first) else first), last


def _numbers(gears: int, stages: bool) -> str:
    """How many numbers of teeth a case takes; of gearboxes by stages."""
    return "2, 4 or 6 numbers (one to three stages)" if stages else f"{gears} number{'s' * (gears > 1)}"


def check(question: Question, gears: int, text: str, *, stages: bool = False) -> None:
    """Refuse an answer that cannot be read.

    Parameters
    ----------
    question : Question
    gears : int
        How many gears the case has.
    text : str
    stages : bool, optional
        Whether more gears are those of more stages.

    Raises
    ------
    InputError
    """
    key = _option(question.name)
    if question.dimension == "teeth":
        *others, last = _split(text) or [""]
        if any(re.fullmatch(r"-[0-9]{1,9}", part) for part in (others if question.ring else [*others, last])):
            rule = "must be positive"
            raise InputError(key, f'"{text}"', rule, "for a ring gear use --kind relief or pair, and 31 -97")
        last = last.removeprefix("-") if question.ring else last
        if not all(re.fullmatch(r"[0-9]{1,9}", part) for part in (*others, last)):
            raise InputError(key, f'"{text}"', "must be whole numbers", "for example 21 53")
        if len(_split(text)) != gears:
            raise InputError(key, f'"{text}"', f"must be {_numbers(gears, stages)}, one for each gear")
    elif question.dimension == "numbers":
        if not 1 <= len(_split(text)) <= gears or not all(_number(part) for part in _split(text)):
            raise InputError(key, f'"{text}"', f"must be at most {gears} numbers", "for example 0.3")
    elif question.dimension == "rack":
        BasicRack.named(text)
    elif text != question.default:
        both = [to_si(end, question.dimension, key) for end in _allowed(question, text)]
        if both[0] <= 0.0:
            raise InputError(key, f'"{text}"', "must be greater than zero")
        if len(both) > 1 and both[0] >= both[1]:
            raise InputError(key, f'"{text}"', "must rise", "write the smaller torque first")


def _allowed(question: Question, text: str) -> tuple[str, ...]:
    """A quantity, or both ends of a range where the kind takes one."""
    both = ends(text) if question.dimension == "torque" else None
    if both and not question.ranges:
        key = _option(question.name)
        raise InputError(key, f'"{text}"', "must be one torque", "a range requires --kind relief")
    return both or (text,)


def _refuse_pair(given: Mapping[str, str]) -> None:
    """Refuse what a ring gear alone has not, and point to the kinds that have a pinion, too."""
    teeth = [one.removeprefix("-") for one in _split(given.get("teeth", ""))]
    name = "teeth" if len(teeth) > 1 else "torque"
    if name not in given or not all(one.isdecimal() for one in teeth):
        return
    both = f"{teeth[0]} -{teeth[1]}" if len(teeth) > 1 else f"21 -{(teeth or ['66'])[0]}"
    rule = "is of a pair; --kind ring is a ring gear without its pinion"
    raise InputError(_option(name), f'"{given[name]}"', rule, f"use --kind relief, or pair, with --teeth {both}")


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _split(text: str) -> list[str]:
    return [part for part in re.split(r"[\s;/]+", text.strip()) if part]


def _number(text: str) -> bool:
    return re.fullmatch(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?", text) is not None


def _readable(text: str, dimension: str) -> float:
    """A quantity in SI, or not a number where it cannot be read: `Answers` then says why."""
    try:
        return to_si(text, dimension)
    except InputError:
        return math.nan
