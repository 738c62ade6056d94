"""WHAC, the baseline: camera-frame people + scale-free visual odometry + a velocimeter → one metric world.

The method (Yin et al., ECCV 2024, section 3) as small functions in :mod:`~whacamole.baseline.method`; the
network in :mod:`~whacamole.baseline.velocimeter` (NumPy) and :mod:`~whacamole.baseline.network` (PyTorch, for
training); sources of camera-frame people in :mod:`~whacamole.baseline.estimators`, of camera motion in
:mod:`~whacamole.baseline.odometry`. docs/baseline.md tells how well it does.
"""
