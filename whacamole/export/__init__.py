"""A dataset in the formats that other people's code reads (docs/export.md)."""

from whacamole.export.registry import EXPORTERS, Exporter, ExportResult, export_dataset
from whacamole.export.source import Source

__all__ = ["EXPORTERS", "ExportResult", "Exporter", "Source", "export_dataset"]
