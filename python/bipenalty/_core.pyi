"""Types of the compiled core; the Python layer is what users import."""

from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Batch",
    "Model",
    "Run",
    "__version__",
    "check_elastic",
    "check_mesh",
    "check_method",
    "instruction_set",
    "instruction_sets",
    "probe_bandwidth",
    "probe_fma_rate",
    "probe_kernel",
]
__version__: str
instruction_set: str

def instruction_sets() -> list[str]: ...
def probe_fma_rate(isa: str = "auto") -> float: ...
def probe_bandwidth(bytes: int) -> tuple[float, float]: ...
def probe_kernel(model: Model, lanes: int, isa: str = "auto", steps: int = 100, first: int = 0) -> float: ...
def check_mesh(
    points_: NDArray[np.float64], triangles: NDArray[np.int64], quads: NDArray[np.int64], /
) -> tuple[NDArray[np.int64], NDArray[np.int64], bool, list[NDArray[np.int64]]]: ...
def check_elastic(object: str, material: Any) -> None: ...
def check_method(object: str, method: Any) -> None: ...

@final
class Model:
    def __new__(
        cls,
        bodies: list[Any],
        contacts: list[Any],
        supports: list[tuple[str, list[int], tuple[bool, bool]]],
        obstacles: list[Any],
    ) -> Model: ...
    @property
    def critical_dt(self) -> float: ...
    def assembled_critical_dt(self) -> float: ...
    def scaled_critical_dt(self, young: list[float], density: list[float], assembled: bool) -> float: ...
    def worst_stiffening(self) -> float: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def mass(self) -> NDArray[np.float64]: ...
    @property
    def contacts(self) -> list[str]: ...

@final
class Run:
    def __new__(
        cls,
        model: Model,
        method: Any,
        dt: float,
        allow_unstable: bool,
        velocity: NDArray[np.float64],
        displacement: NDArray[np.float64],
        isa: str,
        threads: int | None,
    ) -> Run: ...
    def configure(
        self, every: int, energy_every: int, snapshots: list[int], displacement_limit: float, steps: int
    ) -> None: ...
    def advance(self, steps: int, last: bool) -> None: ...
    @property
    def steps(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def outcome(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def rows(self) -> list[tuple[float, float]]: ...
    def active_limits(self) -> tuple[float, float]: ...
    @property
    def displacement(self) -> NDArray[np.float64]: ...
    @property
    def velocity(self) -> NDArray[np.float64]: ...
    def observations(self) -> dict[str, Any]: ...

@final
class Batch:
    def __new__(
        cls,
        model: Model,
        runs: list[Any],
        velocity: NDArray[np.float64],
        displacement: NDArray[np.float64],
        *,
        allow_unstable: bool = False,
        displacement_limit: float | None = None,
        every: int = 0,
        energy_every: int = 0,
        lanes: int = 0,
        isa: str = "auto",
    ) -> Batch: ...
    def check(self, index: int) -> None: ...
    def advance(self, threads: int, seconds: float) -> int: ...
    @property
    def finished(self) -> int: ...
    def __len__(self) -> int: ...
    def observations(self, index: int) -> dict[str, Any] | None: ...
