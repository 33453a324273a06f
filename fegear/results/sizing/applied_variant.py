"""A variant in the table of a run made a case of its own: teeth of the variant, all else as the requirement says."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.base.errors import InputError
from fegear.design.sizing.space import Variant, VariantRelief
from fegear.results.sizing.variant_case import case_of_variant, text_of_case

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.engine.table import Table

#: What the case of a variant computes.
_RESULTS = ("geometry", "transmission-error", "root-stress-history", "rating")


def _relief(rows: Mapping[str, Any], n: int) -> VariantRelief | None:
    """Tip relief of a variant, where one was searched and is better than none."""
    amount = float(rows["relief_amount"][n]) if "relief_amount" in rows else 0.0
    if not amount > 0.0:
        return None
    return VariantRelief(amount, (float(rows["relief_length_1"][n]), float(rows["relief_length_2"][n])))


def text_of_variant(
    document: Mapping[str, Any], tables: Mapping[str, Table], number: int, source: str
) -> tuple[str, str]:
    """The text of the case of a variant, and what it is in a sentence.

    Parameters
    ----------
    document : mapping
        The case of the run.
    tables : mapping of str to Table
        Of the run.
    number : int
        Of the variant in the table `sizing`; 0 for the best.
    source : str
        Folder of the run, for the remark.

    Raises
    ------
    InputError
        If the run has no sizing, or no such variant.
    """
    asked, table = document.get("sizing"), tables.get("sizing")
    if not isinstance(asked, dict) or table is None:
        raise InputError("RESULTS", f'"{source}"', "has no sizing", "run fegear size first")
    rows = {column.name: column.si for column in table.columns}
    numbers = [int(one) for one in rows["variant"]]
    if number and number not in numbers:
        shown = ", ".join(map(str, numbers[:8]))
        raise InputError("--variant", number, "is not in the table of variants", f"for example {shown}")
    n = numbers.index(number) if number else 0

    def of(name: str) -> float:
        return float(rows[name][n])

    addendum = of("addendum")
    one = Variant(
        (round(of("z_1")), round(of("z_2"))), (of("x_1"), of("x_2")), (of("tip_diameter_1"), of("tip_diameter_2")),
        of("normal_module"), of("pressure_angle"), of("helix_angle"), addendum,
        addendum + float(asked.get("root_clearance", 0.25)), float(asked.get("rack_tip_radius", 0.38)),
        of("centre_distance"), of("face_width"), _relief(rows, n),
    )  # fmt: skip
    made = case_of_variant(asked, one, _RESULTS)
    made["title"] = f"{document.get('title') or 'Sizing'}: variant {numbers[n]}"
    return text_of_case(made, f"Variant {numbers[n]} of {source}."), f"variant {numbers[n]} ({made['title']})"
