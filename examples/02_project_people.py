"""From world to pixels and back, and that the labels agree with each other.

Run it: `python examples/02_project_people.py DATASET`
"""

import sys

import numpy as np

import whacamole

data = whacamole.open(sys.argv[1] if len(sys.argv) > 1 else "dataset")
sequence = data[0]
camera, people = sequence.camera, sequence.people

# World to camera to pixels, all people and frames at once.
T_camera_world = camera["T_camera_world"]
joints = np.einsum("tij,ptkj->ptki", T_camera_world[:, :3, :3], people["joints_world"])
joints += T_camera_world[:, None, :3, 3]
homogeneous = np.einsum("tij,ptkj->ptki", camera["K"], joints)
pixels = homogeneous[..., :2] / homogeneous[..., 2:]
in_front = joints[..., 2] > 0
error = np.abs(pixels - people["joints_image"])[in_front].max()
print(f"{sequence.id}: {in_front.sum()} joints projected, at most {error:.1e} px from their labels")
assert error < 0.05

# The pelvis stands at its rest position plus the translation, in either frame.
j0 = people["joints_world"][:, :, 0] - people["transl_world"]
again = people["joints_camera"][:, :, 0] - people["transl_camera"]
assert np.allclose(j0, again, atol=1e-4)
print(f"rest pelvis of person 1: {j0[0, 0].round(4)} m")

# Back: the pixel under a seen joint, by its depth, lies within a limb's thickness of the joint.
p, t, j = (int(index[0]) for index in np.nonzero(people["joint_visibility"] == 2))
column, row = people["joints_image"][p, t, j].astype(int)
ray = np.linalg.solve(camera["K"][t], [column + 0.5, row + 0.5, 1.0])
surface = ray * sequence.depth(t)[row, column]
gap = np.linalg.norm(surface - people["joints_camera"][p, t, j])
print(f"the surface before joint {people['joint_names'][j]} is {100 * gap:.1f} cm from it")
assert gap < 0.4
