"""rotctl: physics-based rotational character control.

References used in docstrings:

- [Brown2013] D. F. Brown, A. Macchietto, K. Yin, V. Zordan, "Control of Rotational
  Dynamics for Ground Behaviors", Symposium on Computer Animation, 2013.
- [AlBorno2014] M. Al Borno, E. Fiume, A. Hertzmann, M. de Lasa, "Feedback Control for
  Rotational Movements in Feature Space", Eurographics, 2014.
- [Tan2011] J. Tan, C. K. Liu, G. Turk, "Stable Proportional-Derivative Controllers",
  IEEE Computer Graphics and Applications 31(4), 2011.
"""

__version__ = "0.1.0"
