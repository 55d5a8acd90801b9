"""Small scenes of our own making, and tests of the demo: the logs and roads of `fixtures/scenes`.

A scene (`scene.Scene`) is a road (`road.Road`) and actors (`actors.Actor`), said in a few words. It becomes OpenDRIVE text
(`opendrive`) and ASAM OSI ground truth in MCAP (`osi_log`). `scenes` has all of them; `fixtures/scenes/make.py` writes them.
"""
