"""Exact and independent solutions, for tests, examples and documentation only."""
