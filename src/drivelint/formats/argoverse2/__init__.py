"""Argoverse 2 as published: sensor logs, motion forecasting scenarios and their maps."""
