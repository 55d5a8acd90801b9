"""Small scenes of our own making: the paper's overtakes for `drivelint demo`; tests have many more.

A scene (`scene.Scene`) is a road (`road.Road`) and actors (`actors.Actor`), said in a few words. It becomes OpenDRIVE text
(`opendrive`) and ASAM OSI ground truth in MCAP (`osi_log`).
"""
