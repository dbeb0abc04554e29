"""The axes of a grid: what varies, over which values, with which units."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bipenalty import checks
from bipenalty.methods.method import Method
from bipenalty.scene import Scene

About = tuple[str, str]

#: Units and long names of what may vary beside the method.
TIMES: dict[str, About] = {"dt": ("s", "time step"), "t_end": ("s", "time to run to")}
OF_BODIES: dict[str, About] = {
    "young": ("1", "factor on Young's modulus"),
    "density": ("1", "factor on the density"),
    "velocity": ("m/s", "initial velocity"),
    "offset": ("m", "offset at the start"),
}
PARAMETERS: dict[str, About] = {
    "ps": ("1", "stiffness penalty factor"),
    "rule": ("1", "rule of the penalties"),
    "kappa": ("1", "cap on the stiffness penalty over m_e/dt^2"),
    "s2": ("1", "R dt^2 of the critical rule"),
    "R": ("s-2", "penalty ratio"),
    "R_safety": ("1", "penalty ratio over 4/dt^2"),
    "D": ("s", "damping penalty factor"),
    "zeta": ("1", "damping ratio of the penalties"),
    "scale": ("1", "scale factor of the stiffness penalty"),
}


@dataclass(frozen=True)
class Axis:
    """One axis: dimension, kind ("method", "parameter", "dt", "t_end" or one of a body's), values, body."""

    dim: str
    kind: str
    values: tuple[Any, ...]
    body: int = -1
    units: str = "1"
    long_name: str = ""

    @property
    def is_vector(self) -> bool:
        """Whether values are (x, y) pairs."""
        return self.kind in ("velocity", "offset")


def method_axis(dim: str, methods: Any, owner: str) -> Axis:
    """An axis of methods.

    Raises
    ------
    InputError : none at all, or something that is not a method.
    """
    given = checks.sequence(owner, "methods", methods)
    found = tuple(checks.method(owner, f"methods[{i}]", m) for i, m in enumerate(given))
    checks.within(owner, "number of methods", 0, len(found) > 0, ">= 1", "give at least one method")
    return Axis(dim, "method", found, long_name="method")


def parse(axes: Any, scene: Scene, method: Any) -> tuple[Axis, ...]:
    """The axes of a grid as the user names them.

    Parameters
    ----------
    axes : mapping of name to values.
    scene : gives the names of the bodies.
    method : class or instance whose parameters may vary; None for an axis "method".

    Raises
    ------
    InputError : a name that is not known, values of the wrong kind, no axis or one without values.
    """
    mapping = isinstance(axes, Mapping) and len(axes) > 0
    checks.within("grid", "axes", repr(axes), mapping, "a mapping of names to values", 'give {"ps": [1, 10]} or so')
    bodies = {body.name: i for i, body in enumerate(scene.bodies)}
    parameters = parameter_names(method)
    known = ["method", *TIMES, *parameters, *(f"{body}.{kind}" for body in bodies for kind in OF_BODIES)]
    return tuple(_axis(str(name), values, bodies, parameters, known) for name, values in axes.items())


def parameter_names(method: Any) -> list[str]:
    """Names of the parameters of a method class or instance; none for None."""
    if method is None:
        return []
    ok = dataclasses.is_dataclass(method) and isinstance(method, (type, Method))
    remedy = "give the class whose parameters vary, such as Bipenalty, or an instance with the others set"
    checks.within("grid", "method", repr(method), ok, "a method class or a method", remedy)
    return [field.name for field in dataclasses.fields(method) if field.init]


def _axis(name: str, values: Any, bodies: Mapping[str, int], parameters: list[str], known: list[str]) -> Axis:
    body, _, kind = name.rpartition(".")
    checks.within("grid", "axis", repr(name), name in known, f"one of {known}", "correct it")
    if name == "method":
        return method_axis(name, values, "grid")
    given = checks.sequence("grid", name, values)
    checks.within("grid", f"number of values of {name}", 0, len(given) > 0, ">= 1", "give at least one value")
    if name in TIMES:
        return Axis(name, name, tuple(checks.number("grid", name, v) for v in given), -1, *TIMES[name])
    if name in parameters:
        about = PARAMETERS.get(name, ("1", name))
        return Axis(name, "parameter", tuple(_plain(v) for v in given), -1, *about)
    units, long_name = OF_BODIES[kind]
    as_pair = kind in ("velocity", "offset")
    read = checks.pair if as_pair else checks.number
    found = tuple(read("grid", name, v) for v in given)
    return Axis(name, kind, found, bodies[body], units, f'{long_name} of "{body}"')


def _plain(value: Any) -> Any:
    """A number as a float, so that 1 and 1.0 are the same grid; anything else as it is."""
    return value if value is None or isinstance(value, str) else checks.number("grid", "value", value)
