"""The search for poses and gains over many seeded starts.

A space (`space`) says what may vary and how it is scored (`objective`); a generation of
candidates (`sampler`) is tried on training starts (`attempt`) by the engines of
`rotctl.sweep`, and remembered (`history`); the winner becomes a config choice (`result`).
"""
