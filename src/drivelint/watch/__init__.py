"""Judges a drive while it is recorded: alarms at once, verdicts at its end.

A source gives frames as they come and keeps a recording of them. The last seconds of it, the window, are written as a small log and
judged by the rules as any log is. What fails in it for the first time is an alarm. When the source has ended, the recording is checked.
"""
