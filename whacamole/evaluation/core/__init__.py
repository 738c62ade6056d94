"""The metrics themselves: functions from arrays to arrays, NumPy alone, no files and no body models.

Points are float arrays in metres, a leading axis of F frames, the last axis x, y, z. What a function returns
says its unit. docs/metrics.md gives every formula with its source.
"""
