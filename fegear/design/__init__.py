"""Profile relief that removes the transmission error: loading families, design equations, charts, optimisation."""

from fegear.design.charts import ReliefChart, harris_map, relief_chart, welbourn_amount
from fegear.design.loading import LoadingFunction, Ramp, slope_trade_off
from fegear.design.minimum_excitation import MinimumExcitationRelief, minimum_excitation, relief_nodes, relief_table
from fegear.design.optimise import TipReliefPair, grindable, optimise_tip_relief
from fegear.design.robustness import Robustness, robustness
from fegear.design.root_stress_loading import design_stress, least_root_stress

__all__ = [
    "LoadingFunction",
    "MinimumExcitationRelief",
    "Ramp",
    "ReliefChart",
    "Robustness",
    "TipReliefPair",
    "design_stress",
    "grindable",
    "harris_map",
    "least_root_stress",
    "minimum_excitation",
    "optimise_tip_relief",
    "relief_chart",
    "relief_nodes",
    "relief_table",
    "robustness",
    "slope_trade_off",
    "welbourn_amount",
]
