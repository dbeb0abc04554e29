"""How much is measured: of `make bench`, and of its quick version."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    Parameters
    ----------
    segments : edges on the rim of each cylinder.
    rounds : of the single steps.
    places : models of each case in a round, of which the fastest counts: where a model happens to lie in memory
        alone makes 10 %. They are built anew in each round, in another order.
    before : steps before the measurement, so that contact is well under way.
    pieces, steps : a round times so many pieces of so many steps of each model, piece by piece in turn.
    warm : untimed steps before each piece, which bring the model back into the caches.
    script_rounds : of the comparison with the script.
    judged : whether verdicts on the expectations mean anything.
    small : edges on the rim of each cylinder of the mesh that stays in a core's own cache with 16 lanes.
    kernel_rounds, kernel_seconds : of the bare kernel, and seconds of each of its measurements.
    single_rounds : of one run alone.
    start_rounds, start_steps : of the start of a run, and steps of the run that it is compared with.
    sweep_rounds, sweep_ps : of the whole sweep, and its stiffness penalty factors a method.
    width_rounds, width_strides, width_segments : of numbers of lanes, times 64 steps each, and meshes.
    large_rounds, large_work, large_sizes : of one large model, its node-steps each, and its nodes.
    """

    segments: int = 116
    rounds: int = 41
    places: int = 3
    before: int = 200
    pieces: int = 16
    steps: int = 20
    warm: int = 3
    script_rounds: int = 9
    judged: bool = True
    small: int = 60
    kernel_rounds: int = 21
    kernel_seconds: float = 5e-3
    single_rounds: int = 21
    start_rounds: int = 11
    start_steps: int = 2000
    sweep_rounds: int = 5
    sweep_ps: int = 29
    width_rounds: int = 5
    width_strides: int = 3
    width_segments: tuple[int, ...] = (60, 116, 232, 464)
    large_rounds: int = 5
    large_work: float = 2e6
    large_sizes: tuple[int, ...] = (1000, 2000, 4000, 10_000, 30_000, 100_000, 300_000, 1_000_000)


QUICK = Plan(
    24,
    rounds=3,
    places=2,
    before=20,
    pieces=2,
    steps=10,
    warm=1,
    script_rounds=2,
    judged=False,
    small=16,
    kernel_rounds=2,
    kernel_seconds=2e-4,
    single_rounds=2,
    start_rounds=2,
    start_steps=200,
    sweep_rounds=2,
    sweep_ps=2,
    width_rounds=2,
    width_strides=1,
    width_segments=(16, 24),
    large_rounds=2,
    large_work=2e4,
    large_sizes=(300, 1000, 3000),
)
