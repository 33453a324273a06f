"""One to three helical stages on parallel shafts in a row: modules, torques and speeds, places, shafts, bearings.

The wheel of a stage and the pinion of the next one turn together and have one hand, so that their axial forces are
against each other. The first stage is on the left, the last one in the middle of three: the shaft with the largest
torque has it between equal spans. The first shaft ends beside its pinion, in a wall within the housing. Teeth of small
pinions are cut into their shaft.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from fegear.base.units import from_si
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.first_size import MODULES, face_for, module_for
from fegear.case.drafts.kinds import STAGES
from fegear.case.drafts.placed_shafts import PlacedShaft, placed_shaft
from fegear.case.drafts.stage_sizes import (
    mesh_forces,
    pitch_radii,
    ratio_of,
    root_radii,
    shifts_for_distance,
    tip_radii,
)
from fegear.case.drafts.stiff_shafts import Ends, MeshOnShaft, stiff_diameters

#: Gap between faces, and between a face and a bearing [modules of the last stage].
_GAP, _CLEAR = 3.0, 2.0
#: Gap between a gear and a shaft beside it, and between bearings of neighbours [modules of the stage].
_APART = 1.0
#: Hole of a gear at most, in root radii; diameter of a shaft at most, over that of the root circle cut into it.
_HOLE, _WITHIN = 0.65, 0.95
#: Shear stress of a shaft below its torque [Pa]: bends it little enough.
_SHEAR = 25e6
#: Stages along the shafts from the left.
_ORDER = {1: (0,), 2: (0, 1), 3: (0, 2, 1)}


@dataclass(frozen=True)
class LaidOut:
    """What the case has besides its gears; lengths from the left end of all shafts [m].

    Parameters
    ----------
    stages : tuple of Answers
        Each as a gearbox of one stage.
    holes : tuple of float
        Radius of the hole of each gear [m].
    cut : tuple of bool
        Whether the teeth of each gear are cut into its shaft, which is thicker than that hole.
    distances : tuple of float
        Centre distances [m].
    middles : tuple of float
        Middle of each stage's faces.
    first : float
        Middle of the bearings at the left.
    last : tuple of float
        Of the bearing at the right of each shaft.
    clear : float
        Between a bearing and the face beside it.
    shafts : tuple of PlacedShaft
    """

    stages: tuple[Answers, ...]
    holes: tuple[float, ...]
    cut: tuple[bool, ...]
    distances: tuple[float, ...]
    middles: tuple[float, ...]
    first: float
    last: tuple[float, ...]
    clear: float
    shafts: tuple[PlacedShaft, ...]

    def seats(self, n: int) -> Ends:
        """Where the bearings of one of its shafts are."""
        return Ends(self.shafts[n].seat, 2.0 * self.first, (self.first, self.last[n]), self.clear)


def gears_on_shafts(stages: int) -> tuple[tuple[tuple[int, int], ...], ...]:
    """Stage and member (pinion 0, wheel 1) of the gears of each shaft."""
    wheels = [((stage, 1),) for stage in range(stages)]
    pinions = [((stage, 0),) for stage in range(stages)]
    return tuple(wheel + pinion for wheel, pinion in zip(((), *wheels), (*pinions, ()), strict=True))


def staged(answers: Answers) -> LaidOut:
    """Lay out all stages, each after the first with the least module that suits its torque and keeps bodies apart.

    Where no module has room it is that of the torque.

    Parameters
    ----------
    answers : Answers
    """
    least = [0.0] * STAGES[answers.kind]
    first = drafted = laid_out(_stages(answers, least))
    while (crowded := next((n for n in range(1, len(least)) if not _beside(drafted, n)), None)) is not None:
        tried = drafted.stages[crowded].si("module")
        larger = next((one for one in MODULES if one > 1.001e3 * tried), None)
        if larger is None:
            return first
        least[crowded] = larger
        drafted = laid_out(_stages(answers, least))
    return drafted


def with_room(answers: Answers) -> Answers:
    """Answers of a gearbox with the smallest module whose centre distances keep all bodies apart, if none is given.

    Bearings follow from forces and life: near a ratio of one they may need more than the gears do.

    Parameters
    ----------
    answers : Answers
    """
    if answers.rounded:
        answers = with_whole_distances(answers)
    if not answers.assumed("module"):
        return answers
    first = answers.si("module")
    for module in MODULES:
        if module < 0.999e3 * first:
            continue
        suited = {"module": f"{module:.6g} mm", "torque": answers["torque"]}
        made = replace(answers, suited=suited) if module > 1.001e3 * first else answers
        if made is not answers and answers.rounded:
            made = with_whole_distances(made)
        if _apart(staged(made)):
            return made
    return answers


def with_whole_distances(answers: Answers) -> Answers:
    """Answers with profile shifts that make all centre distances preferred ones, at least whole millimetres.

    Parameters
    ----------
    answers : Answers
    """
    bare = replace(answers, suited={**answers.suited, "profile_shift": "0"})
    shifts = [shift for stage in staged(bare).stages for shift in shifts_for_distance(stage)]
    return replace(answers, suited={**answers.suited, "profile_shift": " ".join(f"{one:.4f}" for one in shifts)})


def _apart(laid: LaidOut) -> bool:
    return all(_beside(laid, stage) for stage in range(len(laid.stages)))


def _beside(laid: LaidOut, stage: int) -> bool:
    """Whether shafts of a stage have room for bearings, the driven one also beside the wheel of the stage before."""
    ends = zip(laid.shafts[stage].bearings.values(), laid.shafts[stage + 1].bearings.values(), strict=True)
    needed = max(0.5 * (one.outside + other.outside) for one, other in ends)
    if stage:
        needed = max(needed, tip_radii(laid.stages[stage - 1])[1] + 0.5 * laid.shafts[stage + 1].thick)
    return laid.distances[stage] >= needed + _gap(laid, stage)


def laid_out(stages: tuple[Answers, ...]) -> LaidOut:
    """Places, shafts and bearings of one stage or several.

    Parameters
    ----------
    stages : tuple of Answers
    """
    radii = [pitch_radii(one) for one in stages]
    modules, faces = [one.si("module") for one in stages], [one.si("face_width") for one in stages]
    torques, speeds = [one.si("torque") for one in stages], [one.si("speed") for one in stages]
    torques.append(torques[-1] * ratio_of(stages[-1]))
    speeds.append(speeds[-1] / ratio_of(stages[-1]))
    clear, seats = _CLEAR * modules[-1], [(16.0 * torque / (math.pi * _SHEAR)) ** (1.0 / 3.0) for torque in torques]
    on, order = gears_on_shafts(len(stages)), _ORDER[len(stages)]
    roots = [list(root_radii(one)) for one in stages]
    width = 0.6 * max(seats)
    first, last = 0.0, [0.0] * len(on)
    middles = [0.0] * len(stages)
    shafts: tuple[PlacedShaft, ...] = ()
    for _ in range(3):  # forces follow the places, places the widths of bearings, and these the forces
        start = width + clear
        for stage in order:
            middles[stage] = start + 0.5 * faces[stage]
            start += faces[stage] + _GAP * modules[-1]
        first, last = 0.5 * width, [start - _GAP * modules[-1] + clear + 0.5 * width] * len(on)
        last[0] = middles[0] + 0.5 * faces[0] + clear + 0.5 * width
        forces = [mesh_forces(one, torque) for one, torque in zip(stages, torques, strict=False)]
        shafts = tuple(
            placed_shaft(
                seat, speed, 2.0 * min(roots[n][member] for n, member in gears),
                [(middles[n] - first, *forces[n], radii[n][member], -1.0 if member else 1.0) for n, member in gears],
                right - first, stages[0].si("life"),
            )
            for seat, speed, gears, right in zip(seats, speeds, on, last, strict=True)
        )  # fmt: skip
        width = max(one.width for shaft in shafts for one in shaft.bearings.values())
    made = LaidOut(stages, (), (), tuple(sum(one) for one in radii), tuple(middles), first, tuple(last), clear, shafts)
    shafts = _stiff(made, forces, radii, roots)
    thick = {gear: shaft.thick for shaft, gears in zip(shafts, on, strict=True) for gear in gears}
    below = [0.5 * thick[n, member] for n in range(len(stages)) for member in range(2)]
    most = [_HOLE * one for own in roots for one in own]
    cut = tuple(root < radius for radius, root in zip(below, most, strict=True))
    return replace(made, holes=tuple(map(min, below, most)), cut=cut, shafts=shafts)


def _stiff(
    laid: LaidOut,
    forces: Sequence[tuple[float, float, float]],
    radii: Sequence[tuple[float, float]],
    roots: Sequence[Sequence[float]],
) -> tuple[PlacedShaft, ...]:
    """Its shafts, as thick as their tilt at the meshes asks for and gears have room for."""
    placed, most = [], []
    for n, (gears, shaft) in enumerate(zip(gears_on_shafts(len(laid.stages)), laid.shafts, strict=True)):
        placed.append((
            [
                MeshOnShaft(
                    laid.middles[stage], *forces[stage], radii[stage][member], -1.0 if member else 1.0,
                    laid.stages[stage].si("face_width"),
                )
                for stage, member in gears
            ],
            laid.seats(n),
        ))  # fmt: skip
        room = min(2.0 * roots[stage][member] * (_HOLE if member else _WITHIN) for stage, member in gears)
        if n > 1:
            room = min(room, 2.0 * (laid.distances[n - 1] - tip_radii(laid.stages[n - 2])[1] - _gap(laid, n - 1)))
        most.append(max(room, shaft.thick))
    thick = stiff_diameters(placed, [one.thick for one in laid.shafts], most)
    return tuple(replace(one, thick=diameter) for one, diameter in zip(laid.shafts, thick, strict=True))


def _gap(laid: LaidOut, stage: int) -> float:
    return _APART * laid.stages[stage].si("module")


def _stages(answers: Answers, least: list[float]) -> tuple[Answers, ...]:
    """Answers of every stage, with modules of at least `least` [mm]."""
    found = [_first(answers)]
    for number in range(1, len(least)):
        found.append(_next(answers, found[-1], number, least[number]))
    return tuple(found)


def _kept(answers: Answers, number: int) -> dict[str, str]:
    """What a stage has of the answers of all, with its own teeth and shifts."""
    given = {key: text for key, text in answers.given.items() if key not in ("teeth", "profile_shift")}
    own = slice(2 * number, 2 * number + 2)
    return given | {name: " ".join(answers.numbers(name)[own]) for name in ("teeth", "profile_shift")}


def _first(answers: Answers) -> Answers:
    """Answers of the first stage."""
    known = {name: answers[name] for name in ("module", "torque", "speed", "face_width")}
    return Answers("gearbox", {**_kept(answers, 0), **known})


def _next(answers: Answers, before: Answers, number: int, least: float) -> Answers:
    """Answers of a further stage: torque of the wheel before it, a module of at least `least` [mm], a face."""
    ratio, module = ratio_of(before), before.si("module")
    grown = min(MODULES, key=lambda one: abs(math.log(one * 1e-3 / (module * ratio ** (1.0 / 3.0)))))
    grown = max(grown, module * 1e3, least)
    face, torque = before.si("face_width") * grown * 1e-3 / module, before.si("torque") * ratio
    if answers.sized:
        pinion = int(answers.numbers("teeth")[2 * number])
        grown = max(module_for(torque, pinion, max(module, least * 1e-3)) * 1e3, least)
        if answers.assumed("face_width"):
            face = face_for(torque, pinion, grown * 1e-3)
    return Answers("gearbox", {
        **_kept(answers, number), "module": f"{grown:.6g} mm", "face_width": f"{face * 1e3:.3g} mm",
        "torque": f"{torque:.6g} N*m", "speed": f"{before.si('speed') / ratio * from_si('rpm'):.6g} rpm",
    })  # fmt: skip
