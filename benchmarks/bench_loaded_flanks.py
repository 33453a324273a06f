"""What loaded flanks cost, and what cheaper bodies make of the same pair.

python benchmarks/bench_loaded_flanks.py [CASE]

Processor seconds of one core for the pair of cases/helical_pair.toml: the gears, their compliances along the contact
lines, the contact under all loads, then the same with another load; after that plane sections that know nothing of each
other (thin slices), without and with neighbouring teeth, coupled slices, and the solid gears.
"""

import sys
import time
from pathlib import Path

import numpy as np

from fegear.base.one_thread import one_thread
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.solid_influence import solid_settings_of
from fegear.case.reading import read_scene
from fegear.contact.wide.error import flank_error
from fegear.contact.wide.flanks import open_gaps
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.over_pitch import over_pitch
from fegear.studies.cost.ladder import BODIES
from fegear.studies.cost.measure import solve_bodies

CASE = Path(__file__).resolve().parents[1] / "cases" / "helical_pair.toml"


class Clock:
    """Processor seconds since it was last asked."""

    def __init__(self):
        self.at = time.process_time()

    def lap(self) -> float:
        """Seconds of this stretch."""
        before, self.at = self.at, time.process_time()
        return self.at - before


def main() -> None:
    """Print seconds of every stretch, then a line for every body."""
    scene = read_scene(Path(sys.argv[1]) if len(sys.argv) > 1 else CASE)
    asked = pair_spec(scene, next(iter(scene.pairs)))
    gaps = open_gaps(asked)
    settings, rows = solid_settings_of(scene, asked.gears[0]), []
    for body, name in BODIES.items():
        clock = Clock()
        gears = solve_bodies(scene, asked.name, body, settings)
        gear_seconds = clock.lap()
        for coupling in (False, True):
            flanks = FlankPair(asked.placed, gears, coupling, asked.hertz, asked.panel, asked.positions)
            clock.lap()
            known = flanks.compliance(asked.nominal)
            assembly = clock.lap()
            found = flanks.solve(asked.loads, gaps, known)
            rows.append((f"{name}{', neighbours' * coupling}", gear_seconds, assembly, clock.lap(), found))
    width = asked.pair.face_width / asked.pair.driver.module
    coarse = solve_bodies(scene, asked.name, "solid", settings.coarser(width))
    print(f"coarser solid gears, for the error: {clock.lap():.2f} s")
    for title, load in (
        ("first", asked.nominal),
        ("the same again", asked.nominal),
        ("another load", 1.1 * asked.nominal),
    ):
        clock.lap()
        known = flanks.compliance(load)
        found = flanks.solve(np.array(asked.loads) * load / asked.nominal, gaps, known)
        flank_error(flanks, found, coarse, gaps, over_pitch(flanks, found, gaps, load), load)
        print(f"compliances, contact and error, {title}: {clock.lap():.3f} s")
    nominal = asked.loads.index(asked.nominal)
    print("body                         gears  lines  contact  te mean  peak to peak  K_Hbeta   [s, um]")
    for name, *seconds, one in rows:
        te = one.transmission_error[:, nominal] * 1e6
        mean, factor = one.mean_transmission_error[nominal] * 1e6, one.face_load_factor[nominal]
        print(
            f"{name:28s} {seconds[0]:5.1f}  {seconds[1]:5.2f}  {seconds[2]:7.3f}  {mean:7.3f}  "
            f"{np.ptp(te):12.3f}  {factor:7.4f}"
        )


if __name__ == "__main__":
    with one_thread():
        main()
