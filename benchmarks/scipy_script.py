"""The script a researcher would write instead: two colliding bodies, SciPy matrix, plain NumPy.

Quads, plane strain, lumped mass, central differences, frictionless node-to-segment contact with a stiffness
penalty, one pass, small strains. Tuned as far as NumPy goes: the time step is folded into the matrix, points
are complex numbers, arrays are updated in place and contact looks only inside the overlap of the two bodies.
A node inside is pushed along the line to the closest point, be it on a segment or at a corner of a dent.
"""

import time
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]
Points = NDArray[np.complex128]


def prepare(
    points: Array,
    quads: Nodes,
    body_of_node: Nodes,
    young_per_body: Array,
    poisson: float,
    density: float,
    loop_top: Nodes,
    loop_bottom: Nodes,
) -> dict[str, Any]:
    """Assemble the CSR stiffness (2N, 2N) and the lumped mass (N,) of counter-clockwise `quads` (E, 4).

    `points` (N, 2) m; `young_per_body` N/m^2; `density` kg/m^3. The loops are counter-clockwise boundary
    nodes; those of the top body meet the segments of the bottom body, whose corners must be blunt.
    """
    n_quads = len(quads)
    young = np.asarray(young_per_body)[np.asarray(body_of_node)[quads[:, 0]]]
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    shear = young / (2 * (1 + poisson))
    elasticity = np.zeros((n_quads, 3, 3))
    elasticity[:, :2, :2] = lame[:, None, None]
    elasticity[:, [0, 1], [0, 1]] += 2 * shear[:, None]
    elasticity[:, 2, 2] = shear
    blocks, mass = np.zeros((n_quads, 8, 8)), np.zeros((n_quads, 4))
    for r, s in np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / np.sqrt(3):
        shape = np.array([(1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)]) / 4
        slopes = np.array([[s - 1, 1 - s, 1 + s, -1 - s], [r - 1, -1 - r, 1 + r, 1 - r]]) / 4
        jacobian = slopes @ points[quads]
        area = np.linalg.det(jacobian)
        gradient = np.linalg.solve(jacobian, np.broadcast_to(slopes, (n_quads, 2, 4)))
        strain = np.zeros((n_quads, 3, 8))
        strain[:, 0, 0::2], strain[:, 1, 1::2] = gradient[:, 0], gradient[:, 1]
        strain[:, 2, 1::2], strain[:, 2, 0::2] = gradient[:, 0], gradient[:, 1]
        blocks += area[:, None, None] * (strain.transpose(0, 2, 1) @ elasticity @ strain)
        mass += density * area[:, None] * shape
    dofs = np.stack([2 * quads, 2 * quads + 1], axis=-1).reshape(n_quads, 8)
    rows, columns = np.repeat(dofs, 8, axis=1).ravel(), np.tile(dofs, (1, 8)).ravel()
    size = 2 * len(points)
    return {
        "stiffness": sp.coo_matrix((blocks.ravel(), (rows, columns)), shape=(size, size)).tocsr(),
        "mass": np.bincount(quads.ravel(), mass.ravel(), len(points)),
        "points": np.ascontiguousarray(points, dtype=float).view(complex).ravel(),
        "boundary": np.concatenate([loop_top, loop_bottom]),  # secondary nodes, then starts of the segments
        "tops": len(loop_top),
        "end": len(loop_top) + np.roll(np.arange(len(loop_bottom)), -1),
    }


def near(z: Points, end: Nodes, tops: int, margin: float) -> tuple[Nodes, Nodes] | None:
    """Secondary nodes and primary segments (by number) in the overlap of the bounding boxes plus `margin`.

    `z` holds the secondary nodes (the first `tops`), then the segments' starts; `end` the place of each end.
    """
    x, y = np.ascontiguousarray(z.real), np.ascontiguousarray(z.imag)
    left = max(x[:tops].min(), x[tops:].min()) - margin
    right = min(x[:tops].max(), x[tops:].max()) + margin
    low = max(y[:tops].min(), y[tops:].min()) - margin
    high = min(y[:tops].max(), y[tops:].max()) + margin
    if left > right or low > high:
        return None
    nodes = (x[:tops] >= left) & (x[:tops] <= right) & (y[:tops] >= low) & (y[:tops] <= high)
    segments = np.maximum(x[tops:], x[end]) >= left
    segments &= np.minimum(x[tops:], x[end]) <= right
    segments &= np.maximum(y[tops:], y[end]) >= low
    segments &= np.minimum(y[tops:], y[end]) <= high
    return (np.flatnonzero(nodes), np.flatnonzero(segments)) if nodes.any() and segments.any() else None


def run(
    problem: dict[str, Any], alpha_s: float, dt: float, n_steps: int, velocity: Array, search: str = "brute"
) -> dict[str, Any]:
    """Advance `n_steps` of `dt` (s) from rest shape and `velocity` (N, 2), with `alpha_s` in N/m per node.

    `search="brute"` filters by bounding box at every step; "lists" keeps the candidates until a boundary node
    has moved by half a skin. Returns contact_force (N/m) and penetration (m) at t = n dt, n < n_steps, the
    last displacement u_n (N, 2), velocity v_{n-1/2} (N, 2) and seconds, the wall time of the loop alone.
    """
    if search not in ("brute", "lists"):
        raise ValueError(f'search = {search!r}, must be "brute" or "lists"')
    boundary, tops = problem["boundary"], problem["tops"]
    z0, end = problem["points"][boundary], problem["end"]
    scale = dt**2 / problem["mass"]
    # With w = dt v a step is w -= dt^2 M^-1 (K u + contact), u += w: no other pass over the vectors.
    matrix = sp.csr_matrix(sp.diags(np.repeat(-scale, 2)) @ problem["stiffness"])
    w = np.array(dt * velocity, dtype=float).ravel()
    u = np.zeros_like(w)
    wz, uz = w.view(complex), u.view(complex)
    skin = 0.5 * float(np.abs(z0[end] - z0[tops:]).mean()) if search == "lists" else 0.0
    reference = np.full(len(boundary), np.inf + 0j)
    who, rest, m, k = boundary[:0], z0[:0], 0, 0
    force, penetration = np.zeros(n_steps), np.zeros(n_steps)
    clock = time.perf_counter()
    for n in range(n_steps):
        w += matrix @ u
        moved = uz[boundary]
        # Components below a third of the skin: no node has moved by half of it.
        if search == "brute" or np.abs((moved - reference).view(float)).max() > skin / 3:
            reference, pairs, m = moved, near(z0 + moved, end, tops, skin), 0
            if pairs is not None:
                m, k = len(pairs[0]), len(pairs[1])
                local_number = np.concatenate([pairs[0], tops + pairs[1], end[pairs[1]]])
                who, rest = boundary[local_number], z0[local_number]
        if m:
            z = rest + uz[who]
            a = z[m : m + k]
            t = z[m + k :] - a
            length = np.abs(t)
            t /= length
            local = (z[:m, None] - a) * t.conj()  # along the segment + i * depth
            along, depth = local.real, local.imag
            foot = np.minimum(np.maximum(along, 0.0), length)  # closest point of each segment
            hit = ((along - foot) ** 2 + depth**2).argmin(axis=1)  # closest segment of each node
            each = np.flatnonzero(depth[np.arange(m), hit] > 0)
            if len(each):
                hit = hit[each]
                foot = foot[each, hit]
                inward, xi = local[each, hit] - foot, foot / length[hit]
                deep = np.abs(inward)
                force[n], penetration[n] = alpha_s * deep.sum(), deep.max()
                push = -alpha_s * inward * t[hit]
                i, first, second = who[each], who[m + hit], who[m + k + hit]
                wz[i] += scale[i] * push
                np.subtract.at(wz, first, scale[first] * (1 - xi) * push)
                np.subtract.at(wz, second, scale[second] * xi * push)
        u += w
    seconds = time.perf_counter() - clock
    u, v = u.reshape(-1, 2), w.reshape(-1, 2) / dt
    return {"seconds": seconds, "contact_force": force, "penetration": penetration, "u": u, "v": v}
