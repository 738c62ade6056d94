"""The one exception of the package."""


class PlanError(ValueError):
    """The arguments describe no plan: the message is one line that names the value and the remedy."""
