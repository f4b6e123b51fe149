# %% [markdown]
# # From measured data to a controller
#
# A small elevator whose compensation sheave runs out of true. We do not know that yet. We have a model, three measured
# trips, and the question why they differ; then we want the car to stop with less swing.
#
# Run it cell by cell in an editor that knows `# %%`, or as a whole in an empty folder: `python tutorial.py`. All files are
# written to that folder. It takes about a minute.

# %%
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd


def comprope(line: str) -> str:
    """Run the command `comprope`, as typed in a terminal, and show what it prints."""
    done = subprocess.run([sys.executable, "-m", "comprope_system.cli", *line.split()], capture_output=True, text=True, check=False)
    sys.stdout.write(f"$ comprope {line}\n{done.stdout}{done.stderr}\n")
    assert done.returncode == 0, done.stderr
    return done.stdout


# %% [markdown]
# ## 1. The model
#
# A model file in TOML: everything in SI units, forces and masses for one rope. The mesh is coarse, to be quick.

# %%
Path("lift.toml").write_text("""\
[shaft]
height = 12.0               # m, travel
pit = 1.2                   # m, sheave axle below the rope's end at the bottom landing

[rope]
mass_per_length = 1.2       # kg/m
diameter = 0.018            # m
axial_stiffness = 8.0e6     # N
bending_stiffness = 8.0     # N m2
axial_damping = 2.0e3       # N s
bending_damping = 0.1       # N m2 s
element_length = 0.12       # m

[sheave]                    # the share of one rope
mass = 25.0                 # kg
radius = 0.4                # m
inertia = 2.0               # kg m2

[contact]
stiffness = 1.2e7           # N/m2
damping = 8.0e3             # N s/m2
friction_coefficient = 0.3
slip_velocity = 0.02        # m/s

[solver]
step = 0.008                # s

[[sensors]]
name = "cw_low"
side = "counterweight"
height = 1.0                # m above the bottom landing

[[sensors]]
name = "car_low"
side = "car"
height = 0.5
""")
Path("drive.toml").write_text("[profile]\nspeed = 1.5\nacceleration = 0.8\njerk = 1.0\n")
comprope("simulate lift.toml --drive drive.toml --from 1 --to 7 --direct --plot model.png")

# %% [markdown]
# ## 2. The measurements
#
# You would have CSV files from your elevator: time, the car's height, and what lasers and encoders saw. Here they come from
# the model itself with something in it that the model file does not know, a bending stiffness that is 5 % off, and noise.

# %%
HIDDEN = (
    "--set effects.sheave_eccentricity.eccentricity=0.002 --set effects.sheave_eccentricity.phase=0.7 "
    "--set rope.bending_stiffness=8.4"
)
NOISE = {"car_position": 5e-4, "cw_low": 3e-4, "car_low": 3e-4, "sheave_displacement": 5e-5}  # m
random = np.random.default_rng(1)
for file, trip in (("up.csv", "--from 1 --to 7"), ("down.csv", "--from 8 --to 3"), ("short.csv", "--from 3 --to 7")):
    comprope(f"simulate lift.toml --drive drive.toml {trip} --time 9 --step 0.02 --direct {HIDDEN} --out {file}")
    seen = pd.read_csv(file)[["time", *NOISE]]
    for column, deviation in NOISE.items():
        seen[column] += deviation * random.standard_normal(len(seen))
    seen.to_csv(file, index=False, float_format="%.6f")

# %% [markdown]
# A campaign describes them: which model, what each column is, how noisy it is, and what each run is for. A run with the
# role "validate" is never fitted: it shows whether what was found also holds elsewhere.

# %%
Path("campaign.toml").write_text("""\
name = "small lift"
model = "lift.toml"

[[channels]]
column = "cw_low"
quantity = "lateral_displacement"
sensor = "cw_low"
unit = "m"
reference = "rest"          # less its mean before the trip
noise = 3e-4

[[channels]]
column = "car_low"
quantity = "lateral_displacement"
sensor = "car_low"
unit = "m"
reference = "rest"
noise = 3e-4

[[channels]]
column = "sheave_displacement"
quantity = "sheave_displacement"
unit = "m"
reference = "rest"
noise = 5e-5

[[runs]]
file = "up.csv"
role = "fit"

[[runs]]
file = "down.csv"
role = "fit"

[[runs]]
file = "short.csv"
role = "validate"
""")

# %% [markdown]
# ## 3. How far is the model off?
#
# The model is driven as the car was, and set against every channel. Errors are shares of what a channel varies; "left /
# noise" or χ² per sample says how much more than noise is left: 1 is as good as it gets.

# %%
comprope("compare . --json compare.json --report compare.html")
before = json.loads(Path("compare.json").read_text())["nrmse"]
assert before > 0.3  # more than noise

# %% [markdown]
# ## 4. What is missing?
#
# Each known effect is tried; the plant's own parameters are refitted, so that a stiffness that is 5 % off is not taken for a
# missing effect.

# %%
comprope("diagnose . --json diagnosis.json --report diagnosis.html")
found = json.loads(Path("diagnosis.json").read_text())
assert found["verdict"] == "sheave_eccentricity"

# %% [markdown]
# The sheave runs out of true. The page `diagnosis.html` shows why this and not another, what else would look the same in
# these data, and which effects they could not show at all. It also tells that some more than noise is left: here what
# the car's noisy position does not show of its motion.
#
# ## 5. Add it
#
# The effect is fitted on the runs for fitting and written into a new model file. What counts is the error on the run that
# was held out.

# %%
comprope("add . sheave_eccentricity --out better.toml --json added.json")
added = json.loads(Path("added.json").read_text())
values = added["parameters"]
sys.stdout.write(f"{json.dumps(values, indent=1)}\n")

# %% [markdown]
# Two millimetres, as was hidden. `comprope journey .` does both steps again and again until nothing is missing.
#
# Watch the trip with it: `better.html` plays it in any browser, with the lateral motion magnified.

# %%
comprope("simulate better.toml --drive drive.toml --from 1 --to 7 --report better.html --out better.csv")

# %% [markdown]
# ## 6. A controller
#
# A trip that suits the rope leaves less swing. First the swing of the present one, after the car has stopped. A coarse mesh
# rings on the sheave by itself, by a millimetre here; so from now on elements are 5 cm.

# %%
FINE = "--set rope.element_length=0.05 --set solver.step=0.004"


def swing_after(drive: str) -> float:
    """Half the span of what the lower car sensor sees [mm] in the last 7 s, when the car stands."""
    comprope(f"simulate better.toml {FINE} --drive {drive} --from 1 --to 7 --direct --out trip.csv")
    table = pd.read_csv("trip.csv")
    return 0.5e3 * float(np.ptp(table["car_low"][table["time"] > table["time"].iloc[-1] - 7.0]))


plain = swing_after("drive.toml")

# %% [markdown]
# The natural periods with the car where it stops, and of these the slowest on the car's side:

# %%
comprope(f"modes lift.toml {FINE} --car 7 --count 4 --json modes.json")
modes = json.loads(Path("modes.json").read_text())["modes"]
period = max(mode["period"] for mode in modes if mode["place"] == "car")

# %% [markdown]
# A shaper of two impulses (ZV) makes the trip from two halves that are half a period apart, so that their swings cancel. It costs
# half a period of time.

# %%
shaper = f"[shaper]\nimpulses = 2\nperiod_landing = {period:.4f}\nperiod_middle = {period:.4f}\n"
Path("shaped.toml").write_text(Path("drive.toml").read_text() + shaper)
shaped = swing_after("shaped.toml")
sys.stdout.write(f"swing after the trip: {plain:.2f} mm; shaped for {period:.3f} s: {shaped:.2f} mm\n")
assert shaped < 0.6 * plain

# %% [markdown]
# `comprope tune` does this by search, among several kinds of trips, shapers and servo gains, for all trips that you name. It finds
# candidates on a small model of the rope's swing and judges the best on the full model and as FMUs; a minute or
# more for each trip:
#
# ```sh
# comprope tune building200 --trip 0:22 --out tuned
# comprope simulate building200 --to 22 --drive tuned/controller.drive.toml --report tuned.html
# ```
#
# See [tuning.md](tuning.md).
