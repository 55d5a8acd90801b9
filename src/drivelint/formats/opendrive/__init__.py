"""ASAM OpenDRIVE 1.4 to 1.8, read with lxml and evaluated with numpy."""
