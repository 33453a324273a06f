"""Sources that several results share."""

from fegear.engine.citation import Citation

RING = (
    Citation("thomas", "one tooth sector stands for the whole ring: harmonics of a cyclic structure"),
    Citation("gmsh", "mesh of the tooth"),
)
PATCH = Citation("johnson", "the contact's own deformation, and the swap of its half-width", "sections 4.2(c) and 5.6")
HERTZ = Citation("hertz", "half-width and pressure of the contact")
INVOLUTE = Citation("iso-21771", "names and geometry of involute gears and pairs")
CLOSED_FORM_COMPLIANCES: dict[str, tuple[Citation, ...]] = {
    "cornell": (
        Citation("cornell", "compliance of tooth and foundation"),
        Citation("lin-huston-coy", "the form in which it is computed", "Eqs. 5 to 11"),
        Citation("lundberg-palmgren", "approach of the teeth"),
    ),
    "weber-banaschek": (Citation("weber-banaschek", "compliance of tooth, foundation and contact"),),
    "potential-energy": (
        Citation("yang-lin", "bending, axial and contact compliance"),
        Citation("tian", "shear compliance"),
        Citation("wan", "beam that starts on the root circle and follows the fillet"),
        Citation("sainsot", "compliance of the gear body", "Eqs. 14 and 15, Table 1"),
    ),
}
_CORNELL_STRESS = (
    Citation("cornell", "root stress"),
    Citation("mark", "the form in which Cornell's formula is computed", "Eqs. B.1 to B.10"),
)
_HEYWOOD = Citation("heywood", "fillet stress of a loaded projection")
ROOT_STRESS_CITATIONS: dict[str, tuple[Citation, ...]] = {
    "fe": RING,
    "cornell": _CORNELL_STRESS,
    "cornell-trochoid": _CORNELL_STRESS,
    "heywood": (_HEYWOOD, Citation("kelley-pedersen", "Heywood's formula for gear teeth")),
    "iso-6336-3": (Citation("iso-6336-3", "Y_F, Y_S and nominal root stress", "method B, clauses 5 to 9"),),
    "agma-908": (Citation("agma-908", "geometry factor J", "section 5"),),
    "dolan-broghamer": (
        Citation("dolan-broghamer", "stress concentration in the fillet"),
        Citation("lewis", "section of a beam of uniform strength"),
    ),
}
ROOT_STRESS_FORMULAS = tuple(
    dict.fromkeys(one for name, found in ROOT_STRESS_CITATIONS.items() if name != "fe" for one in found)
)
