"""What the tests of one process have solved: runs with equal inputs compute them once, as the tasks of one run do.

Not for tests that count what is computed, or that change how it is.
"""

from fegear.base.solution_cache import SolutionCache

CACHE = SolutionCache(most=600)
