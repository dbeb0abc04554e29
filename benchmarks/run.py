"""The measurements behind the performance claims: writes out/bench.json and out/bench.md.

python benchmarks/run.py            some four minutes on a quiet machine
python benchmarks/run.py --quick    a coarse mesh and few rounds, to see that it works
"""

import argparse
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import claims
import machine
import numpy as np
import report
import timed_scenes as scenes
from measure import spread, time_steps
from plan import QUICK, Plan
from speed import everything
from versus_script import duels


def plain(value: Any) -> Any:
    """Arrays as lists and NaN as null, for JSON.

    Example
    -------
    >>> plain({"a": np.array([1.0, math.nan])})
    {'a': [1.0, None]}
    """
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def measurements(plan: Plan) -> tuple[dict[str, Any], str]:
    """Everything, as what goes into JSON and as the report."""
    about = machine.description()
    cases = scenes.cases(plan.segments)
    nodes = cases[0].scene.n_nodes
    say(f"{len(cases)} scenes, {nodes} nodes, {plan.rounds} rounds of {plan.pieces * plan.steps} steps")
    steps = time_steps(cases, plan)
    say(f"package and script, {plan.script_rounds} rounds")
    against = duels(plan)
    speed = everything.measured(plan, say)
    found = [*speed.claims, *claims.of_speed(against), *claims.of_contact(steps), *claims.of_absence(steps)]
    about |= {"load average at the end": machine.load()}
    data = {
        "machine": about,
        "plan": asdict(plan),
        "nodes": nodes,
        "seconds_per_step": steps.seconds,
        "ns_per_node_step": {name: asdict(spread(s * 1e9 / nodes)) for name, s in steps.seconds.items()},
        "active_rows": steps.rows,
        "share_of_a_core": steps.share,
        "against_script": [asdict(duel) for duel in against],
        "speed": speed.data,
        "expectations": [claim.as_dict() for claim in found],
    }
    tables = [
        *speed.tables,
        report.single_steps(steps, nodes),
        report.against_script(against),
        report.parts(steps, nodes),
        report.expectations(found, plan.judged),
    ]
    return plain(data), report.whole(about, plan, tables)


def say(text: str) -> None:
    """Progress, apart from the report."""
    print(text, file=sys.stderr, flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few rounds on a coarse mesh")
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder to write to (default: out)")
    chosen = parser.parse_args(arguments)
    data, text = measurements(QUICK if chosen.quick else Plan())
    print(text)
    chosen.out.mkdir(parents=True, exist_ok=True)
    (chosen.out / "bench.json").write_text(json.dumps(data, indent=1), encoding="utf-8")
    (chosen.out / "bench.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
