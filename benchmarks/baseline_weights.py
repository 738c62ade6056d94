"""Make the bundled weights: one set from all embedded motions, three from all but a third of the captures.

    python -m benchmarks.baseline_weights OUT [SET …]

The three are what every published number on embedded motions is made with: each motion is judged by the
weights that never saw its capture (walk, walk_turn and stroll are one capture; so are dance_b and duet, kick,
punch and sparring).
"""

import sys
from pathlib import Path

import numpy as np

from whacamole.baseline.clips import clip_of, performances
from whacamole.baseline.testing import measure
from whacamole.baseline.training import Progress, TrainingData, TrainingRecipe, train
from whacamole.baseline.weights import save_weights
from whacamole.body import NUM_BETAS, BodyModel
from whacamole.motion import embedded_motions

HELD_OUT = {
    "velocimeter": (),
    "velocimeter-a": ("walk", "walk_turn", "stroll", "jump", "roll", "getup_front"),
    "velocimeter-b": ("run", "dance_a", "cartwheel", "kick", "punch", "sparring"),
    "velocimeter-c": ("dance_b", "duet", "crawl", "spin", "spinkick", "getup_back"),
}


def make(name: str, out: Path) -> None:
    """Train one set, or go on with it, and print its errors."""
    body = BodyModel.embedded()
    people = performances(embedded_motions())
    held_out = [p for p in people if p.motion in HELD_OUT[name]]
    trained = [p for p in people if p.motion not in HELD_OUT[name]]
    plain = {
        side: [clip_of(p.params(body, np.zeros(NUM_BETAS)), body, p.motion) for p in group]
        for side, group in (("trained", trained), ("held out", held_out))
    }
    recipe = TrainingRecipe()

    def watch(progress: Progress) -> None:
        if progress.step % 50 == 0:
            print(f"{name}: step {progress.step} of {recipe.steps}, loss {progress.loss:.3f}", flush=True)

    velocimeter = train(
        TrainingData(trained, [], plain["held out"]), recipe, body, out / "training" / name, watch
    )
    save_weights(out / f"{name}.safetensors", velocimeter.weights, velocimeter.about)
    for side, clips in plain.items():
        print(name, side, measure(velocimeter, clips), flush=True)
        for clip in clips:
            print(f"  {clip.motion:12} {measure(velocimeter, [clip])}", flush=True)


if __name__ == "__main__":
    for chosen in sys.argv[2:] or HELD_OUT:
        make(chosen, Path(sys.argv[1]))
