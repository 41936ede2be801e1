"""Start states, the physics step and the loop."""
