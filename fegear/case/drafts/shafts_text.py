"""Shafts and bearings of a drafted gearbox as tables of a case file."""

from __future__ import annotations

from collections.abc import Sequence

from fegear.base.units import from_si
from fegear.case.drafts.placed_shafts import ChosenBearing, PlacedShaft
from fegear.case.drafts.stages import LaidOut, gears_on_shafts
from fegear.case.drafts.stiff_shafts import sections
from fegear.case.text_file import toml_string

#: Names of shafts by the number of stages.
_SHAFTS = {
    1: ("input", "output"), 2: ("input", "middle", "output"), 3: ("input", "middle_1", "middle_2", "output"),
}  # fmt: skip
_SHAFT = """\
[shaft.{name}]{note}
{axis}sections = [
{sections}
]
gears = [{gears}]
bearings = [{{ bearing = "{name}_{left}", at = "{first}" }}, {{ bearing = "{name}_{right}", at = "{last}"{reversed} }}]
{coupling}yield_strength = "275 MPa"     # assumed: S355 up to 250 mm, EN 10025-2
"""
_SECTION = '    {{ length = "{long}", outer = "{across}" }},'
_BEARING = """\
[bearing.{name}]
designation = "{designation}"
life = {{}}     # {rated} of the designation{short}
"""
_STIFF = """\
[bearing.{name}]
radial = {radial}     # with its seat, assumed: pinion too small for tabulated designations
{fixed}"""
_TURNED = "# clockwise = true     # other direction of rotation: coast flanks, axial forces on other bearings\n"
#: What a bearing is rated by, and what is said of one that does not last.
_RATED_BY = {"floating": "C"}
_SHORT = "; shorter life: none within the root circle lasts as long"
#: Radial stiffness per bore of deep groove ball bearings of middle size and their seats [N/m / m].
_PER_BORE = 7e9


def length(value: float) -> str:
    """In millimetres, to six digits."""
    return f"{value * from_si('mm'):.6g} mm"


def amount(value: float, unit: str) -> str:
    """In a unit, to two digits."""
    return f"{float(f'{value * from_si(unit):.2g}'):g} {unit}"


def shafts_text(found: LaidOut, gears: Sequence[str]) -> str:
    """Shafts with their gears, by names in order of stages, and bearings."""
    stages = len(found.stages)
    names = _SHAFTS[stages]
    shafts = "\n".join(
        _placed_shaft(found, n, names, [(gears[2 * stage + member], stage) for stage, member in own])
        for n, own in enumerate(gears_on_shafts(stages))
    )
    bearings = "\n".join(
        _bearing(f"{name}_{role}", role, bearing, lasts=one.lasts)
        for name, one in zip(names, found.shafts, strict=True)
        for role, bearing in sorted(one.bearings.items(), key=lambda each: each[0] == "floating")
    )
    said = (
        "# Bearings by designation, chosen for the life above at the load above: dimensions by ISO 15, C by the SKF "
        "General\n# Catalogue. Values of your maker are better and belong to one designation, as of a 6306:\n"
        '# life = { dynamic_rating = "29.6 kN" }, catalogue = { static_rating = "16 kN" }; X, Y and e are of ISO 281.\n'
    )
    if any(one.tapered for one in found.shafts):
        said += (
            "# Tapered bearings against each other where a ball and a roller bearing would need a shaft thicker than "
            "the\n# root circle of its pinion: its teeth are cut into the shaft.\n"
        )
    return f"{shafts}\n{said}\n{bearings}"


def _bearing(name: str, role: str, bearing: ChosenBearing, *, lasts: bool) -> str:
    """A bearing by its designation, or by an assumed stiffness."""
    if not bearing.designation:
        stiffness = toml_string(amount(_PER_BORE * bearing.bore, "N/um"))
        return _STIFF.format(name=name, radial=stiffness, fixed="fixed = true\n" if role == "locating" else "")
    rated = _RATED_BY.get(role, "C, X, Y and e")
    return _BEARING.format(name=name, designation=bearing.designation, rated=rated, short="" if lasts else _SHORT)


def _placed_shaft(found: LaidOut, n: int, names: Sequence[str], gears: Sequence[tuple[str, int]]) -> str:
    """A shaft by its number, with its gears and their stages."""
    one: PlacedShaft = found.shafts[n]
    name = names[n]
    left, right = one.bearings
    away = sum(found.distances[:n])
    note = "" if n else "     # distances along it from its left end; places and sizes are assumed"
    coupling = "" if n else 'coupling = "0 mm"     # where the torque enters\n' + _TURNED
    if n == len(names) - 1:
        coupling = f'coupling = "{length(found.seats(n).length)}"\n'
    return _SHAFT.format(
        name=name, note=note, axis=f'axis = ["{length(away)}", "0 mm"]     # centre distance\n' if n else "",
        sections="\n".join(
            _SECTION.format(long=length(long), across=length(across))
            for long, across in sections(found.seats(n), one.thick)
        ),
        left=left, right=right, first=length(found.first), last=length(found.last[n]),
        reversed=", reversed = true" if one.tapered else "",
        gears=", ".join(f'{{ gear = "{gear}", at = "{length(found.middles[stage])}" }}' for gear, stage in gears),
        coupling=coupling,
    )  # fmt: skip
