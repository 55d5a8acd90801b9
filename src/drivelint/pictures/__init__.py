"""Pictures from the cameras in a log: the frames nearest to findings and near misses in time, downscaled, in a table."""

from drivelint.pictures.gather import Camerawork
from drivelint.pictures.shots import chosen_rows, planned_shots

__all__ = ["Camerawork", "chosen_rows", "planned_shots"]
