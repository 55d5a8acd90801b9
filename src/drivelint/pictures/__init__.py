"""Pictures from the cameras in a log: the frames nearest to findings and near misses in time, downscaled, in a table."""

from drivelint.pictures.gather import PictureTaker
from drivelint.pictures.shots import planned_shots, rows_of_planned_shots

__all__ = ["PictureTaker", "planned_shots", "rows_of_planned_shots"]
