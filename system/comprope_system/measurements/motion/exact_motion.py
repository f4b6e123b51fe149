"""A motion taken as it is: the smoothest one within the noise of the signal, whatever moves."""

import numpy as np

from .signal.local_misfit import excess
from .signal.position_signal import Signal
from .smoothing.local_smoothing import smooth_within_noise
from .trip import ENDS_UNDER_WAY, Trip, continued

REST = 0.1  # s at the start or end of a record that count as rest
MARGIN = 1.0  # s before and after a motion is seen beyond the noise, within which it may have begun and ended
FAST = 50.0  # m/s2; beyond a safety gear's deceleration, so that an impact or a failure of the sensor is worth a remark


def rests(signal: Signal, span: tuple[float, float]) -> tuple[bool, bool]:
    """Whether the record begins and ends at rest."""
    return span[0] - float(signal.time[0]) >= REST, float(signal.time[-1]) - span[1] >= REST


def exact_motion(signal: Signal, span: tuple[float, float], remark: str) -> Trip:
    """The smoothest motion within the noise, at rest outside `span` where the record reaches beyond it."""
    first, last = float(signal.time[0]), float(signal.time[-1])
    departs, arrives = rests(signal, span)
    start = max(span[0] - MARGIN, first) if departs else first
    stop = min(span[1] + MARGIN, last) if arrives else last
    piece = smooth_within_noise(signal, start, stop, departs, arrives)
    if not arrives:
        piece = continued(piece)
    residual = signal.position - piece.value(signal.time)
    remarks = [remark] if remark else []
    if (over := excess(signal, piece.value(signal.time))).max() > 1.0:
        worst = int(np.argmax(np.abs(residual) * (over > 1.0)))
        where = f"at time = {signal.time[worst]:.4g} s"
        remarks.append(f"the recovered motion misses the measured position by {1e3 * abs(residual[worst]):.3g} mm {where}")
    fastest = float(np.abs(piece.derivative(signal.time, 2)).max())
    if fastest > FAST:
        unseen = f"samples {1e3 * signal.interval:.3g} ms apart do not show its course"
        remarks.append(
            f"the motion reaches {fastest:.3g} m/s2: an impact, or a failure of the sensor; {unseen}, and `simulate` follows it "
            "with --step 0.001"
        )
    if not departs:
        remarks.append("the record begins under way")
    if not arrives:
        remarks.append(ENDS_UNDER_WAY)
        if signal.held:
            remarks.append(f"its last {signal.held:.2g} s are extrapolated, uncertain by some {1e3 * signal.held**2:.2g} mm")
    return Trip((piece,), float(np.std(residual)), "exact", tuple(remarks))
