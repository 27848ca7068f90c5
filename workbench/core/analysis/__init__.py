"""What a formula is good for: the badges of Corollary 2.1 and the convexity of Theorem 8.3, with witnesses."""

from workbench.core.analysis.analyse import analyse
from workbench.core.analysis.properties import Analysis, Property

__all__ = ["Analysis", "Property", "analyse"]
