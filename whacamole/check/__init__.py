"""An audit of finished datasets: labels against labels, against pixels and against what was written."""

from whacamole.check.audit import check_dataset
from whacamole.check.findings import Finding, Findings
from whacamole.check.limits import Limits

__all__ = ["Finding", "Findings", "Limits", "check_dataset"]
