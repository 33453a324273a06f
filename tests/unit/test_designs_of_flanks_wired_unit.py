"""How designs of 3D flanks put their parts together, with the parts made up: what is read, judged and made of what."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.fourier import Panels
from fegear.contact.wide.gaps import FlankGaps
from fegear.design.flanks import flank_design, judge, lead_correction, tip_bench, tip_design
from fegear.design.flanks.flank_design import _classes_finer
from fegear.design.flanks.judge import FlankJudge
from fegear.design.flanks.scatter import NOMINAL, normal_scatter
from fegear.design.flanks.trials import Tries
from fegear.design.load_range import LoadRange
from fegear.geometry.relief import UNMODIFIED, EndRelief

ONE_LOAD, LOADS = 200.0, (100.0, 200.0, 400.0)
LINES = SimpleNamespace(x=np.zeros((8, 3)))
WAVE = np.cos(2.0 * np.pi * np.arange(8) / 8.0)


@dataclass(frozen=True)
class Trials:
    """Flanks on which a gap leaves a wave as high as the mean gap, times the load, times a number of their own."""

    known: object
    loads: np.ndarray
    apart: object = None
    scale: float = 1.0
    scatter: object = NOMINAL
    weights: object = None
    tip_power: float = 1.0
    pair: object = "pair"

    def gap(self, numbers):
        return np.full((8, 3), float(numbers[0]))

    def of_gap(self, gap):
        high = np.outer(1.0 + np.abs(self.scatter.over_face), self.loads) * self.scale * (1.0 + gap.mean())
        return SimpleNamespace(te=WAVE[:, None] * high[:, None], peak_to_peak=2.0 * high)

    def of_numbers(self, numbers, near=None):
        return self.of_gap(self.gap(numbers))


class Apart:
    """Gaps that say of what they were asked."""

    def at(self, pair, lines, loads=None):
        return pair, lines, None if loads is None else loads.tolist()


def four():
    known = SimpleNamespace(lines=LINES)
    return [Trials(known, np.array([1.0, 3.0]), scale=scale) for scale in (1.0, 1.1, 1.4, 0.8)]


# ---- judges ----------------------------------------------------------------------------------------------------------
def test_a_judge_says_what_is_left_aligned_as_given_and_how_much_that_is_off():
    """Misalignments of its trials do not count; the error has half of what fewer positions and longer panels change."""
    trials = [replace(one, scatter=normal_scatter(1.0, 3)) for one in four()]
    te, error = FlankJudge(*trials, 0.0).left(lambda lines: np.full(lines.x.shape, 0.5))
    assert te == pytest.approx(1.5 * np.outer(WAVE, [1.0, 3.0]))
    assert error == pytest.approx(1.5 * 2.0 * np.array([1.0, 3.0]) * (0.5 * 0.1 + 0.5 * 0.3 + 0.3))


def test_a_judge_under_other_loads_has_its_parts_where_they_were():
    other = FlankJudge(*four(), 2e-6).under(np.array([7.0]), Apart())
    each = other.dense, other.plain, other.thin, other.soft
    assert [one.scale for one in each] == [1.0, 1.1, 1.4, 0.8]
    assert [one.apart for one in each] == [("pair", LINES, [7.0])] * 4
    assert [one.loads.tolist() for one in each] == [[7.0]] * 4
    assert other.deviation == 2e-6


def test_a_judge_looks_at_more_positions_shorter_panels_and_coarser_gears(monkeypatch):
    pair = SimpleNamespace(driver=SimpleNamespace(module=3e-3))
    flanks = SimpleNamespace(
        pair=pair, panel=0.5, most_gap=7e-6, gears="gears", coupling="coupling", hertz="hertz", cache="cache"
    )
    monkeypatch.setattr(judge, "edge_reach", lambda pair, gap: ("reach", gap))
    monkeypatch.setattr(
        judge, "roll_points", lambda pair, count, reach: SimpleNamespace(
            x=(count, reach), weights=np.array([2.0, 4.0]), period=8.0),
    )  # fmt: skip
    monkeypatch.setattr(judge, "contact_lines", lambda pair, *given: given)
    monkeypatch.setattr(judge, "flank_compliance", lambda pair, gears, lines, load, **how: (gears, lines, load, how))
    monkeypatch.setattr(judge, "FlankTrials", lambda pair, known, apart, loads: (known, apart, loads.tolist()))
    found = judge.flank_judge(flanks, "coarse", Apart(), 200.0, 3e-6)
    assert found.deviation == 3e-6
    how = {"coupling": "coupling", "hertz": "hertz", "cache": "cache"}
    for one, (count, panel, gears) in zip(
        (found.dense, found.plain, found.thin, found.soft),
        ((192, 1.5e-3, "gears"), (48, 1.5e-3, "gears"), (48, 0.375e-3, "gears"), (48, 1.5e-3, "coarse")),
        strict=True,
    ):
        (made_of, lines, load, kept), apart, loads = one
        assert (made_of, load, kept, loads) == (gears, 200.0, how, [200.0])
        assert lines[0] == (count, ("reach", 7e-6))
        assert lines[1] == pytest.approx(panel, rel=1e-12)
        assert lines[2].tolist() == [0.25, 0.5]
        assert lines[3] == 7e-6
        assert apart == (pair, lines, None)


# ---- tip reliefs -----------------------------------------------------------------------------------------------------
def test_gaps_without_tips_keep_what_else_holds_flanks_apart():
    relief = EndRelief(1e-5, 0.3, 0.4, 1.0)
    gaps = FlankGaps(
        relief, relief, driver_spacing=np.ones(3), driven_spacing=np.ones(4), tilt=1e-5, line_gap=(0.0, 1e-6)
    )
    found = tip_bench.without_tips(gaps)
    assert (found.driver_relief, found.driven_relief) == (UNMODIFIED, UNMODIFIED)
    assert (found.driver_spacing.size, found.driven_spacing.size) == (0, 0)
    assert (found.tilt, found.line_gap) == (gaps.tilt, gaps.line_gap)


def test_reliefs_are_read_on_96_positions_and_their_error_on_24(monkeypatch):
    @dataclass(frozen=True)
    class Flanks:
        pair: str = "pair"
        panel: float = 0.5
        gears: str = "gears"
        most_gap: float = 7e-6

        def compliance(self, load, x):
            return SimpleNamespace(lines=(load, x, self.panel, self.gears))

    monkeypatch.setattr(tip_bench, "edge_reach", lambda pair, gap: (pair, gap))
    monkeypatch.setattr(tip_bench, "roll_points", lambda pair, count, reach: SimpleNamespace(x=(count, reach)))
    monkeypatch.setattr(
        tip_bench, "FlankTrials", lambda pair, known, apart, loads: (known.lines, apart, loads.tolist())
    )
    found = tip_bench.tip_reader(Flanks(), "coarse", Apart(), 300.0)
    reach = ("pair", 7e-6)
    assert found.points.x == (96, reach)
    for one, (count, panel, gears) in zip(
        (found.dense, found.plain, found.thin, found.soft),
        ((96, 0.5, "gears"), (24, 0.5, "gears"), (24, 0.25, "gears"), (24, 0.5, "coarse")),
        strict=True,
    ):
        lines = (300.0, (count, reach), panel, gears)
        assert one == (lines, ("pair", lines, [300.0]), [300.0])


def test_other_gaps_are_read_in_place_of_those_without_reliefs(monkeypatch):
    monkeypatch.setattr(tip_bench, "fourier_series", lambda points, te, count: te)
    seen = []
    monkeypatch.setattr(Trials, "of_gap", lambda one, gap: seen.append((one.apart, gap.any())) or SimpleNamespace(
        te=np.zeros((1, 8, 2))))  # fmt: skip
    reader = tip_bench.TipReader("points", *four())
    reader.read(apart=Apart())
    assert seen == [(("pair", LINES, [1.0, 3.0]), False)] * 4


class Tolerance:
    """Tolerances that add to the first number what they are, halved by each class."""

    finest = 6

    def __init__(self, size):
        self.size = size

    def finer(self, classes):
        return Tolerance(self.size * 0.5**classes)


TOLERANCE = Tolerance(0.4)


def _task(over=None, grind=("linear", "parabolic"), map_loads=()):
    return tip_design.TipDesignTask(ONE_LOAD, over, grind, TOLERANCE, map_loads)


def test_loads_that_count_and_by_what():
    single, several = _task(map_loads=(50.0, 400.0)), _task(LoadRange((100.0, 400.0), (0.5, 1.0)), map_loads=(50.0,))
    assert single.loads == (50.0, 200.0, 400.0)
    assert single.counts.tolist() == [False, True, False]
    assert single.proportions.tolist() == [1.0]
    assert several.loads == (50.0, 100.0, 200.0, 400.0)
    assert several.counts.tolist() == [False, True, False, True]
    # A small load counts by how much smaller it is, and by its weight.
    assert several.proportions.tolist() == [4.0 * 0.5, 1.0]


@pytest.fixture
def designed(monkeypatch):
    """Design with searches that find a gap by shape and loads; what is left grows with the first number."""
    slopes: dict[str, float] = {}
    seen, points = [], Panels(np.arange(8) / 8.0, np.full(8, 0.125), 1.0, np.array([0.0, 1.0]))
    known = SimpleNamespace(lines=LINES)
    reader = tip_bench.TipReader(points, *(Trials(known, np.array([ONE_LOAD]), scale=s) for s in (1.0, 1.1, 1.4, 0.8)))

    class Searched:
        def over(self, over, power, apart):
            return over, power, apart

    def best(trials):
        over, power, apart = trials
        seen.append((over, power, apart.driver_relief))
        first = (-0.3 if power == 1.0 else -0.4) * (1.0 if over.loads == (ONE_LOAD,) else 0.5)
        return SimpleNamespace(relief=SimpleNamespace(numbers=np.array([first])))

    monkeypatch.setattr(
        tip_design, "tip_trials", lambda flanks, known, apart, load: seen.append((known, load)) or Searched()
    )
    monkeypatch.setattr(
        tip_design, "tip_reader", lambda flanks, coarse, apart, load: seen.append((coarse, load)) or reader
    )
    monkeypatch.setattr(tip_design, "best_tips", best)

    def within(trials, pair, numbers, tolerance):
        """By the reliefs' size and the shape; at the last load more."""
        assert trials.scale == 1.1
        off = tolerance.size * np.linspace(1.0, 1.5, trials.loads.size) * trials.tip_power
        return np.array([numbers + one for one in off])

    def unrelieved(trials, pair, numbers, tolerance):
        """Straight slopes by the size of the tolerances; none unless a test says so."""
        assert (trials.tip_power, trials.scale) == (1.0, 1.1)
        return np.full((trials.loads.size, 1), slopes.get("part", 0.0) * tolerance.size)

    monkeypatch.setattr(tip_design, "within_tolerances", within)
    monkeypatch.setattr(tip_design, "unrelieved_within", unrelieved)
    monkeypatch.setattr(
        tip_design,
        "decisive_tolerances",
        lambda trials, pair, numbers, tolerance, most: (trials.tip_power, numbers, most),
    )

    def made(task, present=False, **more):
        said = []
        slopes.update(more)
        gaps = FlankGaps(EndRelief(1e-5, 0.3, 0.4, 1.0), driver_spacing=np.ones(3))
        monkeypatch.setattr(FlankGaps, "at", lambda gaps, pair, lines, loads: (gaps, lines, loads.tolist()))
        found = tip_design.design_tips(
            SimpleNamespace(pair="pair"), "coarse", "known", gaps, task, present=present, progress=said.append
        )
        return found, said, seen

    return made


def test_a_design_of_tips_for_a_range_has_each_shape_for_it_and_for_one_load(designed):
    task = _task(LoadRange((100.0, 400.0)))
    found, said, seen = designed(task, present=True)
    assert seen[:2] == [("known", ONE_LOAD), ("coarse", ONE_LOAD)]
    one = LoadRange((ONE_LOAD,))
    assert seen[2:] == [(over, power, UNMODIFIED) for power in (1.0, 2.0) for over in (task.over, one)]
    assert said == pytest.approx([0.2, 0.5, 0.75, 1.0])
    loads = np.array(LOADS)
    for label, first in (
        ("no relief", 0.0), ("present relief", 0.0), ("linear tip relief", -0.15), ("parabolic tip relief", -0.2),
        ("linear tip relief for one load", -0.3), ("parabolic tip relief for one load", -0.4),
    ):  # fmt: skip
        assert found.left[label].peak_to_peak == pytest.approx(2.0 * loads * (1.0 + first)), label
    assert len(found.left) == 6
    for shape, first, off in (("linear", -0.15, 0.4), ("parabolic", -0.2, 0.8)):
        assert found.most[shape] == pytest.approx(2.0 * loads * (1.0 + first + off * np.array([1.0, 1.25, 1.5])))
    assert (list(found.found), list(found.for_one_load)) == (["linear", "parabolic"], ["linear", "parabolic"])
    # As drawn parabolas leave less; within tolerances lines clearly do, and they are read for the finer classes.
    assert found.shapes == ["linear", "parabolic"]
    assert found.decisive[0] == 1.0
    assert found.decisive[1].tolist() == [-0.15]
    assert found.decisive[2] == pytest.approx(found.most["linear"])
    # 0.4 halved twice, times 1.5 at the last load that counts, is 0.15: no more than no relief.
    assert found.finer == 2
    assert found.points.period == 1.0


def test_a_design_of_tips_for_one_load_has_nothing_besides_and_counts_that_load_only(designed):
    found, said, seen = designed(_task(grind=("parabolic",), map_loads=(100.0, 400.0)))
    assert seen[2:] == [(LoadRange((ONE_LOAD,)), 2.0, UNMODIFIED)]
    assert list(found.left) == ["no relief", "parabolic tip relief"]
    assert found.for_one_load == {}
    assert said == pytest.approx([0.2, 0.5, 1.0])
    # At the design load 1 - 0.4 + 0.8 * 1.25 / 4 is above 1, an eighth is not; at the largest load a quarter is enough.
    assert found.finer == 2
    assert found.decisive[0] == 2.0


def test_relief_within_tolerances_is_compared_with_no_relief_of_the_same_tolerances(designed):
    """It was compared with exact flanks: "smaller without relief", which are as far off when they are made."""
    task = _task(LoadRange((100.0, 400.0)), grind=("linear",))
    found, *_ = designed(task, part=1.0)
    assert found.unrelieved_most == pytest.approx(2.0 * np.array(LOADS) * 1.4)
    assert found.finer == 1  # 1 - 0.15 + 1.5 * 0.2 is below 1 + 0.2, but not for 0.4
    assert designed(task, part=2.0)[0].finer == 0
    slack, *_ = designed(task, part=-1.0)  # at least what exact flanks leave
    assert slack.unrelieved_most == pytest.approx(2.0 * np.array(LOADS))
    assert slack.finer == 2


def test_a_present_relief_is_read_without_spacing_errors(designed, monkeypatch):
    read = []
    monkeypatch.setattr(
        tip_bench.TipReader, "read",
        lambda reader, numbers=None, apart=None: read.append(apart) or SimpleNamespace(peak_to_peak=np.ones(1)),
    )  # fmt: skip
    designed(_task(), present=True)
    (present,) = (one for one in read if one is not None)
    assert present.driver_relief != UNMODIFIED
    assert (present.driver_spacing.size, present.driven_spacing.size) == (0, 0)


# ---- classes of flank designs ----------------------------------------------------------------------------------------
def test_flanks_pay_within_finer_classes_or_as_they_are(monkeypatch):
    known = SimpleNamespace(lines=LINES)
    over = SimpleNamespace(searched="searched", judge=SimpleNamespace(dense=Trials(known, np.array([1.0, 2.0]))))
    monkeypatch.setattr(
        flank_design, "within_tolerances",
        lambda trials, pair, numbers, tolerance: np.array([numbers + tolerance.size, numbers + 2.0 * tolerance.size]),
    )  # fmt: skip

    def design(first, most, tolerance=TOLERANCE, relief=True, found=True):
        best = SimpleNamespace(
            relief=SimpleNamespace(numbers=np.array([first])) if relief else None,
            over_most=None if most is None else np.array(most),
        )
        designed = SimpleNamespace(
            task=SimpleNamespace(tolerance=tolerance), found=found, best=best,
            unrelieved=SimpleNamespace(over_peak_to_peak=np.array([2.0, 4.0])),
        )  # fmt: skip
        designed.unrelieved_most = flank_design._unrelieved_most(over, "pair", designed)
        return designed

    monkeypatch.setattr(flank_design, "unrelieved_within", lambda *asked: np.zeros((2, 1)))  # no more than exactly

    assert _classes_finer(over, "pair", design(-0.2, [2.0, 4.1])) == 2  # 2 * 0.4 / 4 - 0.2 is nothing more
    assert _classes_finer(over, "pair", design(-0.11, [2.1, 3.0])) == 3
    assert _classes_finer(over, "pair", design(-0.2, [2.0, 4.0])) == 0
    assert _classes_finer(over, "pair", design(0.1, [2.2, 4.0])) is None
    for nothing in ({"tolerance": None}, {"relief": False}, {"found": False}):
        assert _classes_finer(over, "pair", design(-0.2, [9.0, 9.0], **nothing)) == 0
    assert _classes_finer(over, "pair", design(-0.2, None)) == 0


# ---- leads -----------------------------------------------------------------------------------------------------------
def test_leads_are_corrected_in_turns_in_the_gaps_of_the_shafts_that_the_last_turn_has_loaded(monkeypatch):
    """Two of three meshes have flanks. What shafts open is the number of their turn: K_Hbeta tells which were read."""

    @dataclass(frozen=True)
    class Flanks:
        gaps: object = "gaps"
        name: str = ""

    class Shafts:
        def __init__(self, turn, feeding="feeding"):
            self.turn, self.feeding = turn, feeding
            self.states = [SimpleNamespace(scale=0.5), SimpleNamespace(scale=2.0)]

        def gaps_of(self, pair):
            return self.turn, pair

    searched, loaded, said = [], [], []

    def search(own, shafts, scales, load, present, start):
        searched.append((own.name, shafts, scales, load, present, start))
        return len(searched) * 1e-6, len(searched) * 2e-6

    monkeypatch.setattr(lead_correction, "FlankForces", Flanks)
    monkeypatch.setattr(lead_correction, "_searched", search)
    monkeypatch.setattr(
        lead_correction,
        "_ground",
        lambda own, slope, crowning: (own.name, round(slope * 1e6, 6), round(crowning * 1e6, 6)),
    )
    monkeypatch.setattr(
        lead_correction, "load_gearbox",
        lambda gearbox, meshes, scales: loaded.append(([one.gaps for one in meshes], scales)) or len(loaded),
    )  # fmt: skip
    monkeypatch.setattr(lead_correction, "LoadedShafts", lambda gearbox, turn, feeding: Shafts(turn, feeding))
    monkeypatch.setattr(
        lead_correction, "face_load_factors",
        lambda own, shafts, loads, nominal: np.array([shafts[0] + 0.01 * own.gaps[1], nominal]),
    )  # fmt: skip
    gearbox = SimpleNamespace(meshes=[
        SimpleNamespace(pair="A", load=100.0), SimpleNamespace(pair="B", load=200.0),
        SimpleNamespace(pair="C", load=300.0),
    ])  # fmt: skip
    meshes = [Flanks(name="a"), SimpleNamespace(gaps="rigid"), Flanks(name="c")]
    leads = [(7e-6, 8e-6), (0.0, 0.0), (0.0, 5e-6)]
    found = lead_correction.correct_leads(gearbox, meshes, Shafts(0), leads, said.append)
    rounds = lead_correction._ROUNDS
    # Each turn asks both meshes; the first begins anew, the others where the turn before has ended.
    assert len(searched) == 2 * rounds
    for n, (name, shafts, scales, load, present, start) in enumerate(searched):
        turn, second = divmod(n, 2)
        assert (name, shafts) == (("a", (turn, "A")), ("c", (turn, "C")))[second]
        assert (scales, load, present) == ([0.5, 2.0], (100.0, 300.0)[second], (leads[0], leads[2])[second])
        assert start == (None if turn == 0 else pytest.approx(((n - 1) * 1e-6, (n - 1) * 2e-6)))
    # Shafts are loaded with the present lead replaced.
    for turn, (gaps, scales) in enumerate(loaded):
        first, second = 2 * turn + 1, 2 * turn + 2
        assert gaps == [("a", first - 7.0, 2.0 * first - 8.0), "rigid", ("c", second, 2.0 * second - 5.0)]
        assert scales == [0.5, 2.0]
    assert found[1] is None
    for one, n, load, present in ((found[0], 2 * rounds - 1, 100.0, leads[0]), (found[2], 2 * rounds, 300.0, leads[2])):
        assert (one.slope, one.crowning) == pytest.approx((n * 1e-6, n * 2e-6))
        assert one.loads.tolist() == [0.5 * load, 2.0 * load]
        more = 0.01 * (n - 1e6 * present[0])
        assert one.before.tolist() == pytest.approx([0.0, load])
        assert one.after.tolist() == pytest.approx([rounds + more, load])
        assert one.left.tolist() == pytest.approx([1.0, 0.0])
        assert one.kept.tolist() == pytest.approx([rounds + more, load])
    assert said == pytest.approx([(turn * 3 + k) / (3 * rounds) for turn in range(rounds) for k in (1, 2)] + [1.0])


# ---- numbers tried one after the other -------------------------------------------------------------------------------
def test_each_try_begins_from_the_nearest_before_it_and_none_is_made_twice():
    asked = []

    def of_numbers(numbers, near=None):
        asked.append((numbers.tolist(), near))
        return f"found {len(asked)}"

    scale = np.array([1.0, 10.0, 0.0])  # a tenth of the second counts as much as one of the first, the third does not
    tries = Tries(SimpleNamespace(of_numbers=of_numbers), scale)
    places = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 20.0, 9.0], [2.0, 0.0, 99.0], [1.0, 25.0, 0.0]]
    found = [tries.of(np.array(one)) for one in places]
    assert [near for _, near in asked] == [None, "found 1", "found 1", "found 2", "found 3"]
    assert [tries.of(np.array(one)) for one in places] == found
    assert len(asked) == len(places)
