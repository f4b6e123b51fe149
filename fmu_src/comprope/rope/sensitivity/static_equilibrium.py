"""Static equilibrium with changed parameters, for derivatives of the initial state."""

from ..integration.static_equilibrium import rest
from ..mechanics.effect_hooks import all_begin
from ..mechanics.end_conditions import place_ends
from ..mechanics.equations_of_motion import forces
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ELEMENT


@kernel
def hang_again(n, t, p1, smooth1, path1, q, v, a, w, f, touch, hi, hd, power, A, L, B, Z, r):
    """Move q to rest with other parameters and ends than it was at; sets the history hi of a rope at rest there.

    `smooth1` are the parameters p1 without friction and without effects that have a history. Returns the number of
    iterations, or -1 where no shape at rest is found.
    """
    place_ends(n, t, p1, path1, 1.0, 0.0, q, v, a)
    for i in range(2 * (n + 1)):
        v[i] = 0.0
    count = rest(n, smooth1, q, v, w, f, touch, hi, hd, power, A, L, B, Z, r, p1[ELEMENT])
    forces(n, t, smooth1, q, v, w, f, touch, hi, hd, power, Z, 0.0, 0.0, False)
    all_begin(n, p1, w, hi)
    return count
