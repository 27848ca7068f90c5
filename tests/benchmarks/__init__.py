"""Timings that print ratios; run by hand with `make bench`, never asserted."""
