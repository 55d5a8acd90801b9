"""Scenes as data: a road, the actors on it and their motion, and the verdicts of a careful examiner, as YAML.

For authors of rules: `drivelint docs scenes`. A scene becomes a map and a log, and is judged as any log is.
"""
