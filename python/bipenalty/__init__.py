"""Two-dimensional explicit finite-element contact dynamics with the bipenalty method.

A `Scene` says what there is, a `Model` advances it, a `Result` holds what was seen:

>>> import bipenalty as bp
>>> disc = bp.mesh.disc(radius=1.0, segments=32)
>>> top = bp.Body("top", disc.moved(0, 2), bp.LinearElastic(young=1000, poisson=0.2, density=0.1))
>>> bottom = bp.Body("bottom", disc, bp.LinearElastic(young=100, poisson=0.2, density=0.1), velocity=(2**0.5, 2**0.5))
>>> scene = bp.Scene([top, bottom], contacts=[bp.Contact("top", "bottom")])
>>> result = bp.Model(scene, bp.Bipenalty(ps=1.0)).run(0.01)
>>> result.outcome
'finished'
"""

from bipenalty import exact, io, mesh, plot, study
from bipenalty.body import Body
from bipenalty.constraints import Support
from bipenalty.contact import Contact
from bipenalty.critical_step import CriticalStep
from bipenalty.errors import BipenaltyError, InputError, RunError
from bipenalty.materials import LinearElastic
from bipenalty.mesh import Mesh
from bipenalty.methods import (
    Bipenalty,
    CDLagrange,
    ElementStiffness,
    ForwardIncrementLagrange,
    Method,
    NodalMassStiffness,
    PredictorCorrector,
    Stiffness,
)
from bipenalty.model import Model
from bipenalty.obstacles import HalfPlane, Polyline
from bipenalty.result import Result
from bipenalty.result_dataset import package_version
from bipenalty.row_restitution import restitution, restitution_map
from bipenalty.scene import Scene
from bipenalty.sweeps import grid, sweep, sweep_memory

__version__ = package_version()

__all__ = [
    "BipenaltyError",
    "Bipenalty",
    "Body",
    "CDLagrange",
    "Contact",
    "CriticalStep",
    "ElementStiffness",
    "ForwardIncrementLagrange",
    "HalfPlane",
    "InputError",
    "LinearElastic",
    "Mesh",
    "Method",
    "Model",
    "NodalMassStiffness",
    "Polyline",
    "PredictorCorrector",
    "Result",
    "RunError",
    "Scene",
    "Stiffness",
    "Support",
    "exact",
    "grid",
    "io",
    "mesh",
    "restitution",
    "restitution_map",
    "plot",
    "study",
    "sweep",
    "sweep_memory",
]
