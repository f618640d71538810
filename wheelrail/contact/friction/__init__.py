"""Friction that depends on the slip velocity: laws, memory, and the contact problem that they make."""
