"""Stage ``contact-lines``: the lines along which the flanks of an aligned helical pair touch, and their length."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.results.drawn_contact_lines import contact_lines_figures
from fegear.results.tooth_contact import check_misalignment

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.helical.contact_lines import LineContact, LineLength
    from fegear.helical.pair import HelicalPair


@dataclass(frozen=True, slots=True)
class ContactLinesInputs:
    """What the lines depend on.

    Parameters
    ----------
    pair : HelicalPair
        Aligned, flanks as designed.
    positions : int
        Pinion angles over a cycle.
    left_out : bool
        Whether the case has errors or a modification that the lines do without.
    name : str
        Of the pair.
    """

    pair: HelicalPair
    positions: int
    left_out: bool = field(compare=False)
    name: str = field(compare=False)


@dataclass(frozen=True, slots=True)
class ContactLinesData:
    """Lines of one tooth pair, and the length of all of them over a cycle."""

    pair: HelicalPair
    lines: LineContact
    length: LineLength


def _inputs(scene: Scene, name: str) -> ContactLinesInputs:
    from fegear.helical.contact_lines import aligned

    given = scene.helical_pairs[name]
    pair = aligned(given)
    return ContactLinesInputs(pair, scene.case.tooth_contact.positions, pair != given, name)


def _compute(asked: ContactLinesInputs, _upstream: Upstream, _work: Work) -> ContactLinesData:
    from fegear.helical.contact_lines import contact_lines, line_length

    return ContactLinesData(asked.pair, contact_lines(asked.pair), line_length(asked.pair, asked.positions))


def _lines_table(name: str, found: LineContact) -> Table:
    number = np.repeat(np.arange(1, found.phi_1.shape[0] + 1), found.phi_1.shape[1])
    columns = (
        ("phi1", found.phi_1, "deg", "pinion angle of this tooth pair: the first parameter"),
        ("u1", found.u_1, "mm", "length along the line from the pinion's base helix: the second parameter"),
        ("theta1", found.theta_1, "deg", "where around the pinion's base cylinder the line touches it"),
        ("u2", found.u_2, "mm", "length along the line from the gear's base helix"),
        ("theta2", found.theta_2, "deg", "where around the gear's base cylinder the line touches it"),
        ("phi2", found.phi_2, "deg", "gear angle"),
        ("z", found.z, "mm", "height, on both gears"),
        ("r1", found.r_1, "mm", "radius on the pinion"),
        ("r2", found.r_2, "mm", "radius on the gear"),
    )
    # The line of a spur gear is parallel to its base helix: it has no length from there.
    given = [Column(key, values.ravel(), unit, about) for key, values, unit, about in columns
             if np.isfinite(values).all()]  # fmt: skip
    return Table(
        f"contact_lines_{name}",
        (Column("line", number, "", "number of the line"), *given),
        f"Contact lines of pair {name}",
    )


def _present(data: ContactLinesData, asked: ContactLinesInputs) -> Outcome:
    name, pair, length = asked.name, data.pair, data.length
    tables = (
        _lines_table(name, data.lines),
        Table(
            f"contact_line_length_{name}",
            (
                Column("phi1", length.phi_1, "deg", "pinion angle"),
                Column("length", length.total, "mm", "total length of all lines of contact"),
                Column("pairs", length.lines, "", "tooth pairs in contact"),
            ),
            f"Total length of the contact lines of pair {name}",
        ),
    )
    play = float((data.lines.phi_2 - pair.ratio * data.lines.phi_1).mean())
    values = (
        Value(f"{name}.contact_line_mean", length.mean, "mm", 0.0, "mean total length of the contact lines"),
        Value(f"{name}.contact_line_least", length.least, "mm", 0.0, "least over a cycle"),
        Value(f"{name}.contact_line_largest", length.largest, "mm", 0.0, "largest over a cycle"),
        Value(
            f"{name}.aligned_transmission_error", play, "arcsec", 1e-15, "of the aligned pair, the same at all angles"
        ),
    )
    remarks = []
    if asked.left_out:
        remarks.append(
            f"Pair {name}: contact lines are those of the aligned pair with flanks as designed; errors of the case "
            "other than that of the centre distance, and its modification, leave points in place of lines."
        )
    if pair.pinion.helix_angle == 0.0:
        remarks.append(f"Pair {name}: lines of a spur gear are parallel to its axis, so that u1 and u2 do not exist.")
    figures = contact_lines_figures(name, data.pair, data.lines, length)
    return Outcome(data, tables, values, {"positions": asked.positions}, tuple(remarks), figures)


CONTACT_LINES = Stage(
    subjects=lambda scene: tuple(scene.helical_pairs),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_misalignment,
    effects=("misalignment",),
    cites=citing(Citation("litvin", "line contact of aligned helicoids", "Appendix 3, A.3.1 to A.3.9")),
    forecast=lambda scene, _name: Forecast({"positions": scene.case.tooth_contact.positions}, 0.02),
)
