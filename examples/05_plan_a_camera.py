"""The camera planner alone: people in, a camera path out. NumPy and SciPy, no files, no bodies, no Blender.

Run it: `python examples/05_plan_a_camera.py`
"""

import numpy as np

from camera_rigs import Lens, Obstacle, SubjectTrack, World, direct

# Somebody walks three metres along x in four seconds, past a column.
frames, fps = 120, 30.0
pelvis = np.zeros((1, frames, 3))
pelvis[0, :, 0] = np.linspace(-1.5, 1.5, frames)
pelvis[0, :, 2] = 0.95
neck = pelvis + np.array([0.0, 0.0, 0.55])
facing = np.tile([1.0, 0.0, 0.0], (1, frames, 1))
half = np.array([0.3, 0.3, 0.0])
subject = SubjectTrack.from_people(
    pelvis, neck, facing, pelvis * [1, 1, 0] - half, pelvis * [1, 1, 0] + half + [0, 0, 1.75], fps
)
world = World(obstacles=(Obstacle((0.0, 2.5, 1.5), (0.4, 0.4, 3.0), name="column"),))
lens = Lens.from_millimetres(35.0, 640, 360)

for seed in range(3):
    plan = direct(subject, lens, world, "auto", np.random.default_rng(seed))
    kinds = ", ".join(shot.kind for shot in plan.shots)
    travelled = np.linalg.norm(np.diff(plan.path.location, axis=0), axis=1).sum()
    print(f"seed {seed}: {kinds}; the camera travels {travelled:.2f} m, {len(plan.findings)} rules broken")

pixels, depth = plan.path.project(pelvis[0][:, None])
print(
    f"the pelvis stays {depth.min():.1f} to {depth.max():.1f} m away, first at x = {pixels[0, 0, 0]:.0f} px"
)
