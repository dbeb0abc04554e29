"""Which method holds where, in words and numbers: the table of the stability study and what it asserts. SI units."""

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr
from stability_benches import Bench

from bipenalty.row_restitution import RestitutionMap

OURS = ("critical", "parameter-free")
GOOD = {"bar": (0.06, 0.01), "cylinders": (0.03, 0.002)}  # force error and deviation of the energy, at most


def of(part: xr.Dataset, method: str) -> xr.Dataset:
    """The runs of a method."""
    return part.isel(method=list(part["method"].values).index(method))


def holds(part: xr.Dataset, kind: str) -> xr.DataArray:
    """Where force error and energy are both good."""
    force, energy = GOOD[kind]
    return ~part["stopped"] & (part["force_error"] <= force) & (abs(part["energy_ratio"] - 1) <= energy)


def window(good: xr.DataArray) -> str:
    """The longest stretch of good values, in words."""
    edges = np.flatnonzero(np.diff([0, *good.values.astype(int), 0]))
    if len(edges) == 0:
        return "nowhere"
    first, last = max(edges.reshape(-1, 2), key=lambda pair: pair[1] - pair[0])
    if last - first == good.size:
        return "everywhere"
    low, high = (float(good[good.dims[0]][i]) for i in (first, last - 1))
    return f"{low:.2g} to {high:.2g}"


def report(charts: dict[str, xr.Dataset], benches: Sequence[Bench]) -> None:
    """Where each method holds, and the worst of the two that are to hold from a factor of 1 on."""
    limits = "; ".join(f"{kind}: {100 * force:g} % and {100 * energy:g} %" for kind, (force, energy) in GOOD.items())
    print(f"\nWhere force error and energy are good ({limits})")
    columns = [(bench.symbol, bench.kind, charts["ps"].sel(scene=bench.name)) for bench in benches]
    columns += [("dt/limit", kind, charts["dt"].sel(scene=kind)) for kind in GOOD]
    for heads in ([kind for _, kind, _ in columns], [symbol for symbol, _, _ in columns]):
        print(f"{'':27}" + "".join(f"{head:>16}" for head in heads))
    for method in charts["ps"]["method"].values:
        words = [window(holds(of(part, method), kind)) for _, kind, part in columns]
        print(f"{method:27}" + "".join(f"{word:>16}" for word in words))
    print(
        "\nWorst from a factor of 1 (penetration: 30) on   force     energy   impulse   penetration/(v_n dt)   closures"
    )
    for bench in benches:
        for method in OURS:
            found = worst_of(charts["ps"], bench.name, method)
            energy, impulse = (f"{100 * found[name]:+.2f} %" for name in ("energy", "impulse"))
            tail = f"{found['penetration']:>23.2f}{found['closures']:>11.0f}"
            print(f"{bench.name:25}{method:20}{100 * found['force']:>6.2f} %{energy:>11}{impulse:>10}{tail}")
    print("\nCylinders at 0.98 of the assembled mesh's limit (in brackets: at half the elements' limit)")
    for method in OURS:
        long, short = (of(charts[name].sel(scene="cylinders"), method) for name in ("dt", "ps"))
        long, short = long.sel(share=0.98), short.isel(factor=abs(short["factor"].values - 10).argmin())
        words = [
            f"force {100 * float(run['force_error']):.2f} %, energy {100 * float(run['energy_ratio']) - 100:+.3f} %"
            for run in (long, short)
        ]
        print(f"{method:25}{words[0]} ({words[1]})")
    print()
    for bench in benches:
        print(f"{bench.name}: force against {bench.reference}")


def worst_of(chart: xr.Dataset, scene: str, method: str) -> dict[str, float]:
    """The worst of a method on a bench from a factor of 1 on; penetration from 30 on."""
    part = of(chart.sel(scene=scene), method)
    part = part.isel(factor=part["factor"].values > 0.99)
    energy, impulse = part["energy_ratio"].values - 1, part["impulse_error"].values
    return {
        "force": float(part["force_error"].max(skipna=False)),
        "energy": float(energy[abs(energy).argmax()]),
        "impulse": float(impulse[abs(impulse).argmax()]),
        "penetration": float(part["penetration"].isel(factor=part["factor"].values > 30).max(skipna=False)),
        "closures": float(part["closures"].max(skipna=False)),
    }


def check(charts: dict[str, xr.Dataset], row: RestitutionMap, benches: Sequence[Bench]) -> None:
    """What the titles claim, and what the critical rule and the parameter-free method are to keep."""
    others = {str(method): True for method in charts["ps"]["method"].values}
    for bench in benches:
        force, energy = GOOD[bench.kind]
        for method in OURS:
            found, name = worst_of(charts["ps"], bench.name, method), f"{bench.name}, {method}"
            assert found["force"] <= force, f"{name}: the force is off by {found['force']:.3f}"
            assert abs(found["energy"]) <= energy, f"{name}: the energy is off by {found['energy']:.4f}"
            assert found["penetration"] <= 1.5, f"{name}: a node goes in by {found['penetration']:.2f} v_n dt"
            assert bench.kind != "bar" or found["closures"] == 1, f"{name}: {found['closures']:.0f} closures"
        for method in others:
            good = holds(of(charts["ps"].sel(scene=bench.name), method), bench.kind)
            others[method] &= bool(good.isel(factor=good["factor"].values > 0.99).all())
    held = {method for method, all_good in others.items() if all_good}
    assert held == set(OURS), f"from a factor of 1 on, on every bench, these hold: {sorted(held)}"
    cylinders = charts["dt"].sel(scene="cylinders")
    within = cylinders.isel(share=cylinders["share"].values < 1.01)
    for method in OURS:
        good = holds(of(within, method), "cylinders")
        assert good.all(), f"{method} gives way at {window(good)} of the mesh's limit"
    assert of(within, "stiffness")["stopped"].any(), "stiffness gets to the mesh's limit"
    published = float(row.largest[abs(row.zeta).argmin(), abs(row.s2 - 3.6).argmin()])
    assert math.isclose(published, 2.6, abs_tol=0.05), f"the published choice throws back {published:.2f} times as fast"
