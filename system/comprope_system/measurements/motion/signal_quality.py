"""What is wrong with a position signal: large steps, jumps that no car makes, held values, failures of the sensor."""

import numpy as np

from .signal.position_signal import HARD_STOP, Mask, Signal
from .signal.preparation import COARSEST
from .signal.spikes import TOP_SPEED

LONGEST_HELD = 1.0  # s; values held for longer do not show how the car starts and stops
MOST_LEFT_OUT = 0.01  # share of samples left out as failures of the sensor without a remark


def no_motion(signal: Signal, left_out: Mask) -> str | None:
    """A sentence about a signal of large steps or a jump that no car makes, samples `left_out` aside; None if there is none."""
    if signal.resolution > COARSEST:
        return f"position changes in steps of {signal.resolution:.4g} m: at most {COARSEST:g} m is accepted"
    if signal.held > LONGEST_HELD:
        return f"position holds its values for {signal.held:.3g} s: at most {LONGEST_HELD:g} s is accepted"
    t, x = signal.time[~left_out], signal.position[~left_out]
    steps, times = np.abs(np.diff(x)), np.diff(t)
    excess = steps - TOP_SPEED * times - 10.0 * signal.local_noise[~left_out][1:] - signal.resolution
    worst = int(np.argmax(excess))
    if excess[worst] <= 0.0:
        return None
    speed = steps[worst] / times[worst]
    if np.median(steps / times) > TOP_SPEED:
        usual = f"position changes by {np.median(steps / times):.4g} m/s"
        return f"{usual}: at most {TOP_SPEED:g} m/s is accepted; its unit is probably mm"
    where = f"from {x[worst]:.6g} m to {x[worst + 1]:.6g} m between time = {t[worst]:.6g} s and {t[worst + 1]:.6g} s"
    return f"position jumps {where}: at most {TOP_SPEED:g} m/s is accepted, this is {speed:.4g} m/s; leave such cells empty"


def signal_remarks(signal: Signal, left_out: Mask) -> list[str]:
    """Sentences about the signal itself."""
    found = []
    if signal.held:
        hidden = f"between them a hard stop may move the car by {1e3 * HARD_STOP * signal.held**2 / 8.0:.2g} mm unseen"
        found.append(
            f"the signal holds its values for {signal.held:.3g} s; only the samples at which it changes are used, and {hidden}"
        )
    if (share := float(np.mean(left_out))) > MOST_LEFT_OUT:
        found.append(f"{100.0 * share:.2g} % of the samples continue no motion and are left out")
    return found
