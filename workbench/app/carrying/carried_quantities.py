"""What can be shown of each triangle of a carried surface: measures of its own map, n = 2."""

from __future__ import annotations

from workbench.app.quantities.quantities import Quantity

CARRIED_QUANTITIES: tuple[Quantity, ...] = (
    Quantity("symmetric-dirichlet", "Symmetric Dirichlet", "(32)", "σ₁² + σ₂² + σ₁⁻² + σ₂⁻²", 4.0, least_span=0.01),
    Quantity("condition-number", "Condition number", "(29)", "σ₁ / σ₂", 1.0, least_span=0.01),
    Quantity("det", "Factor of area", "", "σ₁ σ₂", 0.0, centre=1.0, is_logarithmic=True),
    Quantity("sigma1", "Largest stretch", "", "σ₁", 0.0, centre=1.0, is_logarithmic=True),
    Quantity("sigman", "Smallest stretch", "", "σ₂", 0.0, centre=1.0, is_logarithmic=True),
)
"""Their ranges are their own: the same words mean other numbers for the solid round it, where n = 3."""
