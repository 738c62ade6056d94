"""From a recipe to a finished dataset: what there is to make, making one sequence, making them all."""
