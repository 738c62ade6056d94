"""Another format, another split.

Run it: `python examples/04_export_and_split.py DATASET`

On the command line: `whacamole export DATASET --to coco --out FOLDER`, `whacamole split DATASET --by stage`.
"""

import json
import sys
import tempfile
from collections import Counter
from pathlib import Path

import whacamole
from whacamole.dataset.splitting import SplitRule, assign, links_of
from whacamole.export import export_dataset

data = whacamole.open(sys.argv[1] if len(sys.argv) > 1 else "dataset")

with tempfile.TemporaryDirectory() as folder:
    result = export_dataset(data, "coco", Path(folder) / "coco", every=2)
    content = json.loads((result.folder / result.files[0]).read_text())
    print(f"COCO: {len(content['images'])} images, {len(content['annotations'])} annotations")

    result = export_dataset(data, "tum", Path(folder) / "tum")
    first = (result.folder / result.files[0]).read_text().splitlines()[0]
    print(f"TUM: {len(result.files)} files, {result.files[0]} begins with {first}")

# What another rule would do, without writing it; `split_dataset` writes it.
for by in ("motion", "person", "stage"):
    rule = SplitRule(by, test_fraction=0.5, seed=1)
    side = assign({sequence.id: links_of(sequence, by) for sequence in data}, rule)
    print(f"by {by}: {dict(Counter(side.values()))}")
