"""Scenes in YAML, for authors of rules: a road, the actors on it and their motion, and the expected verdicts.

`drivelint docs scenes` explains them. A scene is converted to a map and a log, and judged like any log.
"""
