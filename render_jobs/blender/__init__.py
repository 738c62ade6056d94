"""The Blender engine. Import it in a process of its own: Blender can abort the interpreter."""
