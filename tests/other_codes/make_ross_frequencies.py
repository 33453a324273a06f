"""Natural frequencies of ROSS' own example of two geared shafts, over the mesh stiffness: ross_frequencies.json.

Run where ROSS is installed (ross-rotordynamics 2.3.0, with plotly below 6): the program is that of
docs/how-to/mesh-in-ross.md, whose last block is read for it.
"""

import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "how-to" / "mesh-in-ross.md"
#: Printed in ROSS' documentation of MultiRotor for 1e8 N/m [rad/s].
PRINTED = 74.160
#: [N/m]
STIFFNESSES = (0.5e8, 0.9e8, 0.99e8, 1e8, 1.01e8, 1.1e8, 2e8)


def main() -> None:
    """Ask ROSS."""
    program = next(
        b for b in re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL) if "import ross" in b
    )
    names: dict[str, object] = {}
    exec(program.partition("\n\nfor k in ")[0], names)  # noqa: S102  (the page's own program)
    import ross

    found = {f"{k:g}": [float(w) for w in names["frequencies"](k)] for k in STIFFNESSES}  # type: ignore[operator]
    kept = {"ross": ross.__version__, "printed": PRINTED, "frequencies": found}
    (HERE / "ross_frequencies.json").write_text(json.dumps(kept, indent=1) + "\n")


if __name__ == "__main__":
    sys.exit(main())
