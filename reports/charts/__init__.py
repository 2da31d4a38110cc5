"""Drawing only: every function here takes prepared data and computes nothing."""
