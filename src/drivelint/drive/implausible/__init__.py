"""Doubts what no road user does, and tracks that are no body of their own."""
