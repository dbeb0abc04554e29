"""How near the package comes to what the machine can do: kernel, one run, sweeps, one large model."""
