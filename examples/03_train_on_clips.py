"""Clips in a PyTorch DataLoader: `Clips` has a length and items, and that is all it needs.

Run it: `python examples/03_train_on_clips.py DATASET`

Needs torch, which the labels do not: `pip install "whacamole[train]"`.
"""

import sys

import torch
from torch.utils.data import DataLoader

import whacamole
from whacamole.dataset.clips import Clips

data = whacamole.open(sys.argv[1] if len(sys.argv) > 1 else "dataset")
length = min(16, *(len(sequence) for sequence in data))

# Two people at most, so that clips of one person and of two can be stacked; the rest is padding.
clips = Clips(data, length, passes=("rgb",), max_people=2)
loader = DataLoader(clips, batch_size=2, shuffle=True, generator=torch.Generator().manual_seed(0))

for number, batch in enumerate(loader):
    images = batch["rgb"].permute(0, 1, 4, 2, 3).float() / 255.0  # (B, L, 3, H, W)
    there = batch["valid"]  # (B, P, L): not padding, and in view
    pelvis = batch["transl_world"][there]
    print(f"batch {number}: images {tuple(images.shape)}, {int(there.sum())} instances, {batch['sequence']}")
    assert torch.isfinite(pelvis).all()
    if number == 1:
        break
