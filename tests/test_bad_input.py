"""Bad input: one test for each argument, and a message that names the object, its value, the bound and a remedy.

Every refusal is an `InputError`, which is also a `ValueError`, and reads "object: quantity = value, must be bound;
remedy". What is wrong with a mesh, its generators and its files is in test_mesh.py, test_mesh_generators.py and
test_mesh_read.py. At the end: how runs fail and stop.
"""

import contextlib
import math
import os
import re
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bipenalty as bp
import scenes

MESH = bp.mesh.rectangle(1.0, 1.0, 2, 2)
STEEL = scenes.elastic(100.0, 0.3, 1.0)


def refused(call: Callable[[], Any], subject: str, quantity: str, value: str, bound: str) -> str:
    """Assert that a call raises an InputError of four parts; returns its message."""
    with pytest.raises(bp.InputError) as caught:
        call()
    message = str(caught.value)
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, bp.BipenaltyError)
    assert message.startswith(f"{subject}: {quantity} = {value}, must be "), message
    told, _, remedy = message.partition(", must be ")[2].rpartition("; ")
    assert bound in told, message
    assert len(remedy) > 4, message
    return message


def body(name: str = "a", mesh: bp.Mesh = MESH, **changes: Any) -> bp.Body:
    """A square of side 1 m with its lower left corner at the origin."""
    return bp.Body(name, mesh, changes.pop("material", STEEL), **changes)


def pair(dx: float = 1.1, dy: float = 0.0) -> list[bp.Body]:
    """Two squares, the second one moved."""
    return [body("a"), body("b", MESH.moved(dx, dy))]


def model(bodies: Any = None, contacts: Any = (), held: Any = (), obstacles: Any = (), **options: Any) -> bp.Model:
    """The model of a scene of one square, unless bodies are given."""
    return bp.Model(bp.Scene([body()] if bodies is None else bodies, contacts, held, obstacles), **options)


def against(obstacle: bp.HalfPlane | bp.Polyline, tolerance: float | None = None) -> bp.Model:
    """The square in contact with an obstacle called "w"."""
    return model(contacts=[bp.Contact("a", "w", overlap_tolerance=tolerance)], obstacles=[obstacle])


def floor(name: str = "w") -> bp.HalfPlane:
    """A half-plane below the square."""
    return bp.HalfPlane(name, (0, -0.1), (0, 1))


# ---- materials and bodies


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
@pytest.mark.parametrize("name", ["young", "density"])
def test_modulus_and_density(name: str, value: float) -> None:
    """Young's modulus and density are positive and finite."""
    constants: Any = {"young": 1.0, "poisson": 0.2, "density": 1.0, name: value}
    refused(
        lambda: model([body(material=bp.LinearElastic(**constants))]),
        "LinearElastic",
        name,
        shown(value),
        "> 0 and finite",
    )


@pytest.mark.parametrize("value", [-1.0, 0.5, 0.52, math.inf, math.nan])
def test_poissons_ratio(value: float) -> None:
    """Poisson's ratio is in (-1, 0.5)."""
    refused(lambda: bp.LinearElastic(1.0, value, 1.0), "LinearElastic", "poisson", shown(value), "in (-1, 0.5)")


@pytest.mark.parametrize("name", ["young", "poisson", "density"])
def test_material_constants_are_numbers(name: str) -> None:
    """A constant that is no number is shown as it is."""
    constants: Any = {"young": 1.0, "poisson": 0.2, "density": 1.0, name: "steel"}
    refused(lambda: bp.LinearElastic(**constants), "LinearElastic", name, "'steel'", "a number")


def test_plane() -> None:
    """Plane strain or plane stress."""
    refused(lambda: bp.LinearElastic(1.0, 0.2, 1.0, plane="stretch"), "LinearElastic", "plane", '"stretch"', '"stress"')


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
def test_thickness(value: float) -> None:
    """A thickness is positive and finite."""
    refused(lambda: model([body(thickness=value)]), 'body "a"', "thickness", shown(value), "> 0 and finite")


def test_body_parts() -> None:
    """A name, a mesh and a material, each of its type."""
    refused(lambda: body(""), "body", "name", "''", "a name")
    refused(lambda: body(3), "body", "name", "3", "a name")  # type: ignore[arg-type]
    refused(lambda: body(mesh=MESH.points), 'body "a"', "mesh", "ndarray", "a bipenalty.Mesh")  # type: ignore[arg-type]
    refused(lambda: body(material="steel"), 'body "a"', "material", "str", "a LinearElastic")


@pytest.mark.parametrize("name", ["velocity", "displacement"])
@pytest.mark.parametrize("shape", [(), (1,), (3,), (9,), (9, 3), (2, 9), (8, 2), (1, 9, 2)])
def test_shape_of_nodal_values(name: str, shape: tuple[int, ...]) -> None:
    """One pair, or one row for each node."""
    changes: Any = {name: np.zeros(shape)}
    refused(lambda: body(**changes), 'body "a"', f"shape of {name}", str(shape), "(2,) or (9, 2)")


@pytest.mark.parametrize("name", ["velocity", "displacement"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_nodal_values_are_finite(name: str, bad: float) -> None:
    """NaN and infinity, in one pair or at one node."""
    at_one_node = np.zeros((9, 2))
    at_one_node[4, 1] = bad
    for values in ((0.0, bad), at_one_node):
        changes: Any = {name: values}
        refused(lambda changes=changes: body(**changes), 'body "a"', name, f"[{bad}]", "finite")  # type: ignore[misc]


@pytest.mark.parametrize("bad", ["fast", (1j, 0.0), [(0.0, 1.0), (2.0,)]])
def test_nodal_values_are_numbers(bad: Any) -> None:
    """Text, complex numbers, rows of different lengths."""
    with pytest.raises(bp.InputError, match=r'^body "a": velocity is not numeric; give \(x, y\) or an \(9, 2\) array$'):
        body(velocity=bad)


@pytest.mark.parametrize("bad", [(0.0, math.nan), (math.inf, 0.0)])
def test_body_force_is_finite(bad: Any) -> None:
    """NaN and infinity."""
    refused(lambda: body(body_force=bad), 'body "a"', "body_force", str(bad), "finite")


@pytest.mark.parametrize("bad", [9.81, (1, 2, 3), None])
def test_body_force_is_a_pair(bad: Any) -> None:
    """Two numbers."""
    refused(lambda: body(body_force=bad), 'body "a"', "body_force", repr(bad), "two numbers")


# ---- scenes, contacts, supports


@pytest.mark.parametrize(
    ("name", "item", "kind", "expected"),
    [
        ("bodies", MESH, "Mesh", "a Body"),
        ("contacts", "a", "str", "a Contact"),
        ("contacts", ("a", "b"), "tuple", "a Contact"),
        ("constraints", bp.Contact("a", "b"), "Contact", "a Support"),
        ("obstacles", MESH, "Mesh", "a HalfPlane or Polyline"),
        ("obstacles", body("b"), "Body", "a HalfPlane or Polyline"),
    ],
)
def test_scene_lists(name: str, item: Any, kind: str, expected: str) -> None:
    """A list with something else in it, at its place in the list."""
    before: dict[str, list[Any]] = {"bodies": [body()], "obstacles": [floor()]}
    good = before.get(name, [])
    lists: Any = {"bodies": [body()], name: [*good, item]}
    refused(lambda: bp.Scene(**lists), "scene", f"{name}[{len(good)}]", kind, expected)


@pytest.mark.parametrize("name", ["bodies", "contacts", "constraints", "obstacles"])
@pytest.mark.parametrize("value", [None, body(), bp.Contact("a", "b")])
def test_scene_lists_are_lists(name: str, value: Any) -> None:
    """A lone object is not a list of one."""
    lists: Any = {"bodies": [body()], name: value}
    refused(lambda: bp.Scene(**lists), "scene", name, type(value).__name__, "a list")


def test_empty_scene() -> None:
    """No body."""
    refused(lambda: bp.Scene([]), "scene", "number of bodies", "0", ">= 1")


def test_names_used_twice() -> None:
    """Bodies and obstacles share one set of names."""
    refused(lambda: bp.Scene([body(), body()]), "scene", "name", "'a'", "used once")
    refused(lambda: bp.Scene([body()], obstacles=[floor("a")]), "scene", "name", "'a'", "used once")


def test_no_scene() -> None:
    """A body instead of a scene, for a model and for a sweep."""
    refused(lambda: bp.Model(body()), "scene", "type", "Body", "a Scene")  # type: ignore[arg-type]
    refused(lambda: bp.sweep([body()], [bp.Stiffness()], 1.0), "scene", "type", "list", "a Scene")  # type: ignore[arg-type]


def test_unknown_names_in_contacts() -> None:
    """A secondary or primary that is not there; an obstacle as the secondary. What is there is listed."""
    known = 'one of the scene\'s bodies ["a", "b"]'
    refused(lambda: model(pair(), [bp.Contact("x", "b")]), 'contact "x" on "b"', "body", '"x"', known)
    refused(lambda: model(pair(), [bp.Contact("a", "x")]), 'contact "a" on "x"', "body", '"x"', known)
    message = refused(
        lambda: model(contacts=[bp.Contact("a", "wall")], obstacles=[floor("w")]),
        'contact "a" on "wall"',
        "body",
        '"wall"',
        '["a"]',
    )
    assert '(obstacles: ["w"])' in message
    refused(
        lambda: model(contacts=[bp.Contact("w", "a")], obstacles=[floor("w")]),
        'contact "w" on "a"',
        "body",
        '"w"',
        '["a"]',
    )
    refused(lambda: bp.Contact("a", None), "contact", "primary", "None", "a name")  # type: ignore[arg-type]


def test_contact_of_a_body_with_itself() -> None:
    """Self-contact is not modelled."""
    refused(lambda: model(contacts=[bp.Contact("a", "a")]), 'contact "a" on "a"', "primary", '"a"', "another body")


@pytest.mark.parametrize("passes", [0, 3, -1, 1.5, "2", None, [1, 2]])
def test_passes(passes: Any) -> None:
    """One or two."""
    refused(lambda: bp.Contact("a", "b", passes=passes), 'contact "a" on "b"', "passes", repr(passes), "1 or 2")


@pytest.mark.parametrize("passes", [1.0, np.array([1, 2]), np.array(2.0)])
def test_passes_is_a_whole_number(passes: Any) -> None:
    """A float of the right value, or an array."""
    with pytest.raises(bp.InputError, match="passes = "):
        model(pair(), [bp.Contact("a", "b", passes=passes)])


def test_two_passes_on_an_obstacle() -> None:
    """A rigid obstacle has no nodes of its own."""
    contact = bp.Contact("a", "w", passes=2)
    refused(
        lambda: model(contacts=[contact], obstacles=[floor()]),
        'contact "a" on "w"',
        "passes",
        "2",
        "1 against a rigid obstacle",
    )


@pytest.mark.parametrize("value", [-1e-3, math.nan, math.inf])
def test_overlap_tolerance(value: float) -> None:
    """A length."""
    refused(
        lambda: model(pair(), [bp.Contact("a", "b", overlap_tolerance=value)]),
        'contact "a" on "b"',
        "overlap_tolerance",
        shown(value),
        ">= 0 and finite",
    )


def test_unknown_names_in_supports() -> None:
    """A body or a boundary that is not there; what is there is listed."""
    refused(lambda: model(held=[bp.Support("x", "left")]), 'support of "x"', "body", '"x"', "one of ['a']")
    with pytest.raises(bp.InputError, match=r'boundary = "lft", must be one of: "left", "right", "bottom", "top"'):
        model(held=[bp.Support("a", "lft")])


def test_support_nodes() -> None:
    """Numbers of the body's nodes, at least one, with an axis to hold."""

    def held(on: Any, **axes: bool) -> Callable[[], Any]:
        return lambda: model(held=[bp.Support("a", on, **axes)])

    refused(held([0, 9]), 'support of "a"', "node", "9", "from 0 to 8")
    refused(held([-1]), 'support of "a"', "node", "-1", ">= 0")
    refused(held(np.array([], dtype=int)), 'support of "a"', "number of nodes", "0", ">= 1")
    refused(held([0.5]), 'support of "a"', "on", "float64 array of shape (1,)", "a boundary name or node numbers")
    refused(held([[0, 1]]), 'support of "a"', "on", "int64 array of shape (1, 2)", "a boundary name or node numbers")
    refused(held(None), 'support of "a"', "on", "object array of shape ()", "a boundary name or node numbers")
    refused(held("left", x=False, y=False), 'support of "a"', "held axes", "none", "x, y or both")


# ---- overlap


def overlapping(tolerance: float | None) -> dict[str, Callable[[], bp.Model]]:
    """Scenes in which the square lies 0.1 m deep in something."""
    contact = bp.Contact("a", "b", overlap_tolerance=tolerance)
    shifted = body("b", MESH.moved(1.1, 0.2), displacement=(-0.2, 0.0))
    stone = [(-1, -1), (2, -1), (2, 0.1), (-1, 0.1)]
    return {
        "b": lambda: model(pair(0.9, 0.2), [contact]),
        "b, displaced": lambda: model([body("a"), shifted], [contact]),
        "half-plane": lambda: against(bp.HalfPlane("w", (0, 0.1), (0, 2)), tolerance),
        "closed polyline": lambda: against(bp.Polyline("w", stone, closed=True), tolerance),
        "open polyline": lambda: against(bp.Polyline("w", [(2, 0.1), (-1, 0.1)]), tolerance),
    }


@pytest.mark.parametrize("other", overlapping(None))
def test_overlap_at_the_start(other: str) -> None:
    """Refused by default with the node and the depth, accepted up to a tolerance of one's own."""
    with pytest.raises(bp.InputError) as caught:
        overlapping(None)[other]()
    message = str(caught.value)
    assert re.match(r'contact "a" on "[bw]": overlap at node \d of "a" = 1.000e-1 m, must be <= \S+ m', message)
    assert message.endswith("; move the bodies apart or raise the contact's overlap_tolerance")
    with pytest.raises(bp.InputError, match=r"must be <= 9.900e-2 m at the start"):
        overlapping(0.099)[other]()
    assert overlapping(0.101)[other]().time == 0


def test_overlap_seen_from_the_other_pass() -> None:
    """With two passes a corner of the primary in the side of the secondary counts as well."""
    corner = body("b", MESH.rotated(math.pi / 4).moved(0.3, 0.9))
    contact = bp.Contact("a", "b", passes=2)
    with pytest.raises(bp.InputError, match=r'overlap at node 0 of "b" = 1\.000e-1 m'):
        model([body("a"), corner], [contact])


def test_overlap_of_bodies_in_the_same_place() -> None:
    """Every node lies on the other's boundary, and yet the bodies overlap by half their size."""
    with pytest.raises(bp.InputError, match="overlap"):
        model(pair(0.0), [bp.Contact("a", "b", passes=2)])


def test_touching_is_no_overlap() -> None:
    """A gap of zero, and an overlap of a millionth of a segment, are accepted by default."""
    for overlap in (0.0, 0.4e-6):
        model(pair(1.0 - overlap), [bp.Contact("a", "b")])
        against(bp.HalfPlane("w", (0, overlap), (0, 1)))
        against(bp.Polyline("w", [(2, overlap), (-1, overlap)]))


def test_inside_out_polyline() -> None:
    """The obstacle lies on the left of travel: a stone drawn clockwise is all the space around it."""
    stone = [(-1, -2), (2, -2), (2, -0.3), (-1, -0.3)]
    against(bp.Polyline("w", stone, closed=True))
    with pytest.raises(bp.InputError, match=r"overlap|clockwise"):
        against(bp.Polyline("w", stone[::-1], closed=True))


# ---- obstacles


def test_half_plane() -> None:
    """A point, and a normal that is not zero."""
    wall = 'obstacle "w"'
    refused(lambda: against(bp.HalfPlane("w", (0, -1), (0.0, 0.0))), wall, "normal", "(0, 0) at (0, -1)", "not zero")
    refused(lambda: bp.HalfPlane("w", (0, 0), (math.nan, 0)), wall, "normal", "(nan, 0.0)", "finite")
    refused(lambda: bp.HalfPlane("w", (0, 0), (math.inf, 0)), wall, "normal", "(inf, 0.0)", "finite")
    refused(lambda: bp.HalfPlane("w", (math.nan, 0), (0, 1)), wall, "point", "(nan, 0.0)", "finite")
    refused(lambda: bp.HalfPlane("w", (0,), (0, 1)), 'obstacle "w"', "point", "(0,)", "two numbers")  # type: ignore[arg-type]
    refused(lambda: bp.HalfPlane("", (0, 0), (0, 1)), "obstacle", "name", "''", "a name")


def test_polyline() -> None:
    """Two distinct points, three when closed; all finite."""
    refused(lambda: against(bp.Polyline("w", [(0, -1)])), 'obstacle "w"', "number of points", "1", ">= 2")
    refused(lambda: against(bp.Polyline("w", [])), 'obstacle "w"', "number of points", "0", ">= 2")
    refused(
        lambda: against(bp.Polyline("w", [(0, -1), (1, -1)], closed=True)),
        'obstacle "w"',
        "number of points",
        "2",
        ">= 3",
    )
    refused(
        lambda: against(bp.Polyline("w", [(2, -1), (0, -1), (0, -1)])),
        'obstacle "w"',
        "segment 1",
        "[0.0, -1.0] to [0.0, -1.0]",
        "two distinct finite points",
    )
    refused(
        lambda: against(bp.Polyline("w", [(0, -2), (1, -2), (1, -1), (0, -2)], closed=True)),
        'obstacle "w"',
        "segment 3",
        "[0.0, -2.0] to [0.0, -2.0]",
        "two distinct finite points",
    )
    refused(lambda: bp.Polyline("w", [(0, 0), (1, math.nan)]), 'obstacle "w"', "point 1", "(1.0, nan)", "finite")
    refused(lambda: bp.Polyline("w", [1, 2]), 'obstacle "w"', "point 0", "1", "two numbers")  # type: ignore[list-item]
    refused(lambda: bp.Polyline("w", None), 'obstacle "w"', "points", "NoneType", "a list")  # type: ignore[arg-type]


# ---- methods


@pytest.mark.parametrize("value", [-1.0, -math.inf, math.inf, math.nan])
@pytest.mark.parametrize(
    ("kind", "name"),
    [(bp.Stiffness, "ps"), (bp.Stiffness, "D"), (bp.Bipenalty, "ps"), (bp.Bipenalty, "D"), (bp.Bipenalty, "zeta")],
)
def test_penalty_parameters(kind: Any, name: str, value: float) -> None:
    """p_s, D and zeta are not negative, and finite."""
    rule = {"rule": "published"} if kind is bp.Bipenalty else {}
    refused(lambda: kind(**({"ps": 1.0} | rule | {name: value})), kind.__name__, name, shown(value), ">= 0 and finite")


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
@pytest.mark.parametrize("name", ["R", "R_safety"])
def test_penalty_ratio(name: str, value: float) -> None:
    """The penalty ratio and its share of 4/dt^2 are positive and finite."""
    refused(
        lambda: bp.Bipenalty(1.0, **{name: value}, rule="published"), "Bipenalty", name, shown(value), "> 0 and finite"
    )


def test_parameters_are_numbers() -> None:
    """A parameter that is no number is shown as it is."""
    refused(lambda: bp.Bipenalty(ps=None, rule="published"), "Bipenalty", "ps", "None", "a number")  # type: ignore[arg-type]
    refused(lambda: bp.Stiffness(D="much"), "Stiffness", "D", "'much'", "a number")  # type: ignore[arg-type]


def test_damping_is_given_once() -> None:
    """D or zeta, not both."""
    refused(
        lambda: bp.Bipenalty(1.0, D=1e-3, zeta=1.0, rule="published"),
        "Bipenalty",
        "D and zeta",
        "(0.001, 1.0)",
        "one at a time",
    )


@pytest.mark.parametrize("method", ["bipenalty", 1.0, bp.Stiffness, bp.Bipenalty])
def test_no_method(method: Any) -> None:
    """A name, a number, or a class that has not been called."""
    shown = f"the class {method.__name__}" if isinstance(method, type) else type(method).__name__
    refused(lambda: model(method=method), "model", "method", shown, "a Stiffness or Bipenalty")


# ---- time step, run, sweep


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
def test_time_step(value: float) -> None:
    """A time step and its share of the limit."""
    refused(lambda: model(dt=value), "model", "dt", str(value), "> 0 and finite")
    refused(lambda: model(safety=value), "model", "safety", str(value), "in (0, 1]")


def test_time_step_by_name() -> None:
    """One name is known."""
    refused(lambda: model(dt="courant"), "model", "dt", "'courant'", '"element", "assembled" or a number')
    refused(lambda: model(dt=None), "model", "dt", "None", "a number")
    refused(lambda: model(safety=1.5), "model", "safety", "1.5", "in (0, 1]")


def test_time_step_above_the_limit() -> None:
    """Refused with the limit in the message, accepted on demand; the limit itself is within it."""
    limit = model().critical_step().assembled
    assert limit > 1.02 * model().critical_dt
    scene = bp.Scene([body()])
    for call in (lambda: model(dt=1.01 * limit), lambda: bp.sweep(scene, [bp.Stiffness()], 1.0, dt=1.01 * limit)):
        message = refused(call, "run", "dt", f"{scientific(1.01 * limit)} s", "2/omega_max")
        told = re.search(r"must be <= (\S+) s", message)
        assert told is not None
        assert float(told[1]) == pytest.approx(limit, rel=1e-6)
        assert message.endswith("; reduce it, or pass allow_unstable=True")
    assert model(dt=1.01 * limit, allow_unstable=True).dt == 1.01 * limit
    assert bp.sweep(scene, [bp.Stiffness()], 1.0, dt=1.01 * limit, allow_unstable=True).sizes["run"] == 1
    assert model(dt=limit).dt == limit


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
def test_end_of_a_run(value: float) -> None:
    """Finite and after now."""
    refused(lambda: model().run(value), "run", "t_end", str(value), "finite and after now (0 s)")


def test_run_twice_to_the_same_time() -> None:
    """The second run has nothing to do; a later end is accepted."""
    twice = model()
    twice.run(0.1)
    refused(lambda: twice.run(0.1), "run", "t_end", "0.1", f"after now ({twice.time:g} s)")
    assert twice.run(0.2).steps == twice.steps


@pytest.mark.parametrize("name", ["every", "energy_every"])
@pytest.mark.parametrize("value", [0, -1, 1.5, "2", None])
def test_strides(name: str, value: Any) -> None:
    """Whole numbers of steps."""
    refused(lambda: model().run(0.1, **{name: value}), "run", name, repr(value), "a whole number >= 1")


@pytest.mark.parametrize("value", [-0.01, 0.2, math.nan])
def test_snapshot_outside_the_run(value: float) -> None:
    """Snapshots are taken between now and the end."""
    refused(lambda: model().run(0.1, snapshots=[0.05, value]), "run", "snapshot", str(value), "between now (0 s) and")


def test_snapshots_are_a_list() -> None:
    """A lone time is not a list of one."""
    refused(lambda: model().run(0.1, snapshots=0.05), "run", "snapshots", "float", "a list")  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan])
def test_displacement_limit(value: float) -> None:
    """Positive; infinity is none."""
    refused(lambda: model().run(0.1, displacement_limit=value), "run", "displacement_limit", shown(value), "> 0")
    scene = bp.Scene([body()])
    refused(
        lambda: bp.sweep(scene, [bp.Stiffness()], 0.1, displacement_limit=value),
        "run",
        "displacement_limit",
        shown(value),
        "> 0",
    )
    assert model().run(0.1, displacement_limit=math.inf).outcome == "finished"


@pytest.mark.parametrize("n", [-1, 1.5, "2", None])
def test_number_of_steps(n: Any) -> None:
    """A whole number, which may be zero."""
    refused(lambda: model().step(n), "step", "n", repr(n), "a whole number >= 0")
    model().step(0)


@pytest.mark.parametrize("value", [2**64, 10**30])
def test_numbers_of_steps_beyond_counting(value: int) -> None:
    """More steps than can be counted are refused by a sentence of the package."""
    with pytest.raises(bp.InputError, match="n = "):
        model().step(value)
    with pytest.raises(bp.InputError, match="every = "):
        model().run(0.1, every=value)
    with pytest.raises(bp.InputError, match="t_end = "):
        model().run(float(value))
    with pytest.raises(bp.InputError, match="t_end = "):
        bp.sweep(bp.Scene([body()]), [bp.Stiffness()], float(value))


def test_result_before_the_first_step() -> None:
    """Nothing has been observed."""
    refused(lambda: model().result(), "result", "number of steps", "0", ">= 1")


def test_sweep_without_methods() -> None:
    """An empty list, no list, and something else in it."""
    scene = bp.Scene([body()])
    refused(lambda: bp.sweep(scene, [], 0.1), "sweep", "number of methods", "0", ">= 1")
    refused(lambda: bp.sweep(scene, [bp.Stiffness(), 1.0], 0.1), "sweep", "methods[1]", "float", "a Stiffness")  # type: ignore[list-item]
    refused(lambda: bp.sweep(scene, bp.Stiffness(), 0.1), "sweep", "methods", "Stiffness", "a list")  # type: ignore[arg-type]
    refused(lambda: bp.sweep(scene, None, 0.1), "sweep", "methods", "NoneType", "a list")  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
def test_end_of_a_sweep(value: float) -> None:
    """Positive and finite."""
    scene = bp.Scene([body()])
    refused(lambda: bp.sweep(scene, [bp.Stiffness()], value), "sweep", "t_end", str(value), "> 0 and finite")


@pytest.mark.parametrize("value", [-1, 1.5, "2"])
def test_threads(value: Any) -> None:
    """A whole number of threads, at least one."""
    scene = bp.Scene([body()])
    refused(
        lambda: bp.sweep(scene, [bp.Stiffness()], 0.1, threads=value),
        "sweep",
        "threads",
        repr(value),
        "a whole number >= 1",
    )


def shown(value: float) -> str:
    """A number as the messages of the core spell it."""
    return "NaN" if math.isnan(value) else f"{value:g}"


def scientific(value: float) -> str:
    """A number with six digits behind the point as the core writes it: 1.341641e-2."""
    mantissa, exponent = f"{value:.6e}".split("e")
    return f"{mantissa}e{int(exponent)}"


# ---- runs that fail


def unstable(method: Any = None, factor: float = 1.1) -> bp.Model:
    """Two bars that collide, with a time step above the limit."""
    scene = scenes.two_bars(20)
    limit = bp.Model(scene).critical_dt
    return bp.Model(scene, method, dt=factor * limit, allow_unstable=True)


FAILURES = ("spectral instability", "energy made by contact", "element inverted", "contact missed", "not finite")


def assert_nothing_is_hidden(result: bp.Result) -> None:
    """Either every number is finite, or the outcome says that the run has failed, and why."""
    finite = all(np.isfinite(values).all() for values in result.dataset.data_vars.values())
    assert finite or result.outcome in FAILURES
    assert (result.outcome == "finished") == (result.reason == "")


@pytest.mark.parametrize("energy_every", [1, 10, 10**6])
def test_divergence_keeps_what_there_is(energy_every: int) -> None:
    """The outcome names the limit that was passed, by how much, and what to change; the histories are there."""
    result = unstable().run(100.0, energy_every=energy_every, snapshots=[0.0, 0.1])
    assert result.outcome == "spectral instability"
    omega = re.search(r"omega dt = (\S+) of the mesh \(stiffest elements in \"\w+\"\) is above 2; reduce dt", result.reason)
    assert omega is not None, result.reason
    assert float(omega[1]) == pytest.approx(2.2, abs=0.01)
    assert 5 < result.dataset.sizes["time"] <= result.steps < 1e4  # of the 1.1e4 that 100 s would take
    assert np.isfinite(result.contact_force[:5]).all()
    assert result.contact_force.max() > 0
    assert np.isfinite(result.displacement).all()
    assert np.isfinite(result.kinetic_energy[0])


@pytest.mark.parametrize(
    "method",
    [
        bp.Stiffness(1e3),
        bp.Stiffness(1e9),
        bp.Bipenalty(1e6, rule="published"),
        bp.Bipenalty(1, R=1e9, rule="published"),
        bp.Bipenalty(10, R_safety=5, rule="published"),
    ],
)
@pytest.mark.parametrize("factor", [0.5, 0.999, 1.05, 3.0])
def test_no_nan_in_silence(method: Any, factor: float) -> None:
    """Good and bad time steps and penalties: each run says how it ended."""
    model = unstable(method, factor)
    result = model.run(2000 * model.dt)
    assert_nothing_is_hidden(result)
    assert np.isfinite(model.displacement).all() or result.outcome in FAILURES
    if factor > 1:
        assert result.outcome in FAILURES


def test_displacement_limit_ends_the_run() -> None:
    """The run ends there, labelled, and can be asked for what it has; a limit not reached changes nothing."""
    model = bp.Model(scenes.bar_and_wall(20), bp.Bipenalty(ps=0.5, rule="published"))
    result = model.run(2.0, displacement_limit=3.0)
    assert result.outcome == "displacement limit passed"
    assert re.match(r"displacement 3\.\d* m passed the limit 3 m at t = 0\.3\d* s$", result.reason)
    assert 3.0 < result.max_displacement < 3.0 + 10 * scenes.SPEED * model.dt  # looked at every ten steps
    assert result.steps == model.steps < 0.3 / model.dt + 11
    other = bp.Model(scenes.bar_and_wall(20), bp.Bipenalty(ps=0.5, rule="published"))
    assert other.run(2.0, displacement_limit=30.0).outcome == "finished"


def test_step_after_divergence() -> None:
    """RunError carries the result; it comes again at the next step, and the state can still be looked at."""
    model = unstable()
    with pytest.raises(bp.RunError, match=r"^spectral instability: .*omega dt = .*reduce dt") as caught:
        model.step(100_000)
    result = caught.value.result
    assert isinstance(caught.value, RuntimeError)
    assert isinstance(caught.value, bp.BipenaltyError)
    assert isinstance(result, bp.Result)
    assert (result.outcome, result.steps) == ("spectral instability", model.steps)
    assert np.isfinite(result.contact_force[:5]).all()
    assert model.displacement.shape == model.velocity.shape == (84, 2)
    with pytest.raises(bp.RunError, match=r"^spectral instability: "):
        model.step()
    assert model.run(2 * model.time).outcome == "spectral instability"


@pytest.mark.parametrize(
    "method", [bp.Bipenalty(1e308, rule="published"), bp.Bipenalty(1e3, D=1e308, rule="published")]
)
def test_divergence_in_the_first_step(method: Any) -> None:
    """A force that is infinite at once: no step could be taken, and that is what the outcome says."""

    def start() -> bp.Model:
        deep = bp.HalfPlane("w", (0, 1e-3), (0, 1))
        contact = bp.Contact("a", "w", overlap_tolerance=1.0)
        return model(contacts=[contact], obstacles=[deep], method=method)

    result = start().run(0.1)
    assert result.outcome == "not finite"
    assert result.reason
    with pytest.raises(bp.RunError, match=r"^not finite: "):
        start().step()


def test_energy_ratio_of_a_fall_from_rest() -> None:
    """Nothing to divide by: the start has no energy, and the ratio says so instead of dividing by round-off."""
    method = bp.Bipenalty(1.0, rule="published")
    result = model([body(body_force=(0.0, -10.0))], [bp.Contact("a", "w")], obstacles=[floor()], method=method).run(0.5)
    assert result.max_penetration > 0
    assert math.isnan(result.energy_ratio) or abs(result.energy_ratio - 1) < 0.1


def test_failed_run_in_a_sweep() -> None:
    """It is labelled, its histories are NaN after its end, and the others are what they would be without it."""
    scene = scenes.small_cylinders()
    good, bad = bp.Bipenalty(1.0, rule="published"), bp.Stiffness(1e4)
    data = bp.sweep(scene, [good, bad, good], 0.2, displacement_limit=1.0, histories=True)
    assert data.failed.values.tolist() == [False, True, False]
    assert data.finished.values.tolist() == [True, False, True]
    assert data.outcome.values.tolist() == ["finished", "spectral instability", "finished"]
    assert data.reason.values[0] == ""
    assert "omega dt" in data.reason.values[1]
    steps = int(data.steps[1])
    assert np.isfinite(data.contact_force[1, :steps]).all()
    assert np.isnan(data.contact_force[1, steps:]).all()
    assert np.isfinite(data.contact_force[[0, 2]]).all()
    np.testing.assert_array_equal(data.contact_force[0], bp.Model(scene, good).run(0.2).contact_force)


# ---- Ctrl-C, threads, and the interpreter


@contextlib.contextmanager
def ctrl_c(after: float) -> Iterator[None]:
    """Send this process the signal of Ctrl-C after some seconds; assert that the block ends within one more.

    The second is one of processor time: on a machine that is busy with other things the clock on the wall says little.
    """
    sent: list[float] = []

    def press() -> None:
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, press)
    # A process started in the background of a script ignores the signal; these tests want it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer.start()
    try:
        yield
        assert sent, "the block ended before Ctrl-C"
        assert time.process_time() - sent[0] < 1.0
    finally:
        timer.cancel()
        timer.join()
        signal.signal(signal.SIGINT, before)


def test_ctrl_c_during_a_run() -> None:
    """The run returns what there is, and goes on afterwards as if nothing had been."""
    scene = scenes.small_cylinders()
    model = bp.Model(scene)
    with ctrl_c(after=0.3):
        result = model.run(1e6 * model.dt)
    assert result.outcome == "interrupted"
    assert result.reason.startswith("stopped by the user at t = ")
    assert result.steps == model.steps == result.dataset.sizes["time"] > 100
    assert np.isfinite(result.contact_force).all()
    steps = model.steps + 100
    model.run(steps * model.dt)
    undisturbed = bp.Model(scene)
    undisturbed.step(steps)
    np.testing.assert_array_equal(model.displacement, undisturbed.displacement)


@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_during_a_sweep(threads: int) -> None:
    """The dataset has what there is and tells which runs are whole."""
    scene = scenes.small_cylinders()
    dt = bp.Model(scene).dt
    with ctrl_c(after=0.3):
        methods = [bp.Bipenalty(ps, rule="published") for ps in (0.5, 1.0, 2.0)]
        data = bp.sweep(scene, methods, 1e6 * dt, threads=threads, histories=True)
    assert data.attrs["interrupted"] == 1
    assert set(data.outcome.values) == {"interrupted"}
    assert not data.finished.any()
    assert not data.failed.any()
    assert data.steps.max() > 100
    for i, steps in enumerate(data.steps.values.astype(int)):
        assert np.isfinite(data.contact_force[i, :steps]).all()
        assert np.isnan(data.contact_force[i, steps:]).all()


def test_other_threads_go_on() -> None:
    """One call into the core, without a look at the interpreter in between: another thread works on meanwhile."""
    model = bp.Model(scenes.cylinders())
    ticks, stop = [], threading.Event()

    def tick() -> None:
        while not stop.is_set():
            ticks.append(time.perf_counter())
            time.sleep(1e-3)

    clock = threading.Thread(target=tick)
    clock.start()
    try:
        start = time.perf_counter()
        model.step(5000)
        end = time.perf_counter()
    finally:
        stop.set()
        clock.join()
    during = [t for t in ticks if start < t < end]
    assert end - start > 0.05
    assert len(during) > 0.1 * (end - start) / 1e-3
    assert np.diff(during).max() < 0.5 * (end - start)


def test_two_threads_with_one_model() -> None:
    """A second thread that steps the same model is refused, and neither state nor interpreter is harmed."""
    model, errors = bp.Model(scenes.cylinders()), []

    def step() -> None:
        try:
            model.step(500)
        except RuntimeError as error:
            errors.append(error)

    threads = [threading.Thread(target=step) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert model.steps == 500 * (4 - len(errors))
    undisturbed = bp.Model(scenes.cylinders())
    undisturbed.step(model.steps)
    np.testing.assert_array_equal(model.displacement, undisturbed.displacement)


def survives(script: str) -> str:
    """Run a script in an interpreter of its own, Ctrl-C after 2 s of processor time; assert that it ends by itself; its output."""
    prelude = """
        import signal, sys
        import numpy as np
        import bipenalty as bp, scenes
        signal.signal(signal.SIGPROF, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_PROF, 2.0)
    """
    code = textwrap.dedent(prelude) + textwrap.dedent(script)
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=Path(__file__).parent, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


@pytest.mark.parametrize("t_end", [1e9, 1e14, 1e30])
def test_run_without_end(t_end: float) -> None:
    """More steps than memory could hold: a sentence of the package, or a run that Ctrl-C stops, but no abort."""
    said = survives(f"""
        model = bp.Model(scenes.small_cylinders())
        try:
            print(model.run({t_end!r}).outcome)
        except bp.InputError as error:
            print(error)
    """)
    assert "interrupted" in said or "t_end = " in said


@pytest.mark.parametrize("histories", [False, True])
@pytest.mark.parametrize("t_end", [1e7, 1e14])
def test_sweep_without_end(t_end: float, histories: bool) -> None:
    """The same for a sweep: Ctrl-C keeps what there is, and that must not need the memory of the whole."""
    said = survives(f"""
        import resource
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        try:
            data = bp.sweep(scenes.small_cylinders(), [bp.Stiffness(), bp.Bipenalty()], {t_end!r}, histories={histories})
            print(data.outcome.values)
        except bp.InputError as error:
            print(error)
    """)
    assert "interrupted" in said or "t_end = " in said or "memory = " in said


def test_absurd_numbers() -> None:
    """Sizes, constants, states and penalties from 1e-150 to 1e150: refused, or run to an outcome; no panic."""
    said = survives("""
        signal.setitimer(signal.ITIMER_PROF, 0)  # it ends by itself
        random = np.random.default_rng(0)
        def size(decades):
            return float(10 ** random.uniform(-decades, decades))
        def body(name, decades):
            mesh = bp.mesh.rectangle(1.0, size(1), 2, 2)
            if random.random() < 0.5:
                mesh = bp.mesh.disc(size(decades / 3), 8)
            n, material = mesh.n_nodes, bp.LinearElastic(size(decades), random.uniform(-0.99, 0.499), size(decades))
            velocity, displacement = (random.normal(0, size(d), (n, 2)) for d in (decades, decades / 3))
            force = random.normal(0, size(decades), 2)
            return bp.Body(name, mesh.moved(*random.normal(0, 1, 2)), material, velocity, displacement, force, size(3))
        count = 0
        for trial in range(300):
            decades = (2, 150)[trial % 2]
            published = lambda ps, **more: bp.Bipenalty(ps, rule="published", **more)
            kinds = [bp.Stiffness, lambda ps: bp.Stiffness(ps, D=size(decades)), bp.Bipenalty,
                     lambda ps: published(ps, R=size(decades)), lambda ps: published(ps, zeta=size(decades))]
            try:
                bodies = [body("a", decades), body("b", decades)]
                wall = bp.Polyline("w", random.normal(0, 2, (4, 2)), closed=trial % 3 == 0)
                contacts = [bp.Contact("a", "b", 1 + trial % 2, 1e300), bp.Contact("b", "w", 1, 1e300)]
                model = bp.Model(bp.Scene(bodies, contacts, obstacles=[wall]), kinds[trial % 5](size(decades)))
                model.step(200)
                count += 1
            except bp.BipenaltyError as error:
                assert len(str(error)) > 20
        print(count)
    """)
    assert int(said) > 0
