"""What was tried where a number of a paper differs: each trial is run again and gives what the page says."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import source_tried  # noqa: E402

#: Items whose trials take less than a second each; those of Lin's sweeps and charts take ten seconds and more.
QUICK = {("lin_townsend_oswald", "Fig. 6b"), ("blankenship_singh", "Table 1"), ("mark", "Eqs. 5.5-5.10")}
DEAR = {"blankenship_singh", "mark"}
TRIALS = list(source_tried.trials())


def marks(trial):
    if (trial.paper, trial.row.covers[0]) in QUICK:
        return []
    return [pytest.mark.dear if trial.paper in DEAR else pytest.mark.long]


@pytest.mark.parametrize("trial", [pytest.param(t, marks=marks(t), id=t.name) for t in TRIALS])
def test_a_trial_gives_what_the_page_says(trial):
    assert trial.faults() == []


def test_trials_are_told_apart():
    names = [trial.name + trial.row.shows for trial in TRIALS]
    assert len(set(names)) == len(names)
