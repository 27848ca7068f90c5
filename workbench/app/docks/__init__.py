"""Docks that show a running map: colour maps, histogram, convergence."""
