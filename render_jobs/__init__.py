"""A job in, pixels out: the only package that knows Blender and pyrender."""
