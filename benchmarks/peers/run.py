"""The colliding cylinders in the programs people use instead: writes docs/peers.md and out/peers.json.

python benchmarks/peers/run.py                            two minutes with Akantu, seven more with CalculiX
python benchmarks/peers/run.py --segments 24 --rounds 1   a coarse mesh, to see that it works
Akantu in an environment of its own: --akantu-python path/to/its/python
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # the other benchmarks, and this folder as a package

import machine
from run import plain

import bipenalty as bp
from peers import judge
from peers.akantu_peer import Akantu
from peers.bipenalty_peer import Package
from peers.calculix_peer import CalculiX
from peers.interface import Case, Peer, scene
from peers.page import page
from peers.report import Row
from peers.scipy_peer import Script

HERE = Path(__file__).parents[2]
WRONG = (1e3, 1e5)  # factors on the penalty


def measured(peers: Sequence[Peer], mesh: bp.Mesh, case: Case, rounds: int, wanted: judge.Reference) -> list[Row]:
    """All rows: first the timed runs, in turn, then one with histories each, then the wrong penalties."""
    rows = [Row(peer.name, peer.available(), peer.install, peer.better) for peer in peers]
    here = [(peer, row) for peer, row in zip(peers, rows, strict=True) if row.version is not None]
    for row in rows:
        say(f"{row.title}: " + ("measured" if row.version else f"skipped, not installed ({row.install})"))
    for number in range(rounds):
        for peer, row in here:
            if number < peer.rounds:
                row.seconds.append(peer.run(mesh, replace(case, recorded=False)).seconds)
        say(f"round {number + 1} of {rounds}")
    for peer, row in here:
        row.verdict = judge.judged(peer.run(mesh, case), case, wanted)
        say(f"{row.title}: {row.verdict.words}")
        for factor in WRONG:
            other = judge.like(case, factor)
            row.wrong[factor] = judge.judged(peer.run(mesh, other), other, wanted)
            say(f"{row.title}, penalty x {factor:.0e}: {row.wrong[factor].words}")
    return rows


def say(text: str) -> None:
    """Progress, apart from the page."""
    print(text, file=sys.stderr, flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--segments", type=int, default=116, help="edges on the rim of each cylinder (default: 116)")
    parser.add_argument("--rounds", type=int, default=9, help="timed runs of each; three of the slow ones (default: 9)")
    parser.add_argument("--limit", type=float, default=120, help="seconds for one run (default: 120)")
    parser.add_argument("--only", nargs="*", help="names of programs; all unless given")
    parser.add_argument("--akantu-python", default=sys.executable, help="interpreter that has the package akantu")
    parser.add_argument("--ccx", default="ccx", help="command of CalculiX (default: ccx)")
    parser.add_argument("--docs", type=Path, default=HERE / "docs", help="folder of peers.md (default: docs)")
    parser.add_argument("--out", type=Path, default=HERE / "out", help="folder of peers.json (default: out)")
    chosen = parser.parse_args(arguments)
    peers: list[Peer] = [Package(), Package(True), Script(), CalculiX(chosen.ccx), Akantu(chosen.akantu_python)]
    if chosen.only:
        peers = [peer for peer in peers if peer.name in chosen.only]
    mesh = bp.mesh.disc(radius=1.0, segments=chosen.segments)
    case = Case(ps=1.0, dt=bp.Model(scene(mesh)).dt, limit=chosen.limit)
    about = machine.description()
    wanted = judge.reference(mesh, case)
    rows = measured(peers, mesh, case, chosen.rounds, wanted)
    agreement = judge.agreement(mesh, case, wanted)
    text = page(rows, case, 2 * mesh.n_nodes, wanted, agreement, about)
    print(text)
    data = {"machine": about, "case": asdict(case), "nodes": 2 * mesh.n_nodes, "reference": agreement}
    data["impulse"] = {"summed": wanted.summed[-1], "resultant": wanted.resultant[-1]}
    data["programs"] = [asdict(row) for row in rows]
    for folder, name, written in (
        (chosen.docs, "peers.md", text),
        (chosen.out, "peers.json", json.dumps(plain(data), indent=1)),
    ):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(written, encoding="utf-8")


if __name__ == "__main__":
    main()
