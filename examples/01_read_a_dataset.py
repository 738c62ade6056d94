"""What is in a dataset: sequences, frames, masks, labels, splits.

Run it: `python examples/01_read_a_dataset.py DATASET`
"""

import sys

import numpy as np

import whacamole

data = whacamole.open(sys.argv[1] if len(sys.argv) > 1 else "dataset")
print(f"{len(data)} sequences; {len(data.split('train'))} to train on, {len(data.split('test'))} to test on")

for sequence in data:
    camera, people = sequence.camera, sequence.people
    width, height = sequence.size
    print(f"\n{sequence.id}: {len(sequence)} frames of {width}x{height}, {len(people['track_id'])} people")
    travelled = np.linalg.norm(np.diff(camera["T_world_camera"][:, :3, 3], axis=0), axis=1).sum()
    print(f"  the camera travels {travelled:.2f} m")

    image, mask = sequence.rgb(0), sequence.mask(0)  # (H, W, 3) and (H, W), read when asked for
    for person, track_id in enumerate(people["track_id"]):
        mine = mask == track_id
        colour = image[mine].mean(axis=0).round() if mine.any() else None
        depth = float(np.median(sequence.depth(0)[mine])) if mine.any() else float("nan")
        print(f"  person {track_id}: {mine.sum()} pixels in frame 0, {depth:.2f} m away, colour {colour}")
        touching = sequence.contact["ground_contact"][person].any(axis=0)
        names = ", ".join(sequence.contact["part_names"][touching])
        print(f"    touches the ground with: {names or 'nothing'}")
        print(f"    in view in {people['valid'][person].sum()} frames")
