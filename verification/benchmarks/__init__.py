"""Benchmarks: what the solver's kernels, events and whole runs cost, as ratios to what the machine gives beside them."""
