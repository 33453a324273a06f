"""From ``[shaft.NAME]`` and ``[bearing.NAME]`` to a gearbox: shafts, seats and where its pairs mesh."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming, exceeding
from fegear.base.printed import figures, percent
from fegear.case.nearest import nearest
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.case.shaft import ENVELOPE
from fegear.geometry.plausible import THICKEST_BELOW_GEARS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.notes import Note
    from fegear.case.built.gears_on_shafts import StiffenedShaft
    from fegear.case.shaft import BearingPart
    from fegear.shafts.gearbox import Gearbox
    from fegear.shafts.held import Around
    from fegear.shafts.mesh import MeshPlace

#: By so much places along and of coaxial shafts may differ [m].
_APART = 1e-6
#: By so much the distance of two axes may differ from a pair's centre distance [m]: coordinates have 0.01 mm. Of the
#: axes a mesh takes only their direction, which this turns by 0.01 degrees at 100 mm.
_DISTANCE = 15e-6
#: Faces on one shaft may overlap by this share of the narrower one, as rounded places do.
_OVERLAP = 0.01
#: Keys of what rolls in a bearing.
_ELEMENTS = {"element_diameter": "elements.diameter"} | {
    key: f"elements.{key}" for key in ("count", "pitch_diameter", "contact_angle", "groove_ratio", "roller_length")
}
#: Load ratings of a bearing.
_SYMBOLS = {"dynamic_rating": "C", "static_rating": "C_0"}
#: Shafts and bearings that are solved together at most.
_SHAFTS, _BEARINGS = 100, 300


def on_shafts(scene: Scene, pair: str) -> bool:
    """Whether both gears of a pair stand on shafts of the case."""
    standing = {place.gear for part in scene.case.shaft.values() for place in part.gears}
    part = scene.case.pair[pair]
    return part.driver in standing and part.driven in standing


def check_heights(scene: Scene, pair: str) -> None:
    """Refuse a pair whose gears stand at other heights on their shafts than the pair says.

    Raises
    ------
    InputError
    """
    mesh = next(one for one in mesh_places(scene) if one.pair == pair)
    starts = [scene.case.shaft[name].start for name in mesh.shafts]
    higher = mesh.sense * (starts[1] + mesh.at[1] - starts[0] - mesh.at[0])  # toward end I, as the key counts
    given = scene.case.pair[pair].axial_offset
    if abs(higher - given) > _APART:
        raise InputError(
            f"pair.{pair}.axial_offset", f"{given * 1e3:.6g} mm",
            f"contradicts the gear positions on shafts {mesh.shafts[0]} and {mesh.shafts[1]}: the driven gear is "
            f"offset by {higher * 1e3:.6g} mm towards end I",
            f"set axial_offset = \"{higher * 1e3:.6g} mm\", or move a gear",
        )  # fmt: skip


def mesh_places(scene: Scene) -> tuple[MeshPlace, ...]:
    """Every loaded pair both of whose gears stand on shafts.

    Raises
    ------
    InputError
        If a gear stands on two shafts, faces are not side by side, or axes are not at the centre distance.
    """
    where: dict[str, tuple[str, float]] = {}
    for name, part in scene.case.shaft.items():
        for n, place in enumerate(part.gears):
            key = f"shaft.{name}.gears.{n}.gear"
            if place.gear not in scene.gears:
                raise InputError(key, f'"{place.gear}"', "is not a gear of this case", nearest(place.gear, scene.gears))
            if place.gear in where:
                raise InputError(
                    key, f'"{place.gear}"', f"is already mounted on shaft {where[place.gear][0]}", "mount it once"
                )
            where[place.gear] = name, place.at
        _refuse_overlap(scene, name)
        _refuse_thick(scene, name)
    found = []
    driven = {where[one.driven][0] for one in scene.case.pair.values() if one.driven in where and one.driver in where}
    senses = {name: -1 if part.clockwise else 1 for name, part in scene.case.shaft.items() if name not in driven}
    left = {name: one for name, one in scene.case.pair.items() if one.driver in where and one.driven in where}
    while left:
        ready = [name for name, one in left.items() if where[one.driver][0] in senses]
        if not ready:
            raise InputError(
                "shaft", ", ".join(sorted(driven)), "form a closed loop of drives", "choose one shaft as the input"
            )
        for name in ready:
            one = left.pop(name)
            ends = where[one.driver], where[one.driven]
            found.append(_mesh(scene, name, ends, senses[ends[0][0]]))
            senses[ends[1][0]] = -scene.pairs[name].side * senses[ends[0][0]]
    return tuple(found)


def _refuse_overlap(scene: Scene, shaft: str) -> None:
    """Refuse gears on one shaft whose faces run into each other."""
    ordered = sorted(scene.case.shaft[shaft].gears, key=lambda place: place.at)
    for one, two in pairwise(ordered):
        widths = [scene.gears[place.gear].face_width for place in (one, two)]
        room = two.at - one.at - 0.5 * sum(widths)
        if room < -_OVERLAP * min(widths):
            raise InputError(
                f"shaft.{shaft}.gears", f"{one.gear} and {two.gear}", f"overlap by {-room * 1e3:.4g} mm",
                "move one of them, or reduce its face width",
            )  # fmt: skip


def _refuse_thick(scene: Scene, shaft: str) -> None:
    """Refuse a shaft many times as thick as the largest gear on it: metres that were taken for millimetres."""
    part = scene.case.shaft[shaft]
    if not part.gears:
        return
    thickest = max(max(one.outer, one.outer_end or 0.0) for one in part.sections)
    tips = 2.0 * max(max(scene.gears[one.gear].tip_radius, scene.gears[one.gear].root_radius) for one in part.gears)
    if thickest > THICKEST_BELOW_GEARS * tips:
        raise InputError(
            f"shaft.{shaft}.sections", f"{thickest * 1e3:.6g} mm",
            f"is {thickest / tips:.3g} times the diameter of the largest gear on the shaft (at most "
            f"{THICKEST_BELOW_GEARS:g} times)", "check the unit of outer",
        )  # fmt: skip


def _mesh(scene: Scene, name: str, ends: tuple[tuple[str, float], tuple[str, float]], sense: int) -> MeshPlace:
    from fegear.shafts.mesh import MeshPlace

    pair, part = scene.pairs[name], scene.case.pair[name]
    first, second = (scene.case.shaft[shaft] for shaft, _ in ends)
    across = np.subtract(second.axis, first.axis)
    apart = float(np.hypot(*across))
    if abs(apart - pair.centre_distance) > _DISTANCE:
        remedy = "correct the position of one axis"
        if apart > 0.0:
            x, y = np.round(1e3 * (np.array(first.axis) + across * (pair.centre_distance / apart)), 4) + 0.0
            remedy += f', such as axis = ["{x:.10g} mm", "{y:.10g} mm"] in the same direction'
        raise InputError(
            f"shaft.{ends[1][0]}.axis", f"{apart * 1e3:.7g} mm from shaft {ends[0][0]}",
            f"is not at the centre distance of pair {name}, {pair.centre_distance * 1e3:.7g} mm (to within "
            f"{_DISTANCE * 1e3:g} mm)", remedy,
        )  # fmt: skip
    middles = first.start + ends[0][1], second.start + ends[1][1]
    if abs(middles[0] - middles[1]) >= 0.5 * (pair.driver.face_width + pair.driven.face_width):
        raise InputError(
            f"shaft.{ends[1][0]}.gears", f"middle at {middles[1] * 1e3:.6g} mm",
            f"does not mesh axially with its mating gear of pair {name} at {middles[0] * 1e3:.6g} mm",
            "correct the position of the gear or the start of the shaft",
        )  # fmt: skip
    load = part.normal_load(pair)
    if load is None:
        raise InputError(
            f"pair.{name}.load", "(not given)", "is required for the shaft calculation", "specify load or torque"
        )
    return MeshPlace(name, (ends[0][0], ends[1][0]), (ends[0][1], ends[1][1]), across / apart, sense, pair, load)


def _refuse_many(scene: Scene) -> None:
    """Refuse more shafts and bearings than one dense system of equations should hold."""
    shafts = scene.case.shaft.values()
    bearings = sum(len(part.bearings) for part in shafts)
    for key, count, most in (("shaft", len(shafts), _SHAFTS), ("shaft.bearings", bearings, _BEARINGS)):
        if count > most:
            raise InputError(
                key,
                f"{count:,} in all",
                "exceeds the number that can be solved together",
                f"specify at most {most}; split the case",
            )


def said_of_bodies(scene: Scene) -> tuple[str, ...]:
    """What is assumed of gears on their shafts."""
    return tuple(part for one in _stiffened(scene, mesh_places(scene)) for part in one.said)


def said_of_bearings(scene: Scene) -> tuple[str, ...]:
    """What is assumed of bearings on shafts of which only a catalogue is known."""
    used = dict.fromkeys(place.bearing for part in scene.case.shaft.values() for place in part.bearings)
    printed = {name: scene.case.bearing[name].printed for name in used if name in scene.case.bearing}
    found: list[str] = [f"Bearing {name}: {one.said}" for name, one in printed.items() if one is not None]
    for name in printed:
        found += _said_of_ratings(name, scene.case.bearing[name])
    return tuple(found)


def _said_of_ratings(name: str, part: BearingPart) -> Iterator[Note]:
    """Ratings of another bearing than the designation's, and a C that is estimated."""
    printed, life, said = part.printed, part.life, part.catalogue
    if printed is None:
        return
    key = f"bearing.{name}"
    if part.designation is not None and not (said and said.given & ENVELOPE):
        for table, given in (("life", life), ("catalogue", said)):
            ratings = {one: getattr(given, one, None) for one in _SYMBOLS}
            for rating, value, typical in printed.misfits(**ratings):
                yield exceeding(
                    f"Bearing {name}: {_SYMBOLS[rating]} = {figures(value * 1e-3)} kN does not fit {part.designation} "
                    f"(typical: {figures(typical * 1e-3)} kN); correct {key}.{table}.{rating} or {key}.designation, or "
                    "remove the rating to have it estimated"
                )
    rated = part.rating
    if rated is not None and printed.dynamic_rating is None:
        from fegear.shafts.life import EXPONENT  # late: most cases have no bearings

        off = (1.0 + printed.rating_error) ** EXPONENT[rated.kind]
        c, spread = figures(rated.dynamic_rating * 1e-3), percent(printed.rating_error)
        if part.catalogue_rating is not None:
            found = f"from the SKF General Catalogue, other makers and designs within {spread}"
        else:
            found = f"estimated from the dimensions, error {spread}"
        yield assuming(
            f"Bearing {name}: C = {c} kN {found} (of the life a factor of {figures(off, 2)}); specify "
            "life.dynamic_rating"
        )


def _stiffened(scene: Scene, meshes: tuple[MeshPlace, ...]) -> list[StiffenedShaft]:
    from fegear.case.built.gears_on_shafts import stiffened

    senses = {
        gear: mesh.sense
        for mesh in reversed(meshes)
        for gear in (scene.case.pair[mesh.pair].driver, scene.case.pair[mesh.pair].driven)
    }
    found = []
    for name, part in scene.case.shaft.items():
        try:
            bare = part.build()
        except InputError as error:
            raise at(f"shaft.{name}", error) from None
        for where, key in ((part.coupling, "coupling"), *((one.at, "gears") for one in part.gears)):
            if where is not None:
                bare.place(where, f"shaft.{name}.{key}")
        found.append(stiffened(scene, name, bare, senses))
    return found


def gearbox_of(scene: Scene) -> Gearbox:
    """Collect the shafts of a case with all that acts on them from outside, and its meshes.

    Raises
    ------
    InputError
        If a name is unknown, a shaft is not held, or something is off it.
    """
    from fegear.shafts.gearbox import Gearbox
    from fegear.shafts.held import LoadedShaft, Seat, refuse_loose, refuse_torque

    _refuse_many(scene)
    meshes = mesh_places(scene)
    bodies = _stiffened(scene, meshes)
    fast = {gear: body for one in bodies for gear, body in one.bodies.items()}
    shafts, seat_compliance = [], []
    for (name, part), stiff in zip(scene.case.shaft.items(), bodies, strict=True):
        seats = []
        for n, place in enumerate(part.bearings):
            known = scene.case.bearing
            if place.bearing not in known:
                key = f"shaft.{name}.bearings.{n}.bearing"
                raise InputError(
                    key, f'"{place.bearing}"', "is not a bearing of this case", nearest(place.bearing, known)
                )
            data = known[place.bearing]
            try:
                made = data.build(mirrored=place.reversed)
            except InputError as error:
                raise at(f"bearing.{place.bearing}", error, _ELEMENTS) from None
            around = None if place.around is None else _around(scene, name, n, bodies)
            seats.append(Seat(made, place.at, f"bearings.{n}", around))
            across, along = (1.0 / k if k else 0.0 for k in (data.housing_radial, data.housing_axial))
            seat_compliance += [across, across, along, 0.0, 0.0]
        places = np.array([one.at for one in part.loads])
        loads = np.array([[*(one.force or (0.0,) * 3), *(one.moment or (0.0,) * 3)] for one in part.loads])
        shafts.append(LoadedShaft(stiff.shaft, tuple(seats), places, loads.reshape(-1, 6), f"shaft.{name}"))
    meshes = tuple(
        replace(mesh, bodies=(fast.get(scene.case.pair[mesh.pair].driver), fast.get(scene.case.pair[mesh.pair].driven)))
        for mesh in meshes
    )
    box = Gearbox(
        tuple(shafts), tuple(part.coupling for part in scene.case.shaft.values()), meshes, np.diag(seat_compliance),
        tuple(scene.case.shaft),
    )  # fmt: skip
    refuse_torque(box.loaded(box.even))
    refuse_loose(box.shafts)
    return box


def _around(scene: Scene, shaft: str, number: int, bodies: list[StiffenedShaft]) -> Around:
    """Where a bearing of a shaft sits in the shaft around it.

    Raises
    ------
    InputError
        If there is no such shaft, on another axis or not as long.
    """
    from fegear.shafts.held import Around

    parts = scene.case.shaft
    own, place = parts[shaft], parts[shaft].bearings[number]
    key, name = f"shaft.{shaft}.bearings.{number}.around", str(place.around)
    if name not in parts or name == shaft:
        known = [one for one in parts if one != shaft]
        raise InputError(key, f'"{name}"', "is not another shaft of this case", nearest(name, known))
    if (apart := float(np.hypot(*np.subtract(parts[name].axis, own.axis)))) > _APART:
        raise InputError(
            key, f'"{name}"', f"is {apart * 1e3:.6g} mm from the axis of {shaft}",
            "specify a shaft on the same axis, or none (housing)",
        )  # fmt: skip
    order = list(parts).index(name)
    return Around(order, bodies[order].shaft.place(own.start + place.at - parts[name].start, key))
