"""Figures drawn from results only: nothing is computed here that a dataset does not hold.

Each function returns a `matplotlib.figure.Figure` made without pyplot, so that nothing global is touched and no
window opens: save it with `figure.savefig("name.png", dpi=200)`. At dpi = 100 the figures are 900 pixels wide. To
draw into axes or a figure of your own, hand them over (`ax=`, `figure=`).
"""

from bipenalty.plot.deformation_figure import deformation
from bipenalty.plot.force_figure import force
from bipenalty.plot.penetration_figure import penetration
from bipenalty.plot.restitution_figure import restitution, restitution_and_runs
from bipenalty.plot.stability_figure import stability
from bipenalty.plot.work_precision_figure import work_precision, work_precision_overview

__all__ = [
    "deformation",
    "force",
    "penetration",
    "restitution",
    "restitution_and_runs",
    "stability",
    "work_precision",
    "work_precision_overview",
]
