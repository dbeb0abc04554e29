"""Converged answers, kept in small files of the package; `converge` makes them."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import numpy as np
import numpy.typing as npt

from bipenalty import checks

Floats = npt.NDArray[np.float64]

#: Points in time at which the impulse is kept, and the displacements.
INSTANTS, PICTURES = 2000, 60


@dataclass(frozen=True)
class Reference:
    """A converged run.

    Attributes
    ----------
    name : of the case.
    time, impulse : (n,) s and the impulse of the total contact force up to then, N s/m.
    probes, probe_bodies : (p, 2) places in m and the bodies they belong to.
    pictures, displacement : (k,) s and (k, p, 2) m.
    momentum : (bodies, 2) at the end, N s/m.
    energy : at the end over that at the start, -.
    contact : closing and opening, s.
    uncertainty : in each error measure of the study, the largest of the changes with mesh, dt and method.
    about : how it was made, and the changes, in words.
    """

    name: str
    time: Floats
    impulse: Floats
    probes: Floats
    probe_bodies: npt.NDArray[np.int64]
    pictures: Floats
    displacement: Floats
    momentum: Floats
    energy: float
    contact: tuple[float, float]
    uncertainty: Mapping[str, float]
    about: str

    def impulse_until(self, t: Floats) -> Floats:
        """Impulse up to times t (s), N s/m, of their shape."""
        return np.asarray(np.interp(t, self.time, self.impulse))

    def displacement_at(self, points: Floats, t: float) -> Floats:
        """Displacement (p, 2) of the probes at t (s), m."""
        ok = np.shape(points) == self.probes.shape
        checks.within("reference", "points", np.shape(points), ok, "the probes", "sample the run at them")
        k = int(np.clip(np.searchsorted(self.pictures, t), 1, len(self.pictures) - 1))
        share = (t - self.pictures[k - 1]) / (self.pictures[k] - self.pictures[k - 1])
        return np.asarray((1 - share) * self.displacement[k - 1] + share * self.displacement[k])

    def save(self, folder: Path) -> Path:
        """Write it to `folder`, compressed; returns the file."""
        path = folder / f"{file_name(self.name)}.npz"
        words = json.dumps({"uncertainty": dict(self.uncertainty), "about": self.about}, indent=1)
        np.savez_compressed(
            path,
            impulse=self.impulse,
            t_end=self.time[-1],
            probes=self.probes,
            probe_bodies=self.probe_bodies.astype(np.int8),
            displacement=self.displacement.astype(np.float32),
            momentum=self.momentum,
            energy=self.energy,
            contact=self.contact,
            words=words,
        )
        return path

    @classmethod
    def load(cls, name: str) -> Reference:
        """The stored reference of a case.

        Raises
        ------
        InputError : there is none of that name.

        Example
        -------
        >>> reference = Reference.load("stack")
        >>> reference.momentum.shape, reference.uncertainty["impulse"] < 0.01
        ((3, 2), True)
        """
        file = resources.files("bipenalty.study") / "references" / f"{file_name(name)}.npz"
        remedy = "make it with python -m bipenalty.study.converge"
        checks.within("reference", "name", repr(name), file.is_file(), "that of a stored one", remedy)
        with np.load(io.BytesIO(file.read_bytes())) as kept:
            words = json.loads(str(kept["words"]))
            end = float(kept["t_end"])
            displacement = kept["displacement"].astype(np.float64)
            return cls(
                name,
                np.linspace(0, end, len(kept["impulse"])),
                kept["impulse"],
                kept["probes"],
                kept["probe_bodies"].astype(np.int64),
                np.linspace(0, end, len(displacement)),
                displacement,
                kept["momentum"],
                float(kept["energy"]),
                (float(kept["contact"][0]), float(kept["contact"][1])),
                words["uncertainty"],
                words["about"],
            )


def file_name(name: str) -> str:
    """Of the stored reference of a case."""
    return name.lower().replace(" ", "_")
