"""Doubts motion that no road user makes, and tracks that are not separate bodies."""
