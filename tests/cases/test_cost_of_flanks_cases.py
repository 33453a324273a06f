"""What accuracy costs for a pair that is loaded over its face."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.solid_influence import solid_settings_of
from fegear.case.reading import build_scene, read_scene
from fegear.contact.wide.maker import load_flanks
from fegear.fem.solid.slices import solve_slices
from fegear.output.cost import write_cost
from fegear.studies.cost import knobs
from fegear.studies.cost.asked import asked
from fegear.studies.cost.ladder import ALONE, BODIES, FlankConfiguration, flank_ladder
from fegear.studies.cost.measure import solve_bodies
from fegear.studies.cost.quantities import OF_FLANKS
from fegear.studies.cost.study import ladder_of, study_cost

CASE = Path(__file__).parents[2] / "cases" / "helical_load.toml"
FOUR_SQUARE = CASE.with_name("nasa_four_square.toml")
NARROW = (
    'gear.pinion.face_width="6 mm"', 'gear.wheel.face_width="6 mm"', "load_distribution.positions=4",
    "load_distribution.panels=4",
)  # fmt: skip


@pytest.fixture(scope="module")
def results():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fegear.studies.cost.ladder._QUICK_REFERENCE", 6e-2)
        patch.setattr("fegear.studies.cost.ladder._QUICK_TOLERANCES", (1e-1,))
        return study_cost(asked(read_scene(CASE, NARROW)), quick=True)


@pytest.mark.long
def test_every_body_is_tried_with_and_without_neighbours(results):
    assert results.complete
    assert [q.name for q in results.quantities] == list(OF_FLANKS)
    families = {row.configuration.family for row in results.rows}
    assert families == {f"{body}{end}" for body in BODIES for end in ("", ALONE)}
    for row in results.rows:
        assert math.isfinite(row.miss.largest)
        assert results.shown_error(row) >= results.floors[row.quantity] > 0.0
        assert row.solve.cpu > 0.0
        assert row.own.cpu > 0.0


def error(results, family, quantity):
    """Of the finest settings with the case's panels."""
    rows = [r for r in results.of(quantity) if r.configuration.family == family and r.configuration.panels == 4]
    return min(rows, key=lambda row: row.configuration.factor).miss.largest


@pytest.mark.long
def test_slices_and_pairs_that_stand_alone_err_more_than_solid_gears(results):
    solid = error(results, "solid", "te-mean")
    assert solid < 0.01
    for family in ("thin-slices", f"thin-slices{ALONE}", "coupled-slices", f"solid{ALONE}"):
        assert error(results, family, "te-mean") > 3.0 * solid, family


@pytest.mark.long
def test_a_configuration_is_charged_once_for_all_quantities(results):
    whole = {row.configuration: row.seconds.cpu for row in results.at_once()}
    assert len(whole) == results.planned
    for row in results.rows:
        assert row.seconds.cpu == pytest.approx(whole[row.configuration], rel=1e-12)


@pytest.mark.long
def test_its_values_are_those_of_a_run(results):
    """A configuration's numbers are those of the case's pair under its load, with such gears and as many panels."""
    rows = {row.quantity: row for row in results.rows if row.configuration.label.startswith("coupled slices, ")}
    one = rows["te-mean"].configuration
    assert isinstance(one, FlankConfiguration)
    scene = read_scene(CASE, [*NARROW, f"load_distribution.panels={one.panels}"])
    bodies = solve_bodies(scene, "I", "coupled-slices", one.solid)
    found = load_flanks(pair_spec(scene, "I"), bodies, SolutionCache())[2]
    assert rows["te-mean"].value == pytest.approx(found.mean_transmission_error[0], rel=1e-12)
    assert rows["te-peak-to-peak"].value == pytest.approx(np.ptp(found.transmission_error), rel=1e-12)
    assert rows["face-load-factor"].value == pytest.approx(found.face_load_factor[0], rel=1e-12)


@pytest.mark.long
def test_page_and_tables_are_written(results, tmp_path):
    write_cost(results, tmp_path, plots=False)
    head, *lines = (tmp_path / "tables" / "cost.csv").read_text().splitlines()
    assert "panels" in head
    assert len([line for line in lines if line.startswith(OF_FLANKS)]) == len(results.rows)
    page = (tmp_path / "report.html").read_text()
    assert all(f"Cost of {name}" in page for name in OF_FLANKS)


def test_what_can_be_pasted_asks_a_case_for_it():
    document = tomllib.loads(CASE.read_text())
    pasted = 0
    for one in flank_ladder(16).configurations:
        lines = one.paste("I")
        assert isinstance(one, FlankConfiguration)
        for line in lines.splitlines():
            key, value = line.split(" = ")
            *path, last = key.split(".")
            part = document
            for name in path:
                part = part.setdefault(name, {})
            part[last] = tomllib.loads(f"x = {value}")["x"]
        if not lines:
            continue
        scene = build_scene(document, "pasted", CASE.parent)
        settings, wanted = solid_settings_of(scene, "pinion"), pair_spec(scene, "I")
        assert settings.source == ("slices" if one.body == "coupled-slices" else "solid")
        assert settings.section == one.solid.section
        assert wanted.wide is not None
        assert (wanted.wide.panels, wanted.neighbour_coupling) == (one.panels, one.neighbours)
        pasted += 1
    assert pasted == 8


def test_a_study_is_of_the_face_or_of_the_plane():
    def over_face(case, *overrides):
        return asked(read_scene(case, overrides)).over_face

    assert over_face(CASE)
    assert over_face(CASE, 'results=["transmission-error"]')
    assert over_face(CASE, 'cost.pair="I"', 'cost.quantities=["te-peak-to-peak"]')
    assert not over_face(FOUR_SQUARE)
    with pytest.raises(InputError, match="applies to a 3D pair and cannot be combined"):
        over_face(CASE, 'cost.quantities=["te-mean", "c_0"]')
    with pytest.raises(InputError, match=r"effects\.hertz"):
        over_face(CASE, 'effects.hertz="none"', 'cost.pair="I"')
    instead = asked(read_scene(CASE, ['effects.hertz="none"']))
    assert not instead.over_face
    assert "effects.hertz" in instead.notes[0]
    with pytest.raises(InputError, match="must be a loaded spur pair"):
        over_face(CASE, 'results=["stiffness"]', 'cost.pair="I"', 'cost.quantities=["tooth-force"]')


def test_slices_of_a_ring_are_refused_and_left_out_of_its_ladder():
    """`fegear cost` on a helical planet and ring ended in a complex number: the laws know no bore beyond the root."""
    ring = read_scene(CASE.with_name("helical_planet_and_ring.toml"), ())
    gear = ring.gears["ring"]
    with pytest.raises(RangeError, match='is not available with width = "slices"'):
        solve_slices(
            gear.tooth, gear.twist * gear.module, gear.face_width / gear.module, 0.3, gear.bore_radius / gear.module,
            solid_settings_of(ring, "ring"),
        )  # fmt: skip
    for scene, known in ((ring, False), (read_scene(CASE, ()), True)):
        families = {one.family for one in ladder_of(asked(scene), quick=True).configurations}
        assert ("coupled-slices" in families) is known
        assert {"thin-slices", "solid"} < families


def test_slices_are_no_knob_of_a_gear_on_a_web(monkeypatch):
    """`fegear cost` on an inclined web ended with a refusal of slices after all else had been measured."""
    monkeypatch.setattr(knobs, "_varied", lambda _asked, _settings, name, *_: [name])
    for case, known in (("inclined_web", False), ("web_holes", False), ("spur_over_the_face", True)):
        names = knobs.solid_knobs(asked(read_scene(CASE.with_name(f"{case}.toml"), ())))
        assert ("edges of the section, slices" in names) is known
        assert "edges of the section" in names
