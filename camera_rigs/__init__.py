"""Where the camera is: film-crew camera moves around people, in NumPy and SciPy alone."""
