"""Track models."""
