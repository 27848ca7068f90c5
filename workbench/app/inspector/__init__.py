"""The inspector: formula, properties and plots of the distortion in force."""
