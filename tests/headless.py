"""MuJoCo without OpenGL, before any test imports it: it would not be imported where
`MUJOCO_GL` names one that does not work.
"""

from rotctl.engine import mujoco_without_opengl

mujoco_without_opengl()
