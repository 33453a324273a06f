"""Phases of planets are compared with those of polygons at suns, rings and between both, each within its own limit."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.verify import polygons
from fegear.verify.gearboxes import planetary_phases

#: By sun and ring: places of three planets' meshes on the polygons.
SEEN = np.array([[0.1, 0.4, 0.7], [0.2, 0.8, 0.1]])


@pytest.mark.parametrize(
    ("sun", "ring", "delay", "holds"),
    [
        (0.0, 0.0, 0.0, True), (0.95e-10, 0.95e-5, 0.95e-5, True), (1.05e-10, 0.0, 0.0, False),
        (0.0, 1.05e-5, 0.0, False), (0.0, 0.0, 1.05e-5, False),
    ],
)  # fmt: skip
def test_each_phase_is_compared_with_its_polygons(monkeypatch, sun, ring, delay, holds):
    def phases(one):
        assert one == "described set"
        return Space(
            sun=SEEN[0, 0] - SEEN[0] + [0.0, 0.0, sun], ring=SEEN[1, 0] - SEEN[1] + [0.0, ring, 0.0],
            delays=np.array([5.0 + 0.0 * SEEN[0], 5.0 + SEEN[0] - SEEN[1] + [delay, 0.0, 0.0]]),
        )  # fmt: skip

    monkeypatch.setattr("fegear.dynamics.planetary.phases.mesh_phases", phases)
    monkeypatch.setattr(polygons, "SETS", ["set"])
    monkeypatch.setattr(polygons, "described", lambda one: f"described {one}")
    monkeypatch.setattr(polygons, "by_polygons", lambda one: SEEN)
    monkeypatch.setattr(polygons, "apart", lambda one, other: one - other)
    found = list(planetary_phases())
    assert len(found) == 9
    assert all(one.holds for one in found) is holds
    assert {one.allowed for one in found} == {1e-10, 1e-5}
