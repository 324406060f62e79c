"""The flow map of one scene: how it is filled and how it is read."""
