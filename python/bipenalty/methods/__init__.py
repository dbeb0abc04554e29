"""Methods, one file each: how penalties are chosen, or multipliers take their place."""

from bipenalty.methods.bipenalty import Bipenalty
from bipenalty.methods.cd_lagrange import CDLagrange
from bipenalty.methods.forward_increment import ForwardIncrementLagrange
from bipenalty.methods.in_use import ElementStiffness, NodalMassStiffness
from bipenalty.methods.method import Method
from bipenalty.methods.predictor_corrector import PredictorCorrector
from bipenalty.methods.stiffness import Stiffness

__all__ = [
    "Bipenalty",
    "CDLagrange",
    "ElementStiffness",
    "ForwardIncrementLagrange",
    "Method",
    "NodalMassStiffness",
    "PredictorCorrector",
    "Stiffness",
]
