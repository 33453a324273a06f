"""Two runs held against each other: what went in, the single values, and the tables row by row."""

from fegear.studies.comparison.compare import Comparison, compare
from fegear.studies.comparison.figures import comparison_figures
from fegear.studies.comparison.inputs import Input, different_inputs
from fegear.studies.comparison.side import Side, side_of
from fegear.studies.comparison.tables import Joined, join
from fegear.studies.comparison.values import Pairing, paired

__all__ = [
    "Comparison", "Input", "Joined", "Pairing", "Side", "compare", "comparison_figures", "different_inputs", "join",
    "paired", "side_of",
]  # fmt: skip
