"""The FMU round the model: variable table, slave, packing; no physics."""
