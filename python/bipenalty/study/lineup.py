"""The methods that the charts compare."""

from __future__ import annotations

from collections.abc import Callable

import bipenalty
from bipenalty.methods import Bipenalty, ElementStiffness, Method, NodalMassStiffness, Stiffness

#: A method without a parameter, or one for each stiffness penalty factor p_s.
Candidate = Method | Callable[[float], Method]

#: The method that needs no parameter, and the published one at its dampings D (s).
OURS, PUBLISHED = "parameter-free", "published"


def lineup() -> dict[str, Candidate]:
    """Each method of the charts by its name; those with a parameter p_s as functions of it.

    Example
    -------
    >>> methods = lineup()
    >>> methods["parameter-free"].label, methods["published, D = 1e-4 s"](10.0).label
    ('parameter-free bipenalty', 'bipenalty (D = 0.0001)')
    """
    methods: dict[str, Candidate] = {
        OURS: Bipenalty(),
        "critical": Bipenalty,
        PUBLISHED: lambda ps: Bipenalty(ps, rule="published"),
        "published, D = 1e-4 s": lambda ps: Bipenalty(ps, rule="published", D=1e-4),
        "stiffness": Stiffness,
        "element stiffness": ElementStiffness(),
        "nodal mass stiffness": NodalMassStiffness(),
    }
    # Multipliers have no parameter; the predictor-corrector takes p_s.
    for name, words in (("CDLagrange", "CD-Lagrange"), ("ForwardIncrementLagrange", "forward increment")):
        if made := getattr(bipenalty, name, None):
            methods[words] = made()
    if made := getattr(bipenalty, "PredictorCorrector", None):
        methods["predictor-corrector"] = made
    return methods


def takes_ps(candidate: Candidate) -> bool:
    """Whether it makes a method of a p_s; the class of a method does, a method does not.

    Example
    -------
    >>> takes_ps(Stiffness), takes_ps(Stiffness(10.0))
    (True, False)
    """
    return isinstance(candidate, type) or not isinstance(candidate, Method)
