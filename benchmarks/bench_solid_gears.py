"""What a solid gear costs: processor seconds with its error estimate, memory, growth with width and tooth number.

python benchmarks/bench_solid_gears.py [tolerance]

On a busy machine compare the ratio to the product of two matrices of order 2000, which the first line times.
"""

import math
import resource
import sys
import time

import numpy as np

from fegear.base.one_thread import one_thread
from fegear.fem.solid.influence import solid_influence
from fegear.fem.solid.settings import solid_settings
from fegear.geometry.external_tooth import Tooth

GEARS = [(28, 4.0), (28, 8.0), (28, 16.0), (17, 8.0), (60, 8.0), (150, 8.0)]


def product_seconds() -> float:
    """Processor seconds of one product of two matrices of order 2000, the best of three."""
    matrix = np.random.default_rng(1).random((2000, 2000))
    found = []
    with one_thread():
        for _ in range(3):
            started = time.process_time()
            matrix @ matrix
            found.append(time.process_time() - started)
    return min(found)


def main() -> None:
    """Print a line for every gear."""
    settings = solid_settings(float(sys.argv[1]) if len(sys.argv) > 1 else 1e-2)
    product = product_seconds()
    print(f"one product: {product:.3f} s")
    print("teeth  width  unknowns  seconds  products  peak GB  estimated errors [%]")
    for teeth, width in GEARS:
        tooth = Tooth(teeth)
        started = time.process_time()
        known = solid_influence(
            tooth, math.tan(math.radians(20.0)) / (0.5 * teeth), width, 0.3, 0.5 * tooth.root_radius, settings
        )
        seconds = time.process_time() - started
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
        errors = ", ".join(f"{key} {100 * value:.2g}" for key, value in known.error.items())
        print(
            f"{teeth:5d}  {width:5g}  {known.fine.unknowns:8d}  {seconds:7.1f}  {seconds / product:8.1f}  "
            f"{memory:7.2f}  {errors}",
            flush=True,
        )


if __name__ == "__main__":
    main()
