"""Profiles of wheel and rail across the track: reading, smoothing, and where they touch."""
