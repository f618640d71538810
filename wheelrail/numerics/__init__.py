"""Numerical methods without railway content."""
