"""`comprope improve`: add what is missing until nothing is."""

import comprope_system

from .._parameters import CAMPAIGN, EXECUTOR, FMU, JOBS, JSON, NEW_MODEL, REPORT, ROPE_FMU
from .._terminal import OutputFile, finish, progress_display, require_files


def improve(
    campaign: CAMPAIGN,
    out: NEW_MODEL = None,
    json: JSON = None,
    report: REPORT = None,
    fmu: FMU = None,
    jobs: JOBS = None,
    executor: EXECUTOR = None,
) -> None:
    """Diagnose and add until nothing is missing or no known effect helps, then remove effects that are not needed.

    Stepwise selection and backward elimination. Reports the share of each effect in the reduction of the error.
    """
    require_files(OutputFile(json), OutputFile(out), OutputFile(report, "page"), OutputFile(fmu and fmu / ROPE_FMU))
    with progress_display() as progress:
        result = comprope_system.improve(campaign, executor=executor, jobs=jobs, progress=progress)
    finish(result, (out, result.save_model), (json, result.save_json), (report, result.save_html), (fmu, result.save_fmus))
