"""The raster engine: the same jobs and the same labels by OpenGL, where Blender cannot run or speed is all.

Needs pyrender for a context without a display, by EGL or OSMesa. Labels are drawn into float buffers, one
sample at the pixel centre, from the very triangles of the job; the picture has direct light, one shadow and
no more.
"""
