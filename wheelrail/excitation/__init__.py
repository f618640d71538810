"""What excites the system: roughness of wheel and rail."""
