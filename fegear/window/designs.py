"""Reliefs by theory for the case on the desk: those that leave no transmission error, and the nearest to grind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.errors import InputError
from fegear.results.relief_for_case import relief_for_case, what_it_leaves
from fegear.window.case_text import literal, value_at, with_value

if TYPE_CHECKING:
    from fegear.engine.run import Results
    from fegear.results.relief_for_case import How
    from fegear.window.jobs import Asked


def design_asked(asked: Asked, pair: str, how: How) -> Asked:
    """The case that is computed for a design: its result is ``relief``, for that pair.

    Raises
    ------
    InputError
        If reliefs to grind are wanted and the case allows no shape of them, or both gears are one.
    """
    from fegear.case.reading import parse_document

    document = parse_document(asked.text, f'"{asked.name}.toml"')
    driver, driven = (value_at(document, ("pair", pair, member)) for member in ("driver", "driven"))
    if driver == driven:
        raise InputError(
            f"pair.{pair}.driven", f'"{driven}"', "is the driver as well, and a design gives each its own relief",
            "give the driven gear a name of its own",
        )  # fmt: skip
    if how == "ground" and value_at(document, ("design", "grind")) == []:
        raise InputError(
            "design.grind", "[]", "allows no shape of relief to grind", 'write grind = ["linear", "parabolic"]'
        )
    text = with_value(asked.text, ("results",), '["relief"]')
    text = with_value(text, ("design", "pair"), literal(pair))
    if how == "exact":
        text = with_value(text, ("design", "grind"), "[]")
    return asked._replace(text=text)


def designed(results: Results, pair: str, how: How) -> dict[str, Any]:
    """Reliefs of both gears for the case, and what the page shows of them.

    Parameters
    ----------
    results : Results
        Of the case by `design_asked`.
    pair : str
    how : {"exact", "ground"}

    Returns
    -------
    dict
        ``reliefs`` by gear, as the case writes them (None: no relief); ``told``, what they leave, in a sentence;
        ``figures`` and ``darker`` for the page.
    """
    from fegear.engine.figure import Figure
    from fegear.output.draw_plotly import darker, plotly_json

    keys = (f"relief_candidates_{pair}", f"relief_{pair}")
    figures = [one for one in results.figures if isinstance(one, Figure) and one.key in keys]
    return {
        "pair": pair, "reliefs": relief_for_case(results, pair, how), "told": what_it_leaves(results, how),
        "figures": [{"key": f"designed-{one.key}", "heading": one.heading, "caption": one.caption, **plotly_json(one)}
                    for one in figures],
        "darker": darker(figures),
    }  # fmt: skip
