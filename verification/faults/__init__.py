"""Runs that are killed at random moments and resumed, against runs that were left alone."""
