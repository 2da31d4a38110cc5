"""Plain data that a chart draws or a template shows."""

from types import SimpleNamespace


class Shown(SimpleNamespace):
    """What is shown, under names that carry their units; a figure's has its finding as `title`."""
