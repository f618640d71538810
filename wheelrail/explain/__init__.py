"""The model of a case in words and numbers, without computing its Green's functions."""

from wheelrail.explain.report import explain

__all__ = ["explain"]
