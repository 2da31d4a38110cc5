"""Runs, reads and judges; sees the solver only through scenes in and run folders out."""
