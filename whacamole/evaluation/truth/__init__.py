"""Ground truth: this project's datasets and the standard benchmarks, behind one interface."""
