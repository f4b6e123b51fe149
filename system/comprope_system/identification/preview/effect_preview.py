"""Preview of an effect: predictions and errors of all runs at any value of its parameters, between replays at nodes."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError

from ..comparison.nrmse import moves, overall, trusted
from ..data.campaign import Campaign
from ..data.runs import Channel, Run
from ..estimation.linearisation import instrument_slope, run_tangents
from ..prediction.parameter_point import ParameterPoint, Predictions
from ..prediction.replay import relative_to_rest
from .interpolation import NodeLines
from .sliders import Slider, moved, node_lines

Floats = NDArray[np.float64]
Place = tuple[str, str]


@dataclass(frozen=True)
class EffectPreview:
    """Data of an effect at the nodes of its sliders: `data[file, column]` (nodes * (1 + sliders), n) [SI], see `NodeLines`.

    `point` has the sliders at their present values; derivatives are by the SI values of the sliders' parameters.
    """

    name: str
    campaign: Campaign
    point: ParameterPoint
    sliders: tuple[Slider, ...]
    data: dict[Place, Floats]

    @cached_property
    def lines(self) -> NodeLines:
        """The nodes of the sliders."""
        return node_lines(self.sliders)

    @cached_property
    def forms(self) -> dict[Place, Floats]:
        """For each run and channel the matrix (data, data) whose quadratic form with the weights is the squared NRMSE.

        The weights of all values sum to one, so that the residual is the same combination of the residuals at the nodes. Channels
        that never move, or hold too little, are left out.
        """
        found = {}
        for run in self.campaign.runs:
            measured = relative_to_rest(run.values, run, self.campaign.channels)
            for column in self.campaign.channels:
                form = self._form(self.data[run.file, column], measured[column], self.campaign.noise[column].deviation)
                if form is not None:
                    found[run.file, column] = form
        return found

    def _form(self, data: Floats, measured: Floats, noise: float) -> Floats | None:
        both = trusted(measured, np.asarray(data.sum(0)), noise)  # a sum is finite where all are
        if both.sum() < 2 or not moves(measured[both]):
            return None
        residuals = -data[:, both]
        residuals[:: 1 + len(self.sliders)] += measured[both]
        return np.asarray(residuals @ residuals.T / (both.sum() * np.var(measured[both])))

    def predictions(self, values: Sequence[float]) -> Predictions:
        """Interpolated channels (n,) [SI] of every run with the sliders at these values [SI]."""
        weights = self.lines.weights(values)
        return {place: weights @ data for place, data in self.data.items()}

    def nrmse(self, values: Sequence[float], role: str) -> float:
        """The NRMSE of the interpolated channels of the runs of a role."""
        weights, files = self.lines.weights(values), {run.file for run in self.campaign.of_role(role)}
        squares = [float(weights @ form @ weights) for (file, _), form in self.forms.items() if file in files]
        return overall(float(np.sqrt(max(one, 0.0))) for one in squares)


def preview_effect(
    name: str, campaign: Campaign, point: ParameterPoint, sliders: Sequence[Slider], executor: Executor
) -> EffectPreview:
    """Replay every run at the nodes of the sliders, with derivatives; raises `SimulationError` where one fails."""
    nodes = [moved(point, sliders, values) for values in node_lines(sliders).points()]
    jobs = {
        (run.file, k): executor.submit(_node_data, campaign, run, node, sliders)
        for run in campaign.runs
        for k, node in enumerate(nodes)
    }
    rows = {place: job.result() for place, job in jobs.items()}
    data = {
        (run.file, column): np.vstack([rows[run.file, k][column] for k in range(len(nodes))])
        for run in campaign.runs
        for column in campaign.channels
    }
    return EffectPreview(name, campaign, point, tuple(sliders), data)


def _node_data(campaign: Campaign, run: Run, node: ParameterPoint, sliders: Sequence[Slider]) -> dict[str, Floats]:
    """Value of each channel of a run at a node and its derivatives by the sliders: (1 + sliders, n)."""
    steps = [0.1 * (one.nodes[-1] - one.nodes[0]) for one in sliders]
    near = [(_stepped(node, one, step), step) for one, step in zip(sliders, steps, strict=True)]
    values, derivatives = run_tangents(campaign.model, run, campaign.channels, node, near)
    found = {}
    for column, value in values.items():
        of_rope = {k: by[column] for k, by in derivatives.items()}
        rows = [
            of_rope[k] if k in of_rope else _instrument_derivative(one, node, run, column, value, campaign.channels)
            for k, one in enumerate(sliders)
        ]
        found[column] = np.vstack([value, *rows])
    return found


def _stepped(node: ParameterPoint, one: Slider, step: float) -> ParameterPoint:
    """The node with one slider moved by a step."""
    amounts = {one.key: 1.0} | dict(one.others)
    effects = dict(node.effects) | {key: node.effects[key] + amount * step for key, amount in amounts.items()}
    return ParameterPoint(node.plant, effects, node.shifts)


def _instrument_derivative(
    one: Slider, node: ParameterPoint, run: Run, column: str, value: Floats, channels: Mapping[str, Channel]
) -> Floats:
    """Derivative (n,) of a channel by a fault of an instrument, which is zero for all other channels."""
    total = np.zeros(len(value))
    for key, amount in ({one.key: 1.0} | dict(one.others)).items():
        if "sensor_gain" in key and node.effects[key] == 0.0:
            raise SimulationError(f"{key} = 0: a channel of gain zero has no derivative by its gain")
        if key.split(".", 2)[2] == column:
            total = total + amount * instrument_slope(key, node, run, value, channels)
    return np.where(np.isfinite(value), total, np.nan)
