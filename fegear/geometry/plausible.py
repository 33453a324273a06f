"""What gears, shafts and materials have: sizes beyond which a number is a slip of the unit."""

from __future__ import annotations

from fegear.base.errors import GeometryError

#: Modules of gears [m], from micromachined ones to the racks of jack-up rigs, twice over.
MODULES = (1e-6, 0.25)
#: Face widths in modules; the default of 1 mm is far below any, and fits the largest module.
FACE_WIDTHS = (4e-3, 300.0)
#: Young's moduli [Pa], from rubber to diamond, and densities [kg/m^3], from foam to osmium.
YOUNG_MODULI, DENSITIES = (1e6, 1.5e12), (10.0, 25e3)
#: Longest shaft in a gearbox, longest in a train (the propeller's), and thickest [m]; and how many times as thick as
#: the tip circle of its largest gear.
LONGEST_SHAFT, LONGEST_OF_TRAIN, THICKEST_SHAFT, THICKEST_BELOW_GEARS = 30.0, 300.0, 20.0, 5.0
#: Below this Young's modulus [Pa] there is no solid: the gear is one of pure numbers, of module 1 and modulus 1.
_NUMBERS = 1e3


def is_of_pure_numbers(young_modulus: float) -> bool:
    """Whether a gear of this Young's modulus [Pa] is one of pure numbers, which may have any size."""
    return young_modulus < _NUMBERS


def refuse_size(module: float, face_width: float, key: str = "module") -> None:
    """Refuse a module and a face width [m] that no gear has, which are numbers in another unit than SI.

    Raises
    ------
    GeometryError
        With the remedy.
    """
    _refuse(key, module, MODULES, "m", "gear modules", "a module of 3 mm is 3e-3 m")
    ends = (FACE_WIDTHS[0] * module, FACE_WIDTHS[1] * module)
    _refuse(
        "face_width", face_width, ends, "m", f"face widths for a module of {module * 1e3:.4g} mm", "20 mm are 20e-3 m"
    )


def refuse_shaft(length: float, diameter: float, longest: float = LONGEST_SHAFT) -> None:
    """Refuse a length and a diameter [m] that no shaft has: millimetres that were taken for metres.

    Raises
    ------
    GeometryError
        With the remedy; its key is "length" or "diameter".
    """
    for key, value, most in (("length", length, longest), ("diameter", diameter, THICKEST_SHAFT)):
        if not 0.0 <= value <= most:
            raise GeometryError(
                key, f"{value:.6g} m", f"exceeds the plausible maximum of {most:g} m",
                "check the unit: 40 mm are 40e-3 m in SI",
            )  # fmt: skip


def refuse_material(young_modulus: float, density: float) -> None:
    """Refuse a modulus [Pa] and a density [kg/m^3] that no solid has.

    Raises
    ------
    GeometryError
        With the remedy.
    """
    _refuse(
        "material.young_modulus",
        young_modulus,
        YOUNG_MODULI,
        "Pa",
        "Young's moduli of solids",
        "206.8 GPa are 206.8e9 Pa",
    )
    _refuse("material.density", density, DENSITIES, "kg/m^3", "densities of solids", "steel has 7850 kg/m^3")


def _refuse(key: str, value: float, ends: tuple[float, float], unit: str, what: str, remedy: str) -> None:
    if not ends[0] <= value <= ends[1]:
        raise GeometryError(
            key, f"{value:.6g} {unit}", f"is outside the range of {what}, {ends[0]:.3g} to {ends[1]:.3g} {unit}",
            f"check the unit: {remedy} in SI",
        )  # fmt: skip
