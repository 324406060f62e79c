"""Errors, times and memory that the text states."""
