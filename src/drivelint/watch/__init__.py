"""Judges a drive while it is recorded: alarms at once, verdicts at the end of the drive.

A source provides frames as they arrive, and keeps a recording. The last seconds of the recording, the window, are written as a small log
and judged like any log. A new failure in the window is an alarm. When the source has ended, the whole recording is checked.
"""
