"""A slow, plain NumPy oracle of the whole computation, to compare the package with number by number.

Dense matrices, textbook sums, nothing reused between steps and no import but NumPy, so that each line can be
held against its equation. Meant for up to about 1500 degrees of freedom. SI units.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Row = tuple[int, float, Array]  # secondary node, gap (m), gradient (2N,)


@dataclass
class Body:
    """One elastic body; elements are counter-clockwise triples or quadruples of its own node numbers."""

    points: Any  # (N, 2) m
    triangles: Any = ()
    quads: Any = ()
    young: float = 1.0  # N/m^2
    poisson: float = 0.0
    density: float = 1.0  # kg/m^3
    plane: str = "strain"
    thickness: float = 1.0  # m, multiplies stiffness, mass and body force
    velocity: Any = (0.0, 0.0)  # (2,) or (N, 2) m/s
    displacement: Any = (0.0, 0.0)  # (2,) or (N, 2) m
    body_force: Any = (0.0, 0.0)  # (2,) N/m^3
    fixed: Sequence[tuple[int, int]] = ()  # (node, axis) pairs that never move

    def __post_init__(self) -> None:
        """Give the fields their full shapes."""
        self.points = np.asarray(self.points, dtype=float)
        self.velocity = np.zeros(self.points.shape) + self.velocity
        self.displacement = np.zeros(self.points.shape) + self.displacement
        self.elements = [[int(i) for i in e] for e in [*np.asarray(self.triangles), *np.asarray(self.quads)]]


@dataclass
class HalfPlane:
    """Rigid half-plane; `normal` (any length) points out of the solid."""

    point: Any  # (2,) m
    normal: Any  # (2,)


@dataclass
class Polyline:
    """Rigid polyline, outward normal to the right of travel (a closed solid runs counter-clockwise)."""

    points: Any  # (n, 2) m
    closed: bool = False


@dataclass
class Contact:
    """Contact of body number `secondary` with body number `primary` or with a rigid obstacle."""

    secondary: int
    primary: int | HalfPlane | Polyline
    alpha_s: float  # N/m, per row
    alpha_m: float = 0.0  # kg, per row
    alpha_d: float = 0.0  # N s/m, per row
    passes: int = 1
    reach: float = np.inf  # m, a node deeper than this in a body or polyline is left alone


def elasticity(body: Body) -> Array:
    """Matrix (3, 3), N/m^2, from (e_xx, e_yy, 2 e_xy) to stress (Hughes, The Finite Element Method, 2000)."""
    e, nu = body.young, body.poisson
    if body.plane == "stress":
        return e / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    c = e / ((1 + nu) * (1 - 2 * nu))
    return c * np.array([[1 - nu, nu, 0], [nu, 1 - nu, 0], [0, 0, 0.5 - nu]])


def element(x: Array, c: Array) -> tuple[Array, Array]:
    """Stiffness (2k, 2k) and integrals of the shape functions (k,) of an element of unit thickness, k = 3, 4.

    Constant-strain triangle with one point, bilinear quad with 2x2 Gauss points (Hughes 2000, chapter 3).
    """
    k, p = len(x), 1 / np.sqrt(3)
    stiffness, integrals = np.zeros((2 * k, 2 * k)), np.zeros(k)
    for r, s in [(1 / 3, 1 / 3)] if k == 3 else [(-p, -p), (p, -p), (p, p), (-p, p)]:
        if k == 3:
            weight, shape = 0.5, np.array([1 - r - s, r, s])
            slopes = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
        else:
            weight = 1.0
            shape = np.array([(1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)]) / 4
            slopes = np.array([[s - 1, 1 - s, 1 + s, -1 - s], [r - 1, -1 - r, 1 + r, 1 - r]]) / 4
        jacobian = slopes @ x
        gradient = np.linalg.solve(jacobian, slopes)  # (2, k): dN/dx, dN/dy
        b = np.zeros((3, 2 * k))
        b[0, 0::2], b[1, 1::2] = gradient
        b[2, 1::2], b[2, 0::2] = gradient
        area = weight * np.linalg.det(jacobian)
        stiffness += area * b.T @ c @ b
        integrals += area * shape
    return stiffness, integrals


def assemble(bodies: Sequence[Body]) -> tuple[Array, Array, Array]:
    """Stiffness (2N, 2N), row-sum lumped mass (2N,) and load (2N,); bodies numbered in their order."""
    n = 2 * sum(len(body.points) for body in bodies)
    k, m, f, start = np.zeros((n, n)), np.zeros(n), np.zeros(n), 0
    for body in bodies:
        for nodes in body.elements:
            ke, integrals = element(body.points[nodes], elasticity(body))
            dofs = np.array([2 * (start + i) + axis for i in nodes for axis in (0, 1)])
            k[np.ix_(dofs, dofs)] += body.thickness * ke
            m[dofs] += body.thickness * body.density * np.repeat(integrals, 2)
            f[dofs] += body.thickness * np.outer(integrals, body.body_force).ravel()
        start += len(body.points)
    return k, m, f


def element_bound(bodies: Sequence[Body]) -> float:
    """Largest frequency (rad/s) of any element alone, a bound on that of the assembly; dt_crit = 2/omega.

    Irons, B. M. (1970) and Fried, I. (1972), J. Sound Vib. 22, 407.
    """
    largest = 0.0
    for body in bodies:
        for nodes in body.elements:
            ke, integrals = element(body.points[nodes], elasticity(body))
            s = 1 / np.sqrt(body.density * np.repeat(integrals, 2))
            largest = max(largest, float(np.linalg.eigvalsh(s[:, None] * ke * s)[-1]))
    return float(np.sqrt(largest))


def boundary_loops(body: Body, start: int = 0) -> list[list[int]]:
    """Closed loops of unshared element edges, body on the left, counted from `start`; no node twice."""
    edges = {(e[i - 1], e[i]) for e in body.elements for i in range(len(e))}
    following = {a: b for a, b in edges if (b, a) not in edges}
    loops = []
    while following:
        loop = [min(following)]
        while (node := following.pop(loop[-1])) != loop[0]:
            loop.append(node)
        loops.append([start + i for i in loop])
    return loops


class Surface:
    """Directed segments a -> b with outward normals to their right, and the neighbours of each (-1: none)."""

    def __init__(self, loops: list[list[int]], closed: bool = True, rigid: Array | None = None) -> None:
        """Join `loops` of indices into the positions, or into the points of a `rigid` obstacle."""
        pairs = [(a, b) for p in loops for a, b in zip(p, p[1:] + p[: int(closed)], strict=closed)]
        starts, ends = [a for a, _ in pairs], [b for _, b in pairs]
        self.closed, self.rigid, self.nodes = closed, rigid, np.array(pairs)
        self.before = [ends.index(a) if a in ends else -1 for a in starts]
        self.after = [starts.index(b) if b in starts else -1 for b in ends]

    def ends(self, x: Array) -> tuple[Array, Array, Array]:
        """Start points, end points and unit normals (t_y, -t_x)/|t| at the positions `x` (N, 2)."""
        a, b = np.moveaxis((x if self.rigid is None else self.rigid)[self.nodes], 1, 0)
        t = b - a
        return a, b, np.column_stack([t[:, 1], -t[:, 0]]) / np.linalg.norm(t, axis=1)[:, None]


def signed_gap(
    p: Array, surface: Surface, a: Array, b: Array, n: Array, use: NDArray[np.bool_]
) -> tuple[float, Array, int, float]:
    """Gap (m, < 0 inside), its direction, segment and xi, at the nearest point on the segments in `use`.

    Node to segment (Hughes, Taylor, Sackman, Curnier, Kanoknukulchai 1976; Wriggers 2006). Infinite with
    nothing to look at and beyond the end of an open polyline.
    """
    t = b - a
    free = np.sum((p - a) * t, axis=1) / np.sum(t * t, axis=1)
    xi = np.clip(free, 0, 1)
    distance = np.where(use, np.linalg.norm(p - (a + xi[:, None] * t), axis=1), np.inf)
    k = int(np.argmin(distance))
    if not use[k]:
        return np.inf, np.zeros(2), k, 0.0
    # A hair beyond the end still counts as on the segment: as the gap closes, d below turns into round-off.
    if abs(free[k] - xi[k]) < 1e-9:
        return float((p - a[k]) @ n[k]), n[k], k, float(xi[k])
    neighbour = surface.before[k] if xi[k] == 0 else surface.after[k]
    if neighbour < 0:
        return np.inf, np.zeros(2), k, 0.0
    # Two segments meet at the closest point and can disagree; the one that d crosses more squarely decides.
    d = p - (a[k] if xi[k] == 0 else b[k])
    inside = max(d @ n[k], d @ n[neighbour], key=abs) < 0
    sign = -1.0 if inside else 1.0
    return sign * float(distance[k]), sign * d / max(distance[k], 1e-300), k, float(xi[k])


def surface_rows(x: Array, secondary: Surface, primary: Surface, reach: float = np.inf) -> list[Row]:
    """Active rows of the secondary surface's nodes on the primary surface's segments at positions `x`."""
    a, b, n = primary.ends(x)
    normals = secondary.ends(x)[2]
    rows = []
    for i, node in enumerate(secondary.nodes[:, 0]):
        p, outward = x[node], normals[i] + normals[secondary.before[i]]
        # The nearest of all segments tells inside from outside, whatever the nearest facing one says. Neither
        # for a node that runs along the side of the primary body (corners of aligned bars) nor for a segment
        # at right angles to the node's normal may round-off decide: hence the two tolerances.
        tolerance = 1e-9 * np.ptp(np.vstack([a, b]), axis=0).max()
        if signed_gap(p, primary, a, b, n, use=np.full(len(n), True))[0] > tolerance:
            continue
        gap, direction, k, xi = signed_gap(p, primary, a, b, n, use=n @ outward < -1e-6)
        if -reach <= gap < 0:
            gradient = np.zeros(x.shape)
            gradient[node] = direction
            if primary.rigid is None:
                gradient[primary.nodes[k, 0]] -= (1 - xi) * direction
                gradient[primary.nodes[k, 1]] -= xi * direction
            rows.append((int(node), gap, gradient.ravel()))
    return rows


def contact_rows(x: Array, contact: Contact, surfaces: Sequence[Surface]) -> list[Row]:
    """All active rows of one contact; `surfaces` holds the boundary of each body in global numbers."""
    secondary, other = surfaces[contact.secondary], contact.primary
    if isinstance(other, HalfPlane):
        normal = np.asarray(other.normal) / np.linalg.norm(other.normal)
        gaps = (x - np.asarray(other.point)) @ normal
        touching = [int(i) for i in secondary.nodes[:, 0] if gaps[i] < 0]
        return [(i, float(gaps[i]), np.outer(np.arange(len(x)) == i, normal).ravel()) for i in touching]
    if isinstance(other, Polyline):
        points = np.asarray(other.points, dtype=float)
        line = Surface([list(range(len(points)))], other.closed, points)
        return surface_rows(x, secondary, line, contact.reach)
    rows = surface_rows(x, secondary, surfaces[other], contact.reach)
    return rows + surface_rows(x, surfaces[other], secondary, contact.reach) if contact.passes == 2 else rows


def simulate(bodies: Sequence[Body], contacts: Sequence[Contact], dt: float, n_steps: int) -> dict[str, Any]:
    """Integrate [M + G'PG] a = f - K u - G'(A_s g + A_d G v), P = A_m + dt/2 A_d, by central differences.

    The scheme: Hughes 2000, chapter 9; the mass penalty: Askes, Carames-Saddler, Rodriguez-Ferran 2010.
    Entry n of each history, n = 0..n_steps, is at t = n dt: u, v and v_half (the velocity at (n - 1/2) dt),
    (n_steps + 1, N, 2); contact_force (N, sum over rows), penetration (m), active (rows), kinetic and
    strain (J); force_on (n_steps + 1, C, 2), N on each contact's secondary body; lambdas, a list of dicts
    (contact, node) -> row force; penalty (J, A_s g^2 / 2), mass_penalty (J, A_m (G v)^2 / 2), load_potential
    (J, -f u) and damping_loss (J, taken out up to and including this step). Besides: mass (N,) kg and
    omega_element, rad/s.
    """
    x0 = np.vstack([body.points for body in bodies])
    size, sizes = len(x0), [len(body.points) for body in bodies]
    first = [sum(sizes[:i]) for i in range(len(sizes))]
    k, m, f = assemble(bodies)
    surfaces = [Surface(boundary_loops(b, start)) for b, start in zip(bodies, first, strict=True)]
    free = np.ones(2 * size)
    for body, start in zip(bodies, first, strict=True):
        for node, axis in body.fixed:
            free[2 * (start + node) + axis] = 0
    u = np.vstack([body.displacement for body in bodies]).ravel()
    v = free * np.vstack([body.velocity for body in bodies]).ravel()
    v = v - dt / 2 * free * (f - k @ u) / m  # v_{-1/2}
    histories: dict[str, list[Any]] = {}
    lost = 0.0
    for _ in range(n_steps + 1):
        x = x0 + u.reshape(size, 2)
        rows = [(c, *row) for c, contact in enumerate(contacts) for row in contact_rows(x, contact, surfaces)]
        alphas = [(contacts[c].alpha_s, contacts[c].alpha_m, contacts[c].alpha_d) for c, *_ in rows]
        a_s, a_m, a_d = np.array(alphas).reshape(len(rows), 3).T
        g = np.array([gap for _, _, gap, _ in rows])
        gradient = np.array([free * row[3] for row in rows]).reshape(len(rows), 2 * size)
        p = a_m + dt / 2 * a_d
        residual = free * (f - k @ u - gradient.T @ (a_s * g + a_d * (gradient @ v)))
        matrix = np.diag(m) + gradient.T @ (p[:, None] * gradient) if p.any() else None
        a = residual / m if matrix is None else np.linalg.solve(matrix, residual)
        v_n = v + dt / 2 * a
        row_force = -(a_s * g + a_d * (gradient @ v_n) + a_m * (gradient @ a))
        force_on, lambdas = np.zeros((len(contacts), 2)), {}
        for (c, node, _, direction), value in zip(rows, row_force, strict=True):
            b = contacts[c].secondary
            force_on[c] += value * direction.reshape(size, 2)[first[b] : first[b] + sizes[b]].sum(axis=0)
            lambdas[c, node] = float(value)
        entry = {"u": u.reshape(size, 2), "v": v_n.reshape(size, 2), "v_half": v.reshape(size, 2)}
        entry |= {"penetration": max(0.0, -min(g, default=0.0)), "contact_force": row_force.sum()}
        entry |= {"active": len(rows), "force_on": force_on, "lambdas": lambdas}
        rate = gradient @ v_n
        lost += dt * a_d @ rate**2
        entry |= {"kinetic": 0.5 * v_n @ (m * v_n), "strain": 0.5 * u @ k @ u, "load_potential": -f @ u}
        entry |= {"penalty": 0.5 * a_s @ g**2, "mass_penalty": 0.5 * a_m @ rate**2, "damping_loss": lost}
        for name, value in entry.items():
            histories.setdefault(name, []).append(value)
        v = v + dt * a
        u = u + dt * v
    result: dict[str, Any] = {n: h if n == "lambdas" else np.array(h) for n, h in histories.items()}
    return result | {"mass": m[::2], "omega_element": element_bound(bodies)}
