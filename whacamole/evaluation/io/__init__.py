"""Reading predictions: this project's npz files and the outputs of other methods."""
