"""Formulas of root stress, compliance and stiffness as people name them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen

#: Formulas of root stress as people name them, in the order in which an answer has them.
ROOT_FORMULAS = {
    "iso-6336-3": "ISO 6336-3", "agma-908": "AGMA 908", "cornell": "Cornell", "cornell-trochoid": "Cornell (trochoid)",
    "heywood": "Heywood", "dolan-broghamer": "Dolan and Broghamer",
}  # fmt: skip


#: The same of compliance.
COMPLIANCES = {
    "potential-energy": "potential energy", "potential-energy-simplified": "potential energy (no fillet)",
    "weber-banaschek": "Weber and Banaschek", "cornell": "Cornell",
}  # fmt: skip


def formula_called(seen: Seen) -> str:
    """A member of a family of formulas as people name it, for the legend of a figure."""
    return {**COMPLIANCES, **ROOT_FORMULAS, "iso-6336-1": "ISO 6336-1"}.get(seen.key, seen.key)
