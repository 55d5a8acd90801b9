"""Pictures from the cameras of logs."""
