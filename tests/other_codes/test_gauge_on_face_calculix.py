"""Gauges on loaded helical gears against stresses that CalculiX found on their fillets (kept with `verify`)."""

import numpy as np
import pytest

from fegear.contact.wide.root_stress import rooted_lines
from fegear.fem.plane.gauge import Grid
from fegear.fem.solid.gauge import grid_on_face
from fegear.geometry.pair import MEMBERS
from fegear.verify.calculix import _flanks, _steps


@pytest.mark.dear
def test_stress_at_places_along_the_face_is_that_of_calculix():
    """Point gauges where the fillet's largest tension is, at fifteen places along the face of both gears."""
    pair, gears = _flanks()
    stations, m = np.linspace(-1.4, 1.4, 15) * 1e-3, pair.driver.module
    step, lines, contact = next(iter(_steps("fillets")))
    force = contact.force[:, :, 0]
    scale = 900.0 / sum(map(sum, step["quarters"].values()))
    for member in MEMBERS:
        rooted = rooted_lines(pair, member, lines, gears[member], coupling=True)
        worst = rooted.stress("tension", force, stations)
        fillet = gears[member].fillets["tension"]
        arc_of = np.interp(worst.radius / m, np.hypot(*fillet.place), fillet.arc)
        found = []
        for place, z in enumerate(stations):
            row = int(worst.value[:, place].argmax())
            grid = grid_on_face(gears[member], "tension", Grid(0.0, 0.0, 0.0), arc_of[row, [place]] * m, z, m)
            surface = rooted.surface("tension", force, grid.zeta * m) / m**2
            found.append(grid.means(surface, pair.gear(member).material, plane_strain=False)[1][0, row] * 1e-6)
        theirs = np.max([v for key, v in step["root_stress"].items() if key.startswith(f"{member} tension")], axis=0)

        inner = slice(1, -1)
        assert np.array(found)[inner] == pytest.approx(theirs[inner] * scale, rel=0.03)
