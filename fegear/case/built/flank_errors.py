"""What a case says of the errors of a pair over its face: shafts, the pinion's cutting, and whatever a table holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, distinct
from fegear.base.errors import InputError
from fegear.case.built.shafts import gearbox_of, on_shafts
from fegear.case.csv_file import read_columns
from fegear.case.part import at
from fegear.contact.wide.shaft_gaps import RIGID
from fegear.contact.wide_spec import Misalignment
from fegear.geometry.shaft_tilt import ShaftTilt

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.geometry.flank_modification import FlankModification


#: Points of a crowned line error: between them its chords are off by 2e-7 of the crowning, less than any spot is flat.
_POINTS = 1025


def flank_errors(scene: Scene, name: str) -> Misalignment:
    """Collect the errors of a pair.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for, or an error is no small one.
    """
    z, gap = _line_gap(scene, name)
    part, pair = scene.case.pair[name].misalignment, scene.pairs[name]
    # With the effect on, the shafts' gaps are solved together with the flanks; without it these say what it would do.
    apart = on_shafts(scene, name) and not scene.case.effects.misalignment
    shafts = RIGID
    if apart:
        from fegear.contact.wide.on_shafts import gaps_of_even_loads

        shafts = gaps_of_even_loads(gearbox_of(scene), name)
    if part is None:
        return Misalignment(z, gap, shafts=shafts)
    prefix = f"pair.{name}.misalignment"
    try:
        tilt = ShaftTilt(*part.deviation(pair))
        angle = part.angle_of_lead(pair.driver)
        cutting: tuple[FlankModification, ...] = ()
        if part.profile_angle or angle:
            from fegear.contact.unloaded.manufacture import CutRemoval

            cutting = (CutRemoval(pair.driver, part.profile_angle, angle),)
            cutting[0].removal(0.5, 0.0)  # refuses a cut that leaves no flank
    except InputError as error:
        names = {"in_plane": "driven.in_plane", "out_of_plane": "driven.out_of_plane"}
        raise at(prefix, error, names if part.driver or part.driven else {"out_of_plane": "shaft_angle"}) from None
    return Misalignment(z, gap, tilt, cutting, part.centre_distance, shafts)


def cutter_modification(scene: Scene, name: str) -> tuple[FlankModification, ...]:
    """What `modification` of a pair takes off the pinion: the cutter's parabola and the lengthwise crown.

    Raises
    ------
    InputError
        If it leaves no flank, or no crown can absorb what the pair's errors do.
    """
    part, pair = scene.case.pair[name].modification, scene.pairs[name]
    if part is None or not (part.parabola or part.crown or part.absorb):
        return ()
    from fegear.contact.unloaded.manufacture import CutRemoval
    from fegear.contact.unloaded.predesign import absorb_linear_error

    try:
        crown = part.crown_coefficient(pair.driver)
        if part.absorb:
            crown = absorb_linear_error(scene.case.pair[name].rigid(pair, scene.case.effects.misalignment)).crown
        found = CutRemoval(pair.driver, parabola=part.parabola, crown=crown)
        found.removal(0.5, 0.0)
    except InputError as error:
        raise at(f"pair.{name}.modification", error) from None
    return (found,)


def _line_gap(scene: Scene, name: str) -> tuple[Array, Array]:
    """Gap over the face of a pair, from its keys and its file."""
    part, half = scene.case.pair[name].line_error, 0.5 * scene.pairs[name].face_width
    if part is None:
        return np.empty(0), np.empty(0)
    z = np.linspace(-half, half, _POINTS if part.crowning or part.file else 2)
    gap = 0.5 * part.over_face * (1.0 + z / half) + part.crowning * (z / half) ** 2
    if part.file is not None:
        key = f"pair.{name}.line_error.file"
        columns = read_columns(scene.file(part.file, key), key, {"z": "length", "gap": "length"})
        if not {"z", "gap"} <= columns.keys() or not (np.diff(columns["z"]) > 0.0).all():
            rule = f"requires the columns z [mm], ascending, and gap [um]; it has {columns.has}"
            raise InputError(key, f'"{part.file}"', rule)
        if columns["z"][0] > -half * (1.0 - 1e-6) or columns["z"][-1] < half * (1.0 - 1e-6):
            raise InputError(
                key, f'"{part.file}"', f"must cover the face, from {-half * 1e3:.6g} to {half * 1e3:.6g} mm"
            )
        module, spread = scene.pairs[name].driver.module, float(np.ptp(columns["gap"]))
        if spread > module:
            raise InputError(
                key, f"gap {spread * 1e6:.6g} um", f"exceeds the module of {module * 1e3:.6g} mm",
                "check the unit in the head of the column",
            )  # fmt: skip
        z, old = distinct(z, columns["z"]), z
        gap = np.interp(z, old, gap) + np.interp(z, columns["z"], columns["gap"])
    return z, gap
