"""Scenarios of MetaDrive's ScenarioNet (pickles): nuScenes, Waymo Open Motion, nuPlan and others, each with its map."""
