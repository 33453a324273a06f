"""A first size of a gearbox that nobody has drawn yet: teeth for a ratio, and a module for a torque.

Teeth are hunting (no common divisor in a mesh), so that each tooth meets all of its mates, unless the ratio of a single
stage would be off by more than 2 %. The first stages have the larger ratios, since their torques are the smaller; all
pinions have about as many teeth.

A ratio i is divided as Niemann and Winter (Maschinenelemente II; not verified against a printed source) have it: of two
stages the first one has 0.8 i^(2/3), of three 0.6 i^(4/7), and the second one 0.8 times the two thirds' power of the
rest, about 1.1 i^(2/7). Gears of equal K factor have about the least volume then: that of a stage is in proportion to
its torque times 1 + 1/u + u + u^2 (Willis, Lightest-weight gears, Product Engineering 34, 1963).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping

from fegear.base.errors import InputError
from fegear.base.printed import figures, percent
from fegear.case.drafts.kinds import KINDS, STAGES, THREE_STAGES, TWO_STAGES

#: Preferred modules of ISO 54 [mm].
MODULES = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0)
#: Teeth of pinions that are tried.
_PINIONS = range(17, 24)
#: Largest ratio of a stage of a gearbox, and of a single pair.
_STAGE, _PAIR = 6.0, 12.0
#: How far the ratio of hunting teeth may be off.
_HUNTING = 0.02
#: Teeth of pinions among equals: fewer need a larger module, more a wider face.
_USUAL = 21
#: What the first draft of case-hardened gears carries: line load over pinion diameter, and over module [Pa].
_FLANK, _ROOT = 3.3e6, 90e6
#: Face width: at least and at most so many modules, and pinion diameters at most.
_NARROWEST, _WIDEST, _LONGEST = 8.0, 19.0, 1.0
#: Ratio of the first of two stages over the two thirds' power of both, and how far it may be off; of three over the
#: power 4/7 of all.
_SPLIT, _OFF, _SPLIT_OF_THREE = 0.8, 0.08, 0.6
#: Ratios that several stages begin with.
_LEAST = {TWO_STAGES: 3.0, THREE_STAGES: 10.0}


def with_teeth_of_ratio(kind: str | None, given: Mapping[str, str]) -> tuple[str | None, dict[str, str], str]:
    """Answers with the teeth of a ratio, where a ratio is given.

    Parameters
    ----------
    kind : str or None
    given : mapping of str to str
        Answers by the name of their question, and ``ratio``.

    Returns
    -------
    tuple
        Kind (of two stages, where one does not suffice), answers, and what was chosen; empty without a ratio.

    Raises
    ------
    InputError
        If the ratio is no number, is beyond what stages of a gearbox have, or the teeth are given, too.
    """
    found = dict(given)
    if (text := found.pop("ratio", None)) is None:
        return kind, found, ""
    told = f'"{text}"'
    if "teeth" in found:
        raise InputError("--ratio", told, "contradicts --teeth", "remove one of them")
    single = kind is not None and kind not in _LEAST
    if kind is not None and single and (kind not in KINDS or len(KINDS[kind].gears) != 2 or kind == "planetary"):
        raise InputError("--ratio", told, f'is not used for a case of kind "{kind}"', "remove it")
    if not re.fullmatch(r"[0-9]+\.?[0-9]*(:1)?", text.strip()):
        raise InputError("--ratio", told, "must be a number", "for example 14")
    ratio = float(text.strip().removesuffix(":1"))
    least = _LEAST.get(kind or "", 1.0)
    if kind in (None, "gearbox") and ratio > _STAGE:
        kind = TWO_STAGES if ratio <= _STAGE**2 else THREE_STAGES
    stages = STAGES.get(kind or "gearbox", 0)
    most = _STAGE**stages if stages else _PAIR
    if not least <= ratio <= most:
        raise InputError(
            "--ratio", told, f"is outside {figures(least)} to {figures(most)}", _instead(kind, ratio, most)
        )
    teeth = {2: _two_stages, 3: _three_stages}.get(stages, _one_stage)(ratio)
    made = math.prod(teeth[1::2]) / math.prod(teeth[::2])
    off = percent(made / ratio - 1.0, signed=True)
    found["teeth"] = " ".join(map(str, teeth))
    return kind, found, f"Teeth {'/'.join(map(str, teeth))}: ratio {made:.5g} ({off} of {figures(ratio, 5)})"


def _instead(kind: str | None, ratio: float, most: float) -> str:
    """What to do about a ratio out of reach."""
    if kind in STAGES and ratio > _STAGE ** STAGES[THREE_STAGES]:
        return (
            f"draft three stages, at most {figures(_STAGE)} each, and type the fourth below them: two gears, pair IV "
            "with torque and speed of wheel 3, a shaft and two bearings"
        )
    if kind in _LEAST and not (kind == TWO_STAGES and ratio < most):
        return "use --kind gearbox, which chooses the number of stages"
    return "choose another ratio, or specify --teeth"


def _stages(ratio: float) -> Iterator[tuple[int, int]]:
    """Pinion and wheel of a stage with about this ratio."""
    for pinion in _PINIONS:
        nearest = round(pinion * ratio)
        yield from ((pinion, wheel) for wheel in range(max(pinion, nearest - 1), nearest + 2))


def _hunting(pinion: int, wheel: int) -> bool:
    return math.gcd(pinion, wheel) == 1


def _one_stage(ratio: float) -> tuple[int, ...]:
    def judged(teeth: tuple[int, int]) -> tuple[bool, float, tuple[int, int]]:
        off = abs(teeth[1] / teeth[0] / ratio - 1.0)
        return not (_hunting(*teeth) and off <= _HUNTING), round(off, 3), teeth

    return min(_stages(ratio), key=judged)


def _two_stages(ratio: float) -> tuple[int, ...]:
    split = min(max(_SPLIT * ratio ** (2.0 / 3.0), math.sqrt(ratio)), _STAGE)
    found = []
    for pinion in _PINIONS:
        for wheel in range(math.ceil(pinion * split * (1.0 - _OFF)), math.floor(pinion * split * (1.0 + _OFF)) + 1):
            if _hunting(pinion, wheel):
                others = _stages(ratio * pinion / wheel)
                found += [(pinion, wheel, *other) for other in others if _hunting(*other)]

    def judged(teeth: tuple[int, ...]) -> tuple[float, float, float, tuple[int, ...]]:
        first, second = teeth[1] / teeth[0], teeth[3] / teeth[2]
        usual = abs(teeth[0] - _USUAL) + abs(teeth[2] - _USUAL)
        return round(abs(first * second / ratio - 1.0), 3), usual, round(abs(first / split - 1.0), 2), teeth

    return min(found, key=judged)


def _three_stages(ratio: float) -> tuple[int, ...]:
    split = min(max(_SPLIT_OF_THREE * ratio ** (4.0 / 7.0), ratio ** (1.0 / 3.0)), _STAGE)
    found = [
        (pinion, wheel) for pinion, wheel in _stages(split) if _hunting(pinion, wheel) and wheel <= _STAGE * pinion
    ]

    def judged(teeth: tuple[int, int]) -> tuple[int, float, tuple[int, int]]:
        return abs(teeth[0] - _USUAL), abs(teeth[1] / teeth[0] / split - 1.0), teeth

    pinion, wheel = min(found, key=judged)
    return pinion, wheel, *_two_stages(ratio * pinion / wheel)


def module_for(torque: float, teeth: int, least: float = 0.0) -> float:
    """The smallest preferred module with which case-hardened flanks and roots of a pinion last [m].

    Parameters
    ----------
    torque : float
        [N m].
    teeth : int
    least : float, optional
        Module at least [m].
    """
    for one in MODULES:
        module = one * 1e-3
        if module > 0.999 * least and _face(torque, teeth, module) <= module * min(_WIDEST, _LONGEST * teeth):
            return module
    return MODULES[-1] * 1e-3


def face_for(torque: float, teeth: int, module: float) -> float:
    """Face width with which they last, in whole millimetres and no narrower than gears are [m].

    Parameters
    ----------
    torque : float
        [N m].
    teeth : int
    module : float
        [m].
    """
    return math.ceil(1e3 * max(_face(torque, teeth, module), _NARROWEST * module) - 1e-6) * 1e-3


def _face(torque: float, teeth: int, module: float) -> float:
    diameter = module * teeth
    return 2.0 * torque / diameter / min(_FLANK * diameter, _ROOT * module)
