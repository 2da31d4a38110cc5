"""The harness: run scenes, load run folders, compare with references, refine meshes, budget errors, evaluate claims."""
