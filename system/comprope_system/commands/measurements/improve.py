"""`comprope improve`: add what is missing until nothing is."""

import comprope_system

from .._parameters import CAMPAIGN, EXECUTOR, JOBS, ModelFiles
from .._terminal import progress_display


def improve(campaign: CAMPAIGN, files: ModelFiles, jobs: JOBS = None, executor: EXECUTOR = None) -> None:
    """Diagnose and add until nothing is missing or no known effect helps, then remove effects that are not needed.

    Stepwise selection and backward elimination. Reports the share of each effect in the reduction of the error.
    """
    files.require()
    with progress_display() as progress:
        result = comprope_system.improve(campaign, executor=executor, jobs=jobs, progress=progress)
    files.finish(result)
