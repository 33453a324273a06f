"""Materials of gears by name: elastic constants with their source, and the kind of steel as ISO 6336-5 calls it.

Strength numbers do not stand here: they depend on heat treatment, hardness and quality, which a name does not say.
"""

from __future__ import annotations

from dataclasses import dataclass

_STEEL = "steel, ISO 6336-2 (Z_E)"
_PLASTICS = "short-term, Encyclopedia of Physical Science and Technology (2001), Plastics Engineering, table I"


@dataclass(frozen=True, slots=True)
class NamedMaterial:
    """A material of a name.

    Parameters
    ----------
    name : str
        As it is usually written.
    young_modulus : float
        [Pa].
    poisson_ratio : float or None
        None where the source has none.
    density : float
        [kg/m^3].
    source : str
        Of these numbers.
    kind : str
        Material type of ISO 6336-5 as it is usually heat-treated; empty of plastics.
    """

    name: str
    young_modulus: float
    poisson_ratio: float | None
    density: float
    source: str
    kind: str = ""


#: Steels by the standard that lists them: EN 10084 (case hardening), EN 10083 (quenching and tempering), EN 10085
#: (nitriding), with those of JIS and AISI.
_STEELS = {
    "case-hardened-steel": (
        "16MnCr5 16MnCrS5 20MnCr5 20MnCrS5 17Cr3 18CrMo4 20MoCr4 15NiCr13 17CrNi6-6 18CrNiMo7-6 17CrNiMo6 20NiCrMo2-2 "
        "17NiCrMo6-4 14NiCrMo13-4 SCM415 SCM420 SCr420 SNCM220 8620 9310"
    ),
    "through-hardened-alloy-steel": (
        "42CrMo4 42CrMoS4 34CrMo4 25CrMo4 50CrMo4 34CrNiMo6 30CrNiMo8 36NiCrMo16 41Cr4 37Cr4 51CrV4 SCM435 SCM440 "
        "SCr440 SNCM439 4140 4340"
    ),
    "through-hardened-carbon-steel": "C35 C40 C45 C50 C55 C60 C45E C60E S45C S50C S55C 1045 1050",
    "nitrided-nitriding-steel": "31CrMo12 31CrMoV9 33CrMoV12-9 34CrAlNi7-10 34CrAlMo5-10 40CrMoV13-9 41CrAlMo7-10",
}
_NAMED = [
    *(
        NamedMaterial(name, 206e9, 0.3, 7850.0, _STEEL, kind)
        for kind, names in _STEELS.items()
        for name in names.split()
    ),
    NamedMaterial("POM", 2.9e9, None, 1410.0, _PLASTICS),
    NamedMaterial("PA66", 3.0e9, None, 1140.0, _PLASTICS),
    NamedMaterial("PA66-GF30", 9.5e9, None, 1300.0, _PLASTICS),
]
#: What materials are called besides.
_ALSO = {"polyacetal": "pom", "acetal": "pom", "delrin": "pom", "nylon66": "pa66", "polyamide66": "pa66"}
#: Begin of names that say only by whom a steel is listed.
_LISTED_BY = ("aisi", "sae", "din", "en", "jis")


def _plain(name: str) -> str:
    return "".join(sign for sign in name.lower() if sign.isalnum())


_BY_NAME = {_plain(one.name): one for one in _NAMED}
NAMES = tuple(one.name for one in _NAMED)


def named_material(name: str) -> NamedMaterial | None:
    """The material of a name, with or without blanks, hyphens and "AISI"; None of an unknown one."""
    text = _plain(name)
    text = next((text.removeprefix(list_) for list_ in _LISTED_BY if text.removeprefix(list_) in _BY_NAME), text)
    return _BY_NAME.get(_ALSO.get(text, text))
