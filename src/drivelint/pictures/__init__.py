"""Pictures from the log's own cameras: the frames nearest to the moments of findings and near misses, downscaled, in a table."""

from drivelint.pictures.gather import Camerawork
from drivelint.pictures.shots import chosen_rows, planned_shots

__all__ = ["Camerawork", "chosen_rows", "planned_shots"]
