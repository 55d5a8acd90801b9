"""Audits of generated fleets: the same tables however they were judged and interrupted."""
