"""The same colliding cylinders in the programs people use instead: `python benchmarks/peers/run.py`."""
