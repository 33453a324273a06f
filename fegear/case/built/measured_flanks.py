"""Measured flanks of a case: traces read and filtered, their deviations from the design, and what pairs feel."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from fegear.base.arrays import Array, distinct
from fegear.base.errors import InputError
from fegear.case.csv_file import read_columns
from fegear.case.reading import Scene
from fegear.case.relief import MeasuredPart
from fegear.formulas.iso1328_traces import TraceDeviations, cutoff, evaluate, filtered, helix_range, profile_range
from fegear.geometry.flank_modification import LeadTable, Topography
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import TabulatedRelief, roll_as_given, roll_of_radius

Kind = Literal["profile", "helix"]
#: Places of a mean trace that pairs feel, two for the shortest wave that the filter leaves and more; of a topography.
_PLACES, _ROWS = 121, 41
#: Largest deviation that is one [modules].
_LARGEST = 0.1
#: Most teeth and places of a trace.
_MOST = 200_000


@dataclass(frozen=True)
class Traces:
    """Traces of one kind, filtered, at the same places on every tooth.

    Parameters
    ----------
    kind : {"profile", "helix"}
    x : ndarray, shape (N,)
        Lengths of roll, or heights [m].
    deviation : ndarray, shape (T, N)
        Of every tooth from the pure involute or helix [m].
    teeth : tuple of int
        Their numbers.
    ends : (float, float)
        Evaluation range [m].
    wavelength : float
        Cut-off of the filter [m]; zero without.
    """

    kind: Kind
    x: Array
    deviation: Array
    teeth: tuple[int, ...]
    ends: tuple[float, float]
    wavelength: float

    @property
    def mean(self) -> Array:
        """Of all teeth [m]."""
        return np.asarray(self.deviation.mean(axis=0))

    @property
    def removal(self) -> Array:
        """What the mean trace lacks of its highest place in the evaluation range [m]."""
        inside = (self.x >= self.ends[0]) & (self.x <= self.ends[1])
        return np.asarray(self.mean[inside].max() - self.mean)

    def deviations(self, design: Array) -> list[TraceDeviations]:
        """Of every tooth, and of the mean trace as the last, from a design [m]."""
        rows = [*self.deviation, self.mean]
        return [evaluate(self.x, row - design, *self.ends) for row in rows]


@dataclass(frozen=True)
class MeasuredGear:
    """All measured traces of a gear.

    Parameters
    ----------
    profile, helix : Traces or None
        Of a topography those in the middle of the face and of the profile.
    topography : Topography or None
        Mean of all teeth, as removal.
    base_radius : float
        [m].
    gear : str
    """

    profile: Traces | None
    helix: Traces | None
    topography: Topography | None
    base_radius: float
    gear: str = field(compare=False)

    @property
    def relief(self) -> TabulatedRelief | None:
        """The mean profile as a relief over the roll angle."""
        if self.profile is None:
            return None
        return TabulatedRelief(self.profile.x / self.base_radius, self.profile.removal)

    @property
    def lead(self) -> LeadTable | None:
        """The mean helix as a modification over the face."""
        return None if self.helix is None else LeadTable(self.helix.x, self.helix.removal)


def _given(scene: Scene, name: str) -> tuple[MeasuredPart | None, str]:
    """What a case says of the flanks that a gear is seen from, and where."""
    part, key = scene.case.gear[name].measured_of(scene.gears[name].tooth.working_flank)
    return part, f"gear.{scene.written.get(name, name)}.{key}"


def measured_gear(scene: Scene, name: str) -> MeasuredGear:
    """Read the measured flanks of a gear.

    Raises
    ------
    InputError
        If a file has not the columns, or traces do not cover their evaluation range.
    """
    gear, (given, key) = scene.gears[name], _given(scene, name)
    part = given or MeasuredPart(profile="")
    profile = helix = topography = None
    over_profile, over_face = _profile_ends(scene, name), _lead_ends(scene, name)
    if part.profile is not None:
        rows = _columns(scene, part.profile, f"{key}.profile", gear)
        profile = _traces("profile", rows, over_profile, f"{key}.profile", smooth=part.filter)
    if part.lead is not None:
        rows = _columns(scene, part.lead, f"{key}.lead", gear, over_face=True)
        helix = _traces("helix", rows, over_face, f"{key}.lead", smooth=part.filter)
    if part.topography is not None:
        profile, helix, topography = _flank(scene, name, part, over_profile, over_face)
    return MeasuredGear(profile, helix, topography, gear.base_radius, name)


def _profile_ends(scene: Scene, name: str) -> tuple[float, float]:
    """Evaluation range in lengths of roll: as given, else from where contact starts in a pair toward the tip."""
    gear, (part, key) = scene.gears[name], _given(scene, name)
    given = None if part is None else part.profile_range
    if given is not None:
        if min(given) < gear.base_radius:
            raise InputError(f"{key}.profile_range", "(a list)", "extends inside the base circle")
        ends = gear.base_radius * roll_of_radius(gear, np.array(given))
        return float(ends.min()), float(ends.max())
    involute = gear.tooth.involute
    contact = [
        float(pair.roll_angle(x, member))
        for key, pair in scene.pairs.items()
        for member in MEMBERS
        if name == getattr(scene.case.pair[key], member)
        for x in (pair.x_start, pair.x_end)
    ]
    low, high = sorted((involute.start, involute.end))
    if gear.tooth.internal:  # its tip lies where the roll angle is least
        root = min(max(contact, default=high), high)
        first, last = sorted(profile_range(gear.base_radius * root, gear.base_radius * low))
        return first, last
    return profile_range(gear.base_radius * max(min(contact, default=low), low), gear.base_radius * high)


def _lead_ends(scene: Scene, name: str) -> tuple[float, float]:
    gear, (part, _) = scene.gears[name], _given(scene, name)
    if part is not None and part.lead_range is not None:
        return part.lead_range[0], part.lead_range[1]
    return helix_range(gear.face_width, gear.module)


def _columns(scene: Scene, file: str, key: str, gear: Gear, *, over_face: bool = False) -> dict[str, Array]:
    """Columns of a file: x, deviation, tooth; z where it has that, too."""
    known = {"radius": "length", "roll_angle": "angle", "roll_length": "length", "z": "length", "deviation": "length"}
    found = read_columns(scene.file(file, key), key, {**known, "tooth": ""})
    place = ["z"] if over_face else [one for one in ("radius", "roll_angle", "roll_length") if one in found]
    if len(place) != 1 or place[0] not in found or "deviation" not in found:
        what = "z [mm]" if over_face else "radius [mm], roll_angle [deg] or roll_length [mm]"
        raise InputError(key, f'"{file}"', f"requires the columns {what}, and deviation [um]; it has {found.has}")
    if found["deviation"].size > _MOST:
        raise InputError(key, f'"{file}"', f"has more than {_MOST:,} points", "use every second point")
    _check(found, key, gear)
    x = found[place[0]]
    if place[0] == "radius":
        if (x < gear.base_radius).any():
            raise InputError(key, f"radius {x.min() * 1e3:.6g} mm", "lies inside the base circle")
        x = gear.base_radius * roll_of_radius(gear, x)
    elif place[0] in ("roll_angle", "roll_length"):
        x = roll_as_given(gear, gear.base_radius * x if place[0] == "roll_angle" else x)
    return {**found, "x": x, "tooth": found.get("tooth", np.zeros(x.size))}


def _check(found: dict[str, Array], key: str, gear: Gear) -> None:
    """Refuse what no tooth of the gear can have been measured to be."""
    most, teeth = float(np.abs(found["deviation"]).max()), gear.tooth.teeth
    if most > _LARGEST * gear.module:
        raise InputError(
            key, f"deviation {most * 1e6:.6g} um", f"is more than a tenth of the module of {gear.module * 1e3:.6g} mm",
            "check the unit in the head of the column",
        )  # fmt: skip
    for tooth in np.unique(found.get("tooth", np.zeros(1))):
        if tooth != round(tooth) or not 0 <= tooth <= teeth:
            raise InputError(key, f"tooth {tooth:g}", f"must be a whole number up to {teeth}, the gear's teeth")


def _traces(
    kind: Kind, rows: dict[str, Array], ends: tuple[float, float], key: str, *, smooth: bool
) -> Traces:  # fmt: skip
    """Traces of all teeth, filtered, at common places."""
    wavelength = cutoff(ends[1] - ends[0]) if smooth else 0.0
    numbers = np.unique(rows["tooth"])
    each = []
    for tooth in numbers:
        mine = np.flatnonzero(rows["tooth"] == tooth)
        mine = mine[np.argsort(rows["x"][mine], kind="stable")]
        x, y = rows["x"][mine], rows["deviation"][mine]
        if x.size < 5 or (np.diff(x) <= 0.0).any():
            raise InputError(
                key, f"tooth {tooth:g}", "has fewer than five points, or one point twice", "specify each trace once"
            )
        each.append((x, filtered(x, y, wavelength) if smooth else y))
    low, high = max(x[0] for x, _ in each), min(x[-1] for x, _ in each)
    if not low < high:
        raise InputError(key, "(traces)", "do not overlap", "use the same measuring range for all teeth")
    common = distinct(np.clip(ends, low, high), np.linspace(low, high, _PLACES))
    deviation = np.array([np.interp(common, x, y) for x, y in each])
    found = Traces(kind, common, deviation, tuple(int(one) for one in numbers), ends, wavelength)
    try:
        found.deviations(np.zeros(common.size))
    except InputError as error:  # the traces do not cover the evaluation range
        of = f"{key.rpartition('.')[0]}.{'profile' if kind == 'profile' else 'lead'}_range"
        raise InputError(of, error.value, error.rule, error.remedy) from None
    return found


def _flank(
    scene: Scene, name: str, part: MeasuredPart, over_profile: tuple[float, float], over_face: tuple[float, float]
) -> tuple[Traces, Traces, Topography]:
    """Profile and helix through the middle of a topography, and its mean as a removal."""
    gear, key = scene.gears[name], f"{_given(scene, name)[1]}.topography"
    file = part.topography or ""
    rows = _columns(scene, file, key, gear)
    if "z" not in rows:
        raise InputError(key, f'"{file}"', "requires the column z [mm]")
    numbers = np.unique(rows["tooth"])
    x, i = np.unique(rows["x"], return_inverse=True)
    z, k = np.unique(rows["z"], return_inverse=True)
    values = np.full((numbers.size, x.size, z.size), np.nan)
    values[np.searchsorted(numbers, rows["tooth"]), i, k] = rows["deviation"]
    if min(x.size, z.size) < 5 or i.size != values.size or np.isnan(values).any():
        raise InputError(
            key, f'"{file}"', f"has {i.size} entries of {numbers.size} teeth at {x.size} profile points and {z.size} "
                              "positions along the face",
            "specify each profile point at each position once, at least five of both",
        )  # fmt: skip
    if part.filter:
        across, along = (cutoff(ends[1] - ends[0]) for ends in (over_profile, over_face))
        values = np.array([[filtered(x, row, across) for row in tooth.T] for tooth in values]).transpose(0, 2, 1)
        values = np.array([[filtered(z, row, along) for row in tooth] for tooth in values])
    at_z = np.array([[np.interp(0.0, z, row) for row in tooth] for tooth in values])
    middle = 0.5 * sum(over_profile)
    at_x = np.array([[np.interp(middle, x, row) for row in tooth.T] for tooth in values])
    traces = []
    for kind, places, found, ends in (("profile", x, at_z, over_profile), ("helix", z, at_x, over_face)):
        flat = {
            "x": np.tile(places, numbers.size), "deviation": found.ravel(), "tooth": np.repeat(numbers, places.size)
        }  # fmt: skip
        made = _traces(kind, flat, ends, key, smooth=False)  # type: ignore[arg-type]  # the two words
        wavelength = cutoff(ends[1] - ends[0]) if part.filter else 0.0
        traces.append(Traces(made.kind, made.x, made.deviation, made.teeth, made.ends, wavelength))
    mean = values.mean(axis=0)
    return traces[0], traces[1], Topography(x / gear.base_radius, z, mean.max() - mean)
