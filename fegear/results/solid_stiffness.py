"""Result ``stiffness`` over the face: the table of one gear with its width, band by band."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError
from fegear.models.assumed import bore_remarks
from fegear.results.drawn_solid import solid_figures
from fegear.results.gear_contacts import USUAL_HALF_WIDTH, check_contacts_of, contact_half_width, load_radii
from fegear.results.solid_solution import needs_solid_solution
from fegear.results.sources import RING

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.fem.influence import Side
    from fegear.fem.solid.table import SolidTable
    from fegear.geometry import Gear

#: Reading off one band of a solved gear, and the fixed part [s].
_SECONDS_PER_BAND, _SECONDS_OF_TABLE = 5e-3, 0.1
#: Of the picture of the deformed tooth when the case names none [N].
_USUAL_FORCE = 1e3
_SIDES: tuple[tuple[Side, str], ...] = (
    ("tension", "largest tangential stress of the fillet below the loaded flank, anywhere along the face"),
    ("compression", "most negative tangential stress of the other fillet"),
)


def _table(name: str, t: SolidTable) -> Table:
    compliance, stress = "um/N", "MPa/N"
    rows, places = t.c_self.shape

    def up(values: Array) -> Array:
        return np.repeat(values, places)

    def along(values: Array) -> Array:
        return np.tile(values, rows)

    columns = [
        Column("radius", up(t.radius), "mm", "radius of the band's middle"),
        Column("roll_angle", up(t.roll_angle), "deg", "roll angle of the band's middle"),
        Column("face_position", along(t.position), "mm", "place of the band's top along the face, from its middle"),
        Column("c_self", t.c_self.ravel(), compliance, "approach of the contact per force"),
        Column("c_prev", t.c_prev.ravel(), compliance, "deflection of the same band on the tooth before"),
        Column("c_next", t.c_next.ravel(), compliance, "of the same band on the tooth after (which the flank faces)"),
        Column("contact_half_width", up(t.half_width), "mm", "half-width of the contact that c_self is for"),
        Column("pressed_half_width", up(t.pressed_half_width), "mm", "of the pressure that all else is for"),
        Column("band_before", along(t.before), "mm", "how far the band reaches toward the face end at minus"),
        Column("band_after", along(t.after), "mm", "how far it reaches toward the other end"),
    ]
    for side, meaning in _SIDES:
        found = t.root[side]
        columns += [
            Column(f"root_{side}", found.value.ravel(), stress, meaning),
            Column(f"root_{side}_position", found.position.ravel(), "mm", "where it sits along the face"),
            Column(f"root_{side}_radius", found.radius.ravel(), "mm", "and its distance from the axis"),
            Column(f"root_{side}_axial", found.axial.ravel(), stress, "stress across it in the surface there"),
            Column(f"root_{side}_shear", found.shear.ravel(), stress, "shear between both there"),
        ]
    columns += [
        Column("c_self_error", t.errors["c_self"].ravel(), compliance, "estimated error of c_self"),
        Column("c_neighbour_error", t.errors["c_neighbour"].ravel(), compliance, "of c_prev and c_next"),
        Column("root_tension_error", t.errors["root_tension"].ravel(), stress, "of root_tension"),
        Column("root_compression_error", t.errors["root_compression"].ravel(), stress, "of root_compression"),
    ]
    title = f"Compliance and root stress of gear {name} over its face, per force on a band"
    return Table(f"stiffness_over_face_{name}", tuple(columns), title)


def _values(name: str, t: SolidTable) -> tuple[Value, ...]:
    found = []
    for key, values, error, unit, pick in (
        ("largest_band_c_self", t.c_self, t.errors["c_self"], "um/N", np.argmax),
        ("smallest_band_c_self", t.c_self, t.errors["c_self"], "um/N", np.argmin),
        ("largest_band_root_tension", t.root["tension"].value, t.errors["root_tension"], "MPa/N", np.argmax),
        ("largest_band_root_compression", t.root["compression"].value, t.errors["root_compression"], "MPa/N",
         np.argmin),
    ):  # fmt: skip
        i, j = np.unravel_index(int(pick(values)), values.shape)
        where = f"per force on a band at radius {t.radius[i] * 1e3:.6g} mm, face position {t.position[j] * 1e3:.6g} mm"
        found.append(Value(f"{name}.{key}", float(values[i, j]), unit, float(error[i, j]), where))
    return tuple(found)


@dataclass(frozen=True)
class SolidTableInputs:
    """What the table of a solid gear depends on beside its influence functions.

    Parameters
    ----------
    gear : Gear
    radii, positions, half_widths : ndarray, shape (R,), (Z,), (R,)
        Of the bands and their contacts [m].
    tolerance : float
        That estimated errors are held against.
    assumed : tuple of str
        Sentences about values that the case does not give.
    name : str
        Of the gear.
    """

    gear: Gear
    radii: Array
    positions: Array
    half_widths: Array
    tolerance: float
    assumed: tuple[str, ...] = field(default=(), compare=False)
    name: str = field(default="", compare=False)


def face_positions(scene: Scene, name: str) -> Array:
    """Places along the face [m]: those of the case, or so many equally spaced from end to end."""
    wanted, half = scene.case.stiffness.face_positions, 0.5 * scene.gears[name].face_width
    if isinstance(wanted, int):
        return np.linspace(-half, half, wanted) if wanted > 1 else np.zeros(1)
    return np.array(wanted)


def _inputs(scene: Scene, name: str) -> SolidTableInputs:
    assumed, radii = bore_remarks(scene, name), load_radii(scene, name)
    if scene.case.stiffness.contact_half_width is None:
        usual = f"so c_self is for a half-width of {USUAL_HALF_WIDTH} modules."
        assumed = (f"Gear {name}: no contact_half_width was given, {usual}", *assumed)
    widths, tolerance = contact_half_width(scene, name, radii), scene.case.accuracy.tolerance
    return SolidTableInputs(scene.gears[name], radii, face_positions(scene, name), widths, tolerance, assumed, name)


def _compute(asked: SolidTableInputs, upstream: Upstream, _work: Work) -> SolidTable:
    from fegear.fem.solid.table import solid_table

    (influence,) = upstream.values()
    return solid_table(asked.gear, influence, asked.radii, asked.positions, asked.half_widths)


def _present(table: SolidTable, asked: SolidTableInputs) -> Outcome:
    name, m = asked.name, asked.gear.module
    reach = float(max(table.before.max(), table.after.max())) * 1e3
    width = f"{table.pressed_half_width.min() * 1e3:.4g} to {table.pressed_half_width.max() * 1e3:.4g}"
    bands = (
        f"Gear {name} over its face: each force presses on a band of the contact line, falling linearly along the face "
        f"over {reach:.4g} mm to either side, where the face goes on so far. c_self is for the contact's own "
        f"half-width; neighbours and root stress are for a pressure of {width} mm half-width up the flank."
    )
    return Outcome(
        table,
        (_table(name, table),),
        _values(name, table),
        remarks=(bands, *_sliced(table, asked), *_missed(table, asked), *asked.assumed),
        figures=solid_figures(name, asked.gear, table, _USUAL_FORCE * m / 1e-3),
    )


def _sliced(table: SolidTable, asked: SolidTableInputs) -> tuple[str, ...]:
    """Say what slices are."""
    if table.influence.settings.source == "solid":
        return ()
    said = "coupled slices of its plane section are used instead of the solid; errors are their largest on solid gears"
    return (f"Gear {asked.name} over its face: {said}.",)


def _missed(t: SolidTable, asked: SolidTableInputs) -> tuple[str, ...]:
    """Say where the tolerance is missed."""
    told = []
    for label, value in (
        ("c_self", t.c_self),
        ("root_tension", t.root["tension"].value),
        ("root_compression", t.root["compression"].value),
    ):
        relative = np.abs(t.errors[label] / value).max(axis=1)
        i = int(np.argmax(relative))
        if relative[i] > asked.tolerance:
            within = float(np.mean(relative <= asked.tolerance))
            told.append(
                f"Gear {asked.name} over its face: the estimated error of {label} reaches {relative[i]:.1e} (tolerance "
                f"{asked.tolerance:.0e}), at radius {t.radius[i] * 1e3:.6g} mm; at {within:.0%} of the radii it is "
                "within the tolerance."
            )
    return tuple(told)


def _check(scene: Scene, name: str) -> None:
    check_contacts_of(scene, name)
    wanted, half = scene.case.stiffness.face_positions, 0.5 * scene.gears[name].face_width
    for i, place in enumerate(wanted if isinstance(wanted, list) else ()):
        if abs(place) > half * (1.0 + 1e-9):
            raise InputError(
                f"stiffness.face_positions[{i}]", f"{place * 1e3:.9g} mm", f"lies off the face of gear {name}",
                f"it runs from {-half * 1e3:.9g} mm to {half * 1e3:.9g} mm, 0 in its middle",
            )  # fmt: skip


def _subjects(scene: Scene) -> tuple[str, ...]:
    """The gear that ``[stiffness]`` names, spur or helical; every gear of the case if it names none."""
    part = scene.case.stiffness
    if part.face_positions is None:
        return ()
    return (part.gear,) if part.gear else tuple(scene.gears)


def _forecast(scene: Scene, _name: str) -> Forecast:
    part = scene.case.stiffness
    wanted = part.face_positions or 0
    places = wanted if isinstance(wanted, int) else len(wanted)
    bands = part.band_radii * places
    return Forecast({"bands": bands}, _SECONDS_OF_TABLE + _SECONDS_PER_BAND * bands)


SOLID_STIFFNESS = Stage(
    subjects=_subjects,
    needs=lambda _scene, name: needs_solid_solution(name),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(*RING, Citation("iso-21771", "the transverse section, turned along the face")),
    forecast=_forecast,
)
