# %% [markdown]
# # From measured data to a controller
#
# A small elevator whose compensation sheave is eccentric, which is unknown at first. Given are a model and three measured
# trips. The aim is to identify why they differ, and then to reduce the residual vibration of the rope after a trip.
#
# Run the file cell by cell in an editor that supports `# %%`, or as a whole in an empty folder: `python tutorial.py`. All
# files are written to that folder. It takes about a minute.

# %%
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd


def comprope(line: str) -> str:
    """Run the command `comprope` as in a terminal, and print its output."""
    done = subprocess.run([sys.executable, "-m", "comprope_system.cli", *line.split()], capture_output=True, text=True, check=False)
    sys.stdout.write(f"$ comprope {line}\n{done.stdout}{done.stderr}\n")
    assert done.returncode == 0, done.stderr
    return done.stdout


# %% [markdown]
# ## 1. The model
#
# A model file in TOML: all values in SI units, forces and masses for one rope. The mesh is coarse, to save time.

# %%
Path("elevator.toml").write_text("""\
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
comprope("simulate elevator.toml --drive drive.toml --from 1 --to 7 --direct --plot model.png")

# %% [markdown]
# ## 2. The measurements
#
# In practice these are CSV files with time, car position, and the signals of lasers and encoders. Here they are simulated with
# an effect that is not in the model file, a bending stiffness that differs by 5 %, and noise.

# %%
HIDDEN = (
    "--set effects.sheave_eccentricity.eccentricity=0.002 --set effects.sheave_eccentricity.phase=0.7 "
    "--set rope.bending_stiffness=8.4"
)
NOISE = {"car_position": 5e-4, "cw_low": 3e-4, "car_low": 3e-4, "sheave_displacement": 5e-5}  # m
random = np.random.default_rng(1)
for file, trip in (("up.csv", "--from 1 --to 7"), ("down.csv", "--from 8 --to 3"), ("short.csv", "--from 3 --to 7")):
    comprope(f"simulate elevator.toml --drive drive.toml {trip} --time 9 --step 0.02 --direct {HIDDEN} --out {file}")
    seen = pd.read_csv(file)[["time", *NOISE]]
    for column, deviation in NOISE.items():
        seen[column] += deviation * random.standard_normal(len(seen))
    seen.to_csv(file, index=False, float_format="%.6f")

# %% [markdown]
# A campaign file describes them: the model, the quantity and the noise of each column, and the role of each run. A run with
# the role "validate" is never used for fitting: it shows whether the result generalises.

# %%
Path("campaign.toml").write_text("""\
name = "small elevator"
model = "elevator.toml"

[[channels]]
column = "cw_low"
quantity = "lateral_displacement"
sensor = "cw_low"
unit = "m"
reference = "rest"          # subtract the mean before the trip
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
# ## 3. The error of the model
#
# The model is simulated with the measured car position and compared with every channel. The NRMSE is the RMS error divided by
# the standard deviation of the channel; the reduced chi-square is the mean square of the residual divided by the variance of the
# noise, and close to 1 if noise explains the residual.

# %%
comprope("compare . --json compare.json --report compare.html")
before = json.loads(Path("compare.json").read_text())["nrmse"]
assert before > 0.3  # much more than noise

# %% [markdown]
# ## 4. What is missing?
#
# Each known effect is fitted together with the plant parameters, so that a stiffness error of 5 % is not mistaken for a
# missing effect.

# %%
comprope("diagnose . --json diagnosis.json --report diagnosis.html")
found = json.loads(Path("diagnosis.json").read_text())
assert found["verdict"] == "sheave_eccentricity"

# %% [markdown]
# The sheave is eccentric. The report `diagnosis.html` compares this hypothesis with all others, lists effects that cannot be
# distinguished in these runs, and gives detection limits. It also shows that the residual is slightly larger than noise: here
# because the car's motion is known from a noisy position signal only.
#
# ## 5. Add the effect
#
# The effect is fitted on the fit runs and written into a new model file. The relevant error is that of the validation run.

# %%
comprope("add . sheave_eccentricity --out better.toml --json added.json")
added = json.loads(Path("added.json").read_text())
values = added["parameters"]
sys.stdout.write(f"{json.dumps(values, indent=1)}\n")

# %% [markdown]
# The eccentricity is 2 mm, as in the simulated measurements. `comprope improve .` repeats both steps until nothing is missing.
#
# `better.html` shows an animation of the trip in any browser, with the lateral motion magnified.

# %%
comprope("simulate better.toml --drive drive.toml --from 1 --to 7 --report better.html --out better.csv")

# %% [markdown]
# ## 6. A controller
#
# A trip profile matched to the natural period of the rope reduces the residual vibration. First that of the present profile.
# On a coarse mesh the contact with the sheave excites numerical oscillations of about 1 mm; from here on elements are 5 cm.

# %%
FINE = "--set rope.element_length=0.05 --set solver.step=0.004"


def swing_after(drive: str) -> float:
    """Half the peak-to-peak displacement [mm] at the lower car sensor in the last 7 s, after the car has stopped."""
    comprope(f"simulate better.toml {FINE} --drive {drive} --from 1 --to 7 --direct --out trip.csv")
    table = pd.read_csv("trip.csv")
    return 0.5e3 * float(np.ptp(table["car_low"][table["time"] > table["time"].iloc[-1] - 7.0]))


plain = swing_after("drive.toml")

# %% [markdown]
# The natural periods with the car at its destination, and of these the longest on the car side:

# %%
comprope(f"modes elevator.toml {FINE} --car 7 --count 4 --json modes.json")
modes = json.loads(Path("modes.json").read_text())["modes"]
period = max(mode["period"] for mode in modes if mode["place"] == "car")

# %% [markdown]
# An input shaper of two impulses (ZV) superposes two trips of half amplitude, half a period apart, so that their residual
# vibrations cancel. The trip takes half a period longer.

# %%
shaper = f"[shaper]\nimpulses = 2\nperiod_landing = {period:.4f}\nperiod_middle = {period:.4f}\n"
Path("shaped.toml").write_text(Path("drive.toml").read_text() + shaper)
shaped = swing_after("shaped.toml")
sys.stdout.write(f"swing after the trip: {plain:.2f} mm; shaped for {period:.3f} s: {shaped:.2f} mm\n")
assert shaped < 0.6 * plain

# %% [markdown]
# `comprope tune` optimises trip profile, input shaper and servo gains for any number of trips. It searches with a reduced model
# of the rope and evaluates the best candidates with the full model and as FMUs; this takes a minute or more for each trip:
#
# ```sh
# comprope tune building200 --trip 0:22 --out tuned
# comprope simulate building200 --to 22 --drive tuned/controller.drive.toml --report tuned.html
# ```
#
# See [tuning.md](tuning.md).
