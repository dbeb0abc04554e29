"""All measurements of speed, one after another: what goes into the JSON file, the tables, and the expectations."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from claims import Claim
from plan import Plan

from speed import claims, kernel, large, report, report_runs, single, start, sweep, widths


@dataclass(frozen=True)
class Speed:
    """What was found: for the JSON file, as tables, as expectations."""

    data: dict[str, Any]
    tables: list[str]
    claims: list[Claim]


def measured(plan: Plan, say: Callable[[str], None]) -> Speed:
    """Takes some four minutes; `say` is told what comes next."""
    say(f"bare kernel, {plan.kernel_rounds} rounds")
    cells = kernel.cells(plan)
    say(f"one run, {plan.single_rounds} rounds; its start, {plan.start_rounds}")
    alone, begun = single.measured(plan), start.measured(plan)
    say(f"whole sweep, {plan.sweep_rounds} rounds")
    whole = sweep.measured(plan)
    say(f"numbers of lanes, {plan.width_rounds} rounds")
    methods, sizes = widths.by_method(plan), widths.by_size(plan)
    say(f"one large model, {plan.large_rounds} rounds")
    models = large.sizes(plan)
    found = {
        "kernel": cells,
        "one_run": alone,
        "start": begun,
        "sweep": whole,
        "lanes": [*methods, *sizes],
        "large": models,
    }
    data = {
        name: [asdict(v) for v in value] if isinstance(value, list) else asdict(value) for name, value in found.items()
    }
    tables = [
        report.kernel(cells),
        report.sweep(whole),
        report.widths(methods, sizes),
        report_runs.single(alone),
        report_runs.large(models),
        report_runs.start(begun),
    ]
    expected = [
        *claims.of_kernel(cells),
        *claims.of_sweep(whole),
        *claims.of_single(alone),
        *claims.of_large(models),
        *claims.of_start(begun),
    ]
    return Speed(data, tables, expected)
