"""What a whole gear is sewn from, in which order and where; the kernel only writes down what it is asked for."""

import itertools
from types import SimpleNamespace

import pytest

from fegear.fem.solid import step_model
from fegear.fem.solid.step_model import _build


class Kernel:
    """Numbers for what is added, and what it is made of."""

    def __init__(self):
        self.tags, self.loops, self.faces, self.turned, self.moved = itertools.count(1), {}, [], [], []

    def copy(self, shapes):
        return [(kind, 1000 + tag) for kind, tag in shapes]

    def rotate(self, shapes, *given):
        self.turned.append((list(shapes), given))

    def translate(self, shapes, *given):
        self.moved.append((list(shapes), given))

    def addCircle(self, *given):
        self.circle = given
        return 500

    def extrude(self, shapes, *way):
        self.extruded = shapes, way
        return [(1, 501), (2, 502), "more"]

    def addCurveLoop(self, curves):
        self.loops[tag := 600 + len(self.loops)] = list(curves)
        return tag

    def addPlaneSurface(self, loops):
        self.faces.append([self.loops[one] for one in loops])
        return 700 + len(self.faces)

    def addSurfaceLoop(self, faces, *, sewing):
        self.sewn = list(faces), sewing
        return 800

    def addVolume(self, shells):
        self.volume = shells


@pytest.mark.parametrize("internal", [False, True])
def test_caps_have_their_outer_loop_first_and_the_upper_one_is_turned_by_the_helix(internal, monkeypatch):
    kernel = Kernel()
    monkeypatch.setattr(step_model, "_surface", lambda occ, spline, scale, helix: 10 + spline)
    monkeypatch.setattr(step_model, "_edge", lambda occ, spline, scale, helix: 20 + spline)
    gear = SimpleNamespace(face_width=0.03, twist=7.0, teeth=2, tooth=SimpleNamespace(internal=internal))
    _build(kernel, gear, (0, 1), 3.0, "helix", 12.5)
    assert kernel.circle == (0.0, 0.0, -15.0, 12.5)
    assert kernel.extruded == ([(1, 500)], (0.0, 0.0, 30.0))
    *_, (edges, turn) = kernel.turned
    ((again, move),) = kernel.moved
    assert edges == again
    assert turn == (0, 0, 0, 0, 0, 1, pytest.approx(0.21))
    assert move == (0, 0, 30.0)
    # Two teeth of two halves, the copies 1000 higher; those at the top once more. A loop leads up and down each tooth.
    low = [20, 21, 1020, 1021]
    loops = [low, [1000 + tag for tag in low]]
    for cap, ring, hole in zip(kernel.faces, loops, ([500], [501]), strict=True):
        assert [sorted(one) for one in cap] == ([hole, sorted(ring)] if internal else [sorted(ring), hole])
    assert kernel.sewn == ([10, 11, 1010, 1011, 701, 702, 502], True)
    assert kernel.volume == [800]
