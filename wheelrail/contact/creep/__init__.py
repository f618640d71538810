"""Steady rolling contact laws: creep force against creepage, for comparison with the exact theory and for fast runs.

Sign convention of the project: creepage is the velocity of the rail's surface relative to the wheel's over the speed,
forces and spin moment are those on the rail. Positive creepage gives negative force. With x along the rolling direction
the rigid slip over the speed is (creepage_x - y spin, creepage_y + x spin).
"""
