"""Holes in a web against CalculiX: whole gears of 16 teeth over six holes on explicit meshes.

web_holes_calculix.json has what `make_web_holes_calculix.py` found: deflections and root stress under bands at five
places along the face of a tooth above a hole, of one between two, and of one a quarter of the way to the next on a web
off the middle; 120,000 nodes each. Seen: deflections .3 %, root tension .6 %.
"""

import importlib.util
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.fem.solid.tooth_over_holes import tooth_over_holes

_spec = importlib.util.spec_from_file_location("made_holes", Path(__file__).with_name("make_web_holes_calculix.py"))
made = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(made)
FOUND = json.loads(made.FILE.read_text())
SETTINGS = replace(SolidSettings().scaled(1.2), waves_per_module=3.0)


def solved(body):
    return solve_solid(made.TOOTH, 0.0, made.FACE, 0.3, made.BORE, SETTINGS, body=body)


def apart(which, tooth, solution):
    """Largest differences of deflections over each band's own, and of root tension over its largest."""
    one = tooth_over_holes(solution, tooth)
    own = [bands(made.RADIUS, top, top - low, 0.25, after=high - top) for low, top, high in map(made.hat, made.PLACES)]
    moved = np.array([[float(one.deflection(0, b, a)[0, 0]) for b in own] for a in own])
    tension = np.array([one.largest_root_stress(0, "tension", a, made.calculix.STATIONS)[0][:, 0] for a in own])
    wanted, stress = np.array(FOUND[which]["deflection"]), np.array(FOUND[which]["tension"])
    return (
        np.abs((moved - wanted) / np.diag(wanted)[:, None]).max(),
        np.abs((tension - stress) / stress.max(axis=1)[:, None]).max(),
    )


@pytest.mark.long  # the ordinary run has a web in the middle
def test_a_tooth_on_its_way_to_the_next_hole():
    """Asked are 1 % and 2 %; without the holes they are 15 % and 7 %."""
    moved, stress = apart("off", 0, solved(made.body("off")))
    assert moved < 0.005
    assert stress < 0.01


@pytest.mark.dear
def test_teeth_above_and_between_holes():
    """Both of one solution: four pitches on, a tooth above a hole has become one between two."""
    solution = solved(made.body("below"))
    for which, tooth in (("below", 0), ("between", 4)):
        moved, stress = apart(which, tooth, solution)
        assert moved < 0.005
        assert stress < 0.01
