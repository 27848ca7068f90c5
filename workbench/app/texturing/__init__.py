"""Patterns and pictures on views: which, how large, how turned, laid out where."""
