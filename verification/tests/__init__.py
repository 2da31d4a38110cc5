"""Tests through the command line: scenes in, run folders out."""
