"""Keeps tests to themselves."""

import verification.harness.hermetic  # noqa: F401  (before anything that reads the environment)
