"""The harness: run scenes, load run folders, compare with references, sweep, evaluate claims."""
