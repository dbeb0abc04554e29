"""Benchmarks with known answers: scenes, and what they should give.

Each is a `Known`, so that a study can loop over `BENCHMARKS`; refined, a run converges to what is known:

>>> import numpy as np
>>> import bipenalty as bp
>>> known = bp.exact.ThrownBar()
>>> model = bp.Model(known.scene(100), dt="assembled")
>>> result = model.run(known.t_end)
>>> t = result.time.values
>>> wrong = np.cumsum(result.contact_force.values) * model.dt - known.impulse_until(t + model.dt / 2)
>>> bool(np.abs(wrong).max() < 0.02 * known.impulse)
True
"""

from bipenalty.exact.bar import Bar
from bipenalty.exact.bouncing_bar import BouncingBar
from bipenalty.exact.hertz import Footprint, HertzDisc
from bipenalty.exact.known import Known
from bipenalty.exact.line_contact import LineContact
from bipenalty.exact.pulses import Pulses
from bipenalty.exact.signorini_bar import SignoriniBar
from bipenalty.exact.thrown_bar import ThrownBar
from bipenalty.exact.two_bars import TwoBars

#: The benchmarks as they are by default.
BENCHMARKS: tuple[Known, ...] = (ThrownBar(), BouncingBar(), SignoriniBar(), TwoBars(), HertzDisc())

__all__ = [
    "BENCHMARKS",
    "Bar",
    "BouncingBar",
    "Footprint",
    "HertzDisc",
    "Known",
    "LineContact",
    "Pulses",
    "SignoriniBar",
    "ThrownBar",
    "TwoBars",
]
