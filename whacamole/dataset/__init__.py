"""A dataset on disk: who owns which path, how files are written, how it is read (docs/format.md)."""

from whacamole.dataset.index import checksums_of, read_json, read_summary, write_index, write_summary
from whacamole.dataset.layout import FORMAT_VERSION, DatasetLayout, SequenceLayout
from whacamole.dataset.reader import Dataset, Sequence, open_dataset
from whacamole.dataset.splits import side_of

__all__ = [
    "FORMAT_VERSION",
    "Dataset",
    "DatasetLayout",
    "Sequence",
    "SequenceLayout",
    "checksums_of",
    "open_dataset",
    "read_json",
    "read_summary",
    "side_of",
    "write_index",
    "write_summary",
]
