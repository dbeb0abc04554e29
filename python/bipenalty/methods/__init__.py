"""Penalty methods, one file each: how stiffness, mass and damping penalties are chosen."""

from bipenalty.methods.bipenalty import Bipenalty
from bipenalty.methods.in_use import ElementStiffness, NodalMassStiffness
from bipenalty.methods.method import Method
from bipenalty.methods.stiffness import Stiffness

__all__ = ["Bipenalty", "ElementStiffness", "Method", "NodalMassStiffness", "Stiffness"]
