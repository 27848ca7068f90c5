"""Numerical core: meshes, distortions, energies, solvers. Knows no window and no drawing."""
