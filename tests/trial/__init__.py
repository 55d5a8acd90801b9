"""A blind trial: findings on real perception logs, drawn by lot, as pictures that an examiner judges without the code."""
