"""Meshes that the project makes itself: deterministic, at any resolution."""

from workbench.core.samples.catalogue import (
    SampleInfo,
    make_sample,
    sample_ids,
    sample_info,
    sample_kind,
    sample_label,
)

__all__ = ["SampleInfo", "make_sample", "sample_ids", "sample_info", "sample_kind", "sample_label"]
