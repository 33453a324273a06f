"""A Hertz pressure is that of smooth, endless flanks: no report calls it exact."""

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES


def test_the_pressure_of_a_pair_that_carries_all_is_not_called_exact(tmp_path):
    """The load of a pair by itself has no error; half of none stood beside the pressure as `exact`."""
    (tmp_path / "case.toml").write_text(
        'title = "T"\nresults = ["load-sharing"]\n[gear.a]\nteeth = 28\nmodule = "3 mm"\nbore_radius = "20 mm"\n'
        'face_width = "10 mm"\n[pair.I]\ndriver = "a"\ndriven = "a"\nload = "1000 N"\n'
        "[accuracy]\ntolerance = 0.03\n",
        "utf-8",
    )
    scene = read_scene(tmp_path / "case.toml")
    results = run_plan(scene, make_plan(scene, STAGES))
    values = {value.name: value for outcome in results.outcomes.values() for value in outcome.values}
    assert values["I.largest_load"].error == 0.0
    assert values["I.largest_hertz_pressure"].error > 0.0
    assert values["I.largest_hertz_pressure"].si > 1e8
