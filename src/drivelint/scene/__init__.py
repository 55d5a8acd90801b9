"""Scenes as data: a road, who drives on it and how, and the verdicts that a careful examiner gives, as YAML.

For authors of rules: `drivelint docs scenes`. A scene becomes a map and a log, and is judged as any log is.
"""
