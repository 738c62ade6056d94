"""The shots: one planner a file."""
