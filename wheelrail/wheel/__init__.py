"""Wheel models."""
