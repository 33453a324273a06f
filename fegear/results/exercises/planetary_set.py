"""Questions on a planetary gear set: Willis, torques, assembly, forces of a planet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import FegearError
from fegear.case.built.planetary import set_inputs
from fegear.results.exercises.wording import DIGITS, RPM, Exercise, figures, mm, same

if TYPE_CHECKING:
    from fegear.case.built.planetary import SetInputs
    from fegear.case.reading import Scene


def exercises_of_set(scene: Scene, name: str) -> list[Exercise]:
    """Questions on a planetary gear set; none of one that cannot be assembled, for which the case is refused."""
    try:
        inputs = set_inputs(scene, name)
    except FegearError:
        return []
    return [_willis(inputs), _torques(inputs), _assembly(inputs), _planet_force(inputs)]


def _willis(inputs: SetInputs) -> Exercise:
    found, run = inputs.found, inputs.run
    u = found.ring_teeth / found.sun_teeth
    formulas = {
        ("sun", "carrier"): "1 + z_r/z_s", ("carrier", "sun"): "1 / (1 + z_r/z_s)", ("sun", "ring"): "−z_r/z_s",
        ("ring", "sun"): "−z_s/z_r", ("ring", "carrier"): "1 + z_s/z_r", ("carrier", "ring"): "1 / (1 + z_s/z_r)",
    }  # fmt: skip
    speed = ""
    if inputs.at_speed:
        turns = {one: figures(run.speed[one] * RPM, DIGITS) for one in (run.input, run.output)}
        speed = f", {turns[run.input]} rpm at the {run.input}, {turns[run.output]} rpm at the {run.output}"
    return Exercise(
        "Planetary gear set",
        "How large is the ratio of the set (Willis)?",
        f"(n_s − n_c) / (n_r − n_c) = −z_r/z_s = −{found.ring_teeth}/{found.sun_teeth} = {figures(-u, DIGITS)}. With "
        f"the {run.fixed} fixed: i = n_{run.input} / n_{run.output} = {formulas[run.input, run.output]} = "
        f"{figures(run.ratio, DIGITS)}{speed}.",
    )


def _torques(inputs: SetInputs) -> Exercise:
    found, run = inputs.found, inputs.run
    u = found.ring_teeth / found.sun_teeth
    shares = {"sun": 1.0, "ring": u, "carrier": -(1.0 + u)}
    unit = run.torque[run.input] / shares[run.input]
    ideal = ", ".join(f"{one} {figures(unit * share, DIGITS)} N m" for one, share in shares.items())
    real = ", ".join(f"{one} {figures(run.torque[one], DIGITS)} N m" for one in ("sun", "ring", "carrier"))
    losses = ""
    if not same(run.efficiency, 1.0):
        losses = f" fegear, with the losses of both meshes (efficiency {figures(run.efficiency, DIGITS)}): {real}."
    return Exercise(
        "Planetary gear set",
        "Which torques act on sun, ring and carrier?",
        f"T_s : T_r : T_c = 1 : z_r/z_s : −(1 + z_r/z_s) without losses: {ideal}, positive counter-clockwise; they "
        f"add up to zero.{losses}",
    )


def _assembly(inputs: SetInputs) -> Exercise:
    found = inputs.found
    teeth = found.sun_teeth + found.ring_teeth
    if found.evenly_spaced:
        first = f"(z_s + z_r) / N = {teeth}/{found.count} = {figures(teeth / found.count, DIGITS)} is an integer"
    else:
        first = f"Planets fit at integer multiples of 360° / (z_s + z_r) = {figures(360.0 / teeth, DIGITS)}°, as here"
    room = ""
    if found.count > 1:
        even = "180°/N" if found.evenly_spaced else "ψ/2"
        room = f"; tip circles of neighbours are 2 a sin({even}) − d_a = {mm(found.neighbour_clearance)} apart"
    return Exercise(
        "Planetary gear set",
        "Can the planets be assembled at these angles, and do neighbours touch?",
        f"Yes: {first[0].lower() if first.startswith('P') else first[0]}{first[1:]}{room}.",
    )


def _planet_force(inputs: SetInputs) -> Exercise:
    found = inputs.found
    radius = found.base_radius("sun") / math.cos(found.sun_angle)
    tangential = inputs.sun_torque / (found.count * radius)
    return Exercise(
        "Planetary gear set",
        "How large are the forces on one planet and its pin?",
        f"F_t = T_s / (N r_ws) = {figures(inputs.sun_torque, DIGITS)} N m / ({found.count} · {mm(radius)}) = "
        f"{figures(tangential, DIGITS)} N in each of its two meshes, F_t / cos α_w = "
        f"{figures(tangential / math.cos(found.sun_angle), DIGITS)} N along the line of action (sun); on the pin "
        f"2 F_t = {figures(2.0 * tangential, DIGITS)} N (spur planets, equal loads).",
        "K_gamma",
        "K_γ, the load of the most loaded planet over the mean, is {} in fegear (1: equal loads).",
    )
