"""Visual odometry: camera motion without a unit. One interface, four sources.

``opencv`` and ``colmap`` look at the pixels, ``files`` reads trajectories that another program made,
``noisy-labels`` takes the true one, spoils it and throws its scale away.
"""

from whacamole.baseline.odometry.trajectory import Odometry, OdometrySource, Scene

__all__ = ["Odometry", "OdometrySource", "Scene"]
