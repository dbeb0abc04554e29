"""What is expected of the measurements, each beside what was measured."""

import math
from dataclasses import asdict, dataclass
from typing import Any

import timed_scenes as scenes
from measure import Spread, Steps, ratio
from versus_script import Duel


@dataclass(frozen=True)
class Claim:
    """A bound on a ratio; the median decides.

    Parameters
    ----------
    text : what is compared.
    measured : the ratio, -.
    least, most : the bound, -; one of them.
    over : the measured ratio is itself no less than what is claimed, so that beyond the bound it shows nothing.
    ceiling : -; a ratio beyond it cannot be, so that what it was compared with is wrong.
    """

    text: str
    measured: Spread
    least: float | None = None
    most: float | None = None
    over: bool = False
    ceiling: float = math.inf

    @property
    def met(self) -> bool:
        """Whether the median is within its bound."""
        if self.measured.median > self.ceiling:
            return False
        low = self.least is None or self.measured.median >= self.least
        return low and (self.most is None or self.measured.median <= self.most)

    @property
    def verdict(self) -> str:
        """One or two words for the table."""
        if self.met:
            return "PASS"
        if self.measured.median > self.ceiling:
            return "no ceiling"
        return "not shown" if self.over else "short"

    @property
    def expected(self) -> str:
        """The bound in words."""
        return f"at least {self.least:g}" if self.least is not None else f"at most {self.most:g}"

    def as_dict(self) -> dict[str, Any]:
        """For the JSON file."""
        values = {name: value for name, value in asdict(self).items() if name != "ceiling" or math.isfinite(value)}
        return values | {"met": self.met, "verdict": self.verdict}


def of_speed(duels: list[Duel]) -> list[Claim]:
    """The time loop of the script takes at least four times that of the package."""
    return [
        Claim(f"script ({search}) over package, {duel.scene}", ratio(times[:, 1], times[:, 0]), least=4)
        for duel in duels
        for search, times in duel.loop.items()
    ]


def of_contact(steps: Steps) -> list[Claim]:
    """A step in contact costs at most half as much again as one in free flight."""
    free = steps.seconds[scenes.APART]
    return [
        Claim(f"{name}, over {scenes.APART}", ratio(steps.seconds[name], free), most=1.5)
        for name in (scenes.STIFFNESS, scenes.BIPENALTY)
    ]


def of_absence(steps: Steps) -> list[Claim]:
    """What a scene does not contain costs it at most 2 %.

    A scene without something cannot pay more for it than one that has it: that one's ratio is an upper bound.
    Searches, rows, mass block and histories that are not there can cost something by the step only, not by the
    node: they are bounded together by the whole step of a scene with next to no nodes.
    """
    cost, nothing = steps.seconds, steps.seconds[scenes.NOTHING]
    bounds = [
        ("all that does not grow with the nodes: no search, no rows, no mass block", scenes.TINY, nothing, 0.02),
        ("no support: at most what a scene with one pays", scenes.SUPPORT, nothing, 1.02),
        ("no body force: at most what a scene with one pays", scenes.LOAD, nothing, 1.02),
        ("no damping: at most what bipenalty with it pays", scenes.BIPENALTY_DAMPED, cost[scenes.BIPENALTY], 1.02),
    ]
    return [Claim(text, ratio(cost[name], base), most=most, over=True) for text, name, base, most in bounds]
