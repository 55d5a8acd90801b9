"""Finds motion that is impossible for a road user, and tracks that are not separate bodies, and reports both as doubts."""
