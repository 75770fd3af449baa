"""The paper's Fig. 6: thrust and torque of every unit under yaw commands at constant total thrust.

python yaw_sweep.py AIRFRAME.toml THRUST_N OUT.csv    # and OUT.png where matplotlib is installed
"""

import csv
import sys

import coaxial_mixer
import numpy as np

airframe, thrust_n, out = sys.argv[1], float(sys.argv[2]), sys.argv[3]
mixers = {"coaxial": coaxial_mixer.compile(airframe), "conventional": coaxial_mixer.conventional(airframe)}

# The range of yaw is what the coaxial mixer gives of more than any vehicle has.
least, largest = mixers["coaxial"].mix([[0, 0, -100, thrust_n], [0, 0, 100, thrust_n]]).achieved[:, 2]
yaw_nm = np.linspace(least, largest, 25)
wrenches = np.array([[0, 0, yaw, thrust_n] for yaw in yaw_nm])
efforts = {name: mixer.efforts(mixer.mix(wrenches).throttles) for name, mixer in mixers.items()}

with open(out, "w", newline="") as file:
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(["mixer", "unit", "yaw_asked_nm", "thrust_n", "torque_nm"])
    for name, of_units in efforts.items():
        for unit, points in enumerate(of_units.transpose(1, 0, 2)):
            rows.writerows([name, unit, yaw, *point] for yaw, point in zip(yaw_nm, points))

try:
    from matplotlib import pyplot
except ImportError:
    sys.exit()
for of_units, colour in zip(efforts.values(), ["C0", "C1"]):
    pyplot.plot(of_units[..., 1], of_units[..., 0], ".-", color=colour)
pyplot.title("coaxial mixer (blue), conventional mixer (orange)")
pyplot.xlabel("torque of a unit (N m)")
pyplot.ylabel("thrust of a unit (N)")
pyplot.savefig(out.replace(".csv", ".png"))
