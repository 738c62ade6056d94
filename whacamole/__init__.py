"""Synthetic video datasets of people and cameras in one metric world."""

__version__ = "0.1.0"
