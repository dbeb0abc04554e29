"""Speed against accuracy: what each method costs for what it gives, on scenes with known answers.

>>> import bipenalty as bp
>>> from bipenalty import study
>>> methods = {"parameter-free": bp.Bipenalty(), "stiffness": bp.Stiffness}
>>> data = study.work_precision(bp.exact.ThrownBar(), methods, [10, 20], factors=[1.0, 10.0], repeats=1)
>>> bool(study.pareto(data, cost="node_steps").any())
True
"""

from bipenalty.study.case import FACTORS, Case, cases, converged
from bipenalty.study.choice import best_for
from bipenalty.study.front import cost_at, distance_to_front, pareto
from bipenalty.study.lineup import lineup
from bipenalty.study.rates import rates, rates_in_dt
from bipenalty.study.reference import Reference
from bipenalty.study.work_precision import work_precision

__all__ = [
    "FACTORS",
    "Case",
    "Reference",
    "best_for",
    "cases",
    "converged",
    "cost_at",
    "distance_to_front",
    "lineup",
    "pareto",
    "rates",
    "rates_in_dt",
    "work_precision",
]
