"""What accuracy costs: a ladder of settings, each rung with its error against a converged reference and its seconds."""

from fegear.scene.cost.asked import asked
from fegear.scene.cost.ladder import Ladder
from fegear.scene.cost.result import CostResults
from fegear.scene.cost.study import forecast, ladder_of, study_cost

__all__ = ["CostResults", "Ladder", "asked", "forecast", "ladder_of", "study_cost"]
