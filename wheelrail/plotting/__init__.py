"""Figures of results and models; each function takes plain data and returns a matplotlib Figure."""
