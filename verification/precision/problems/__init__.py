"""All problems of the chart, in the order of its panels."""

from verification.precision.problem import Problem, checked
from verification.precision.problems import cracks, growth

PROBLEMS: tuple[Problem, ...] = checked((*cracks.PROBLEMS, *growth.PROBLEMS))
