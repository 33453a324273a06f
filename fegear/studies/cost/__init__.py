"""What accuracy costs: configurations from quick to exact, with error (against a converged reference) and seconds."""

from fegear.studies.cost.asked import asked
from fegear.studies.cost.ladder import Ladder
from fegear.studies.cost.result import CostResults
from fegear.studies.cost.study import forecast, ladder_of, study_cost

__all__ = ["CostResults", "Ladder", "asked", "forecast", "ladder_of", "study_cost"]
