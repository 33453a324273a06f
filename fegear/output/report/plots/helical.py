"""Figures of helical pairs: transmission error, contact pattern, contact ellipses, modes, transmissibility."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.report.figure import COLOURS, DASHES, Figure, column, size
from fegear.output.report.plots.common import cells, table_named

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.outcome import Outcome
    from fegear.engine.stage import Task

_PHI = "pinion angle [°]"
_COMPONENTS = (
    ("y", "y"),
    ("z", "z"),
    ("theta_x", "θ<sub>x</sub>"),
    ("theta_y", "θ<sub>y</sub>"),
    ("theta_z", "θ<sub>z</sub>"),
)
#: Components below this share of the largest are zero but for round-off.
_ROUND_OFF = 1e-9


def tooth_contact(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the transmission error by leading pair, where one pair touches, and the contact ellipses."""
    name = task.subject
    table, single = table_named(outcome, f"tooth_contact_{name}"), table_named(outcome, f"tooth_contact_single_{name}")
    if table is None or single is None:
        return
    made = Figure(
        f"transmission_error_{name}", f"Transmission error of pair {name}",
        "Turn of the gear ahead of N1/N2 times the pinion's over one cycle: the pair that touches first leads. Grey: "
        "one pair alone.",
    )  # fmt: skip
    shown = np.asarray(next(c.shown for c in table.columns if c.name == "te"), dtype=float)
    room = max(0.6 * float(np.ptp(shown)), 1e-3)
    limits = float(shown.min()) - room, float(shown.max()) + room
    panel = made.panel(_PHI, "transmission error [arcsec]", limits=limits)
    panel.line(single, "phi1", "te", "one pair alone", colour="@grey", dash="dot")
    for number, pair in enumerate(cells(table, "pair")):
        panel.line(table, "phi1", "te", f"pair {pair} leads", number, where={"pair": pair}, dash="solid")
    yield made
    made = Figure(
        f"contact_path_{name}", f"Path of contact of pair {name}",
        "Where one tooth pair touches on the pinion's flank over its engagement, by kind of contact.",
    )  # fmt: skip
    panel = made.panel("height z on the pinion [mm]", "radius on the pinion [mm]")
    for number, kind in enumerate(kind for kind in cells(single, "contact") if kind != "none"):
        where = {"contact": kind}
        panel.points(
            single, "z1", "r1", kind, number, where, customdata=column(single, "phi1", where),
            hovertemplate="z %{x:.4~g} mm, radius %{y:.5~g} mm at %{customdata:.4~g}°",
        )  # fmt: skip
    made.shared = False
    yield made
    ellipses = table_named(outcome, f"contact_ellipses_{name}")
    if ellipses is not None:
        made = Figure(
            f"contact_ellipses_{name}", f"Contact ellipses of pair {name}",
            "Half axes and largest pressure where the flanks touch on their surfaces, one pair carrying the load.",
        )  # fmt: skip
        top, bottom = made.panel(_PHI, "half axes [mm]", log_y=True), made.panel(_PHI, "largest pressure [MPa]")
        top.points(ellipses, "phi1", "long", "long half axis", 0, marker={"size": 4})
        top.points(ellipses, "phi1", "short", "short half axis", 1, marker={"size": 4})
        bottom.points(ellipses, "phi1", "pressure", "pressure", 3, marker={"size": 4})
        yield made


def transmissibility(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the modal indices, and the size of G and R for excitations along y."""
    name = task.subject
    modes, table = table_named(outcome, f"helical_modes_{name}"), table_named(outcome, f"transmissibility_{name}")
    if modes is not None:
        made = Figure(
            modes.name, f"Modal indices of pair {name}",
            "Which modes a transmission error along the tooth normal or a bending one excites.",
        )  # fmt: skip
        panel = made.panel("mode", "modal index", categories=True)
        for number, (key, label) in enumerate(
            (("Delta_normal", "normal"), ("Delta_bending", "bending"), ("coupling", "coupling energy ratio"))
        ):
            panel.bars(modes, "mode", key, label, COLOURS[number], {"Lambda": ("min", 1e-9)})
        yield made
    if table is not None:
        made = Figure(
            table.name, f"Force transmissibility of pair {name}",
            "Mesh force per transmission error along y (top) and per external force along y (bottom), by component.",
        )  # fmt: skip
        frequency = "Λ = ω / √(K<sub>M</sub>/m<sub>eq</sub>)"
        named = {c.name: c for c in table.columns}
        for label, title in (("G", "|G| [N/µm]"), ("R", "|R|")):
            panel = made.panel(frequency, title, log_y=True)
            found = []
            for key, text in _COMPONENTS:
                pair = [n for n in (f"{label}_{key}_y_re", f"{label}_{key}_y_im", f"{label}_ii_{key}_y_re",
                                    f"{label}_ii_{key}_y_im") if n in named]  # fmt: skip
                if len(pair) == 2:
                    found.append((pair, text, max(float(np.abs(np.asarray(named[n].shown)).max()) for n in pair)))
            largest = max((f[2] for f in found), default=0.0)
            for number, (pair, text, top) in enumerate(found):
                if top > _ROUND_OFF * largest:
                    values = size(column(table, pair[0]), column(table, pair[1]))
                    look = {
                        "line": {"color": COLOURS[number % 6], "dash": DASHES[number % 6], "width": 4 - 0.6 * number}
                    }
                    panel.add(text, column(table, "Lambda"), values, **look)
        yield made
