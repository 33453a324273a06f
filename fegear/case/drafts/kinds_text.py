"""What surrounds the gears of a drafted case of some kinds: motor and machine, ring and planets, racks, studies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial

from fegear.case.drafts.answers import Answers
from fegear.case.drafts.gears_text import PER_WIDTH, texts_of
from fegear.case.drafts.shafts_text import amount, length
from fegear.case.text_file import toml_string

#: Height of a rack's reference line above its back, assumed [modules].
_RACK_HEIGHT = 9.0
_RACK_RELIEF = "tip_relief = {{ amount = {tip_relief}, length = {relief_length} }}"
_NO_RACK_RELIEF = '# tip_relief = { amount = "15 um", length = "2 mm" }'
#: Speeds of a train's motion, as shares of the given one.
_SLOWEST, _FASTEST = 0.5, 1.5
#: Inertia of motor and machine over that of the gear beside them, assumed.
_BODIES = 10.0
_STEEL = 7850.0
#: Backlash of a train's mesh, assumed [modules].
_BACKLASH = 0.05


def train_texts(answers: Answers) -> Mapping[str, str]:
    """Motor, shafts and machine of a size that suits the gears."""
    radii = [0.5 * answers.si("module") * int(teeth) for teeth in answers.numbers("teeth")]
    inertia = [_BODIES * 0.5 * math.pi * _STEEL * answers.si("face_width") * radius**4 for radius in radii]
    millimetres = partial(amount, unit="mm")
    speed = answers.si("speed")
    return {
        "torque": answers["torque"],
        "backlash": amount(_BACKLASH * answers.si("module"), "um"),
        "motor_inertia": f"{inertia[0]:.3g} kg*m^2",
        "load_inertia": f"{inertia[1]:.3g} kg*m^2",
        "shaft_length": millimetres(8.0 * radii[0]),
        "input_diameter": millimetres(1.2 * radii[0]),
        "output_diameter": millimetres(1.2 * radii[0] * (radii[1] / radii[0]) ** (1.0 / 3.0)),
        "slowest": amount(_SLOWEST * speed, "rpm"),
        "fastest": amount(_FASTEST * speed, "rpm"),
    }


def planetary_texts(answers: Answers) -> Mapping[str, str]:
    """A ring that suits, and as many planets as stand evenly between the teeth, three if they do."""
    sun, planet = map(int, answers.numbers("teeth"))
    module, face, both = answers.si("module"), answers.si("face_width"), sun + planet
    shift = max(0.0, float(answers.numbers("profile_shift")[1]))
    tip = planet + 2.0 + 2.0 * shift
    fit = [n for n in (3, 4, 5, 2) if 2 * both % n == 0 and both * math.sin(math.pi / n) > tip]
    planets = next(iter(fit), 1)
    radius = 0.5 * both * module
    carrier = math.pi * _STEEL * face * radius**2
    speed, stiffness = answers.si("speed"), PER_WIDTH * face
    torque, at = (toml_string(answers[key]) for key in ("torque", "speed"))
    return {
        "ring_teeth": str(sun + 2 * planet),
        "planets": str(planets),
        "set_torque": torque,
        "set_speed": at,
        "slowest": amount(_SLOWEST * speed, "rpm"),
        "fastest": amount(_FASTEST * speed, "rpm"),
        "ring_mesh": amount(stiffness, "N/um"),
        "pin": amount(0.5 * stiffness, "N/um"),
        "carrier_mass": f"{carrier:.3g} kg",
        "carrier_inertia": f"{0.5 * carrier * radius**2:.3g} kg*m^2",
        "pin_errors": ", ".join(['"20 um"', *['"0 um"'] * (planets - 1)]),
    }


def study_texts(answers: Answers) -> Mapping[str, str]:
    """Numbers of teeth and shifts of a study."""
    teeth, shift = int(answers.numbers("teeth")[0]), float(answers.numbers("profile_shift")[0])
    return {
        "study_teeth": str(sorted({17, 20, 28, 50, 100, teeth})),
        "study_shift": str(sorted({0.0, 0.3, shift})),
    }


def rack_texts(answers: Answers) -> Mapping[str, str]:
    """A rack of usual height, with the relief of the pinion."""
    module, relieved = answers.si("module"), answers.has("tip_relief")
    texts = texts_of(answers, ("torque", "tip_relief", "relief_length") if relieved else ("torque",))
    return {
        "reference_height": length(_RACK_HEIGHT * module),
        "backlash": amount(_BACKLASH * module, "um"),
        "torque": texts["torque"],
        "torque_note": ", assumed" if answers.assumed("torque") else "",
        "rack_relief": _RACK_RELIEF.format(**texts) if relieved else _NO_RACK_RELIEF,
        "rack_relief_effect": "relief = true     # on: tip relief of pinion and rack" if relieved
        else "# relief = true     # off: for a pinion with relief or a rack with tip_relief",
    }  # fmt: skip
