"""Finds how sure findings are: windows of their drives are copied with assumed errors of a recording, and judged."""
