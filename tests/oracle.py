#!/usr/bin/env python3
"""An independent judge of mixers: the forward physics of an airframe file, in plain Python.

    oracle.py draw AIRFRAME COUNT SEED          setpoints as CSV on stdout
    oracle.py judge AIRFRAME SETPOINTS MIXED [FAILED,..]
                                                judges what a mixer made of them, with the rotors of these channels out;
                                                status 1 and a list if it is wrong
    oracle.py isolated AIRFRAME METHOD SETPOINTS
                                                throttles of isolated rotors as CSV; METHOD is `conventional` or an
                                                airmode, then desaturated after PX4

It shares nothing with the compiler but the file: its own reading of the file, its own effectiveness, pseudo-inverse,
inverse of the pair's map and laws of voltage and density, in double precision, standard library only (Python 3.11 or later).

A single rotor (`rotor = ".."`) is a pair whose lower rotor is always out: its torque is not in proportion to its thrust, which
M+ takes it for, so that its least-norm efforts are those of the wrench from which the difference is taken. The mixer goes from M+ to
the nearest throttles instead, so that on frames with single rotors the wrench is judged, and efforts within 2 % of a unit's largest.

What it asks of every row:
  * throttles within [min, max]; one row per setpoint
  * the achieved wrench is the one that these throttles give, within the file's tolerance of every unit
  * a request whose least-norm efforts are attainable, on the general path with some room, is delivered: every unit's
    thrust and torque within the file's tolerance of them; with a power bias c within that of a point on the way from them to those that the torques
    c f add without changing the wrench, and at its end where every unit could move by that much either way
  * otherwise no axis reverses or overshoots, (roll, pitch) keeps its direction, and airmode "disabled" does not
    raise the thrust above the request unless that is below the floor of the controlled flight
  * with rotors out their throttles are 0, and a unit with one rotor left gives what the file says of that rotor alone,
    else the pair's polynomials with the other throttle at zero; what is delivered is not judged then: some frames cannot
    even be level
  * saturation flags say on which axes and sides the request was missed
"""

import csv
import math
import random
import sys
import tomllib

AXES = ["roll", "pitch", "yaw", "thrust"]
COLUMNS = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"]

TERMS = {
    "biquadratic": [(2, 2), (2, 1), (2, 0), (1, 2), (1, 1), (1, 0), (0, 2), (0, 1)],
    "cubic": [(3, 0), (2, 1), (1, 2), (0, 3), (2, 0), (1, 1), (0, 2), (1, 0), (0, 1)],
    "quartic": [(4, 0), (3, 1), (2, 2), (1, 3), (0, 4), (3, 0), (2, 1), (1, 2), (0, 3), (2, 0), (1, 1), (0, 2), (1, 0), (0, 1)],
}


def regular(layout, bench_spin):
    """The units of the short form: on a circle, upper rotors alternating where their number is even."""
    n, other = layout["units"], {"cw": "ccw", "ccw": "cw"}
    first = layout.get("first_spin", bench_spin)
    units = []
    for k in range(n):
        angle = math.radians(layout["first_angle_deg"] + 360.0 * k / n)
        spin = other[first] if n % 2 == 0 and k % 2 == 1 else first
        units.append({
            "position_m": [layout["arm_m"] * math.cos(angle), layout["arm_m"] * math.sin(angle), 0.0],
            "upper_spin": layout.get("spins", {k: spin for k in range(n)})[k],
            "channels": layout.get("channels", {k: [k, n + k] for k in range(n)})[k],
            "pair": layout.get("pairs", {k: None for k in range(n)})[k],
        })
    return units


def single(rotor):
    """A single rotor as the upper one of a pair whose lower one gives nothing."""
    curves = {"thrust_n": rotor["thrust_n"], "torque_nm": [-c for c in rotor["torque_nm"]]}
    terms = {key: [dict(zip(((1, 0), (2, 0), (3, 0)), c)).get(term, 0.0) for term in TERMS["cubic"]] for key, c in curves.items()}
    return {"basis": "cubic", "upper_spin": "cw"} | terms


class Airframe:
    def __init__(self, path):
        with open(path, "rb") as file:
            spec = tomllib.load(file)
        self.low, self.high = spec["throttle"]["min"], spec["throttle"]["max"]
        pairs = spec["pair"] if isinstance(spec["pair"], list) else [spec["pair"]]
        named = {pair.get("name"): pair for pair in pairs}
        rotors = {rotor["name"]: single(rotor) for rotor in spec.get("rotor", [])}
        # That of each unit, and its coefficients of thrust and of torque, each with its powers of u and l.
        self.pairs, self.maps = [], []
        self.voltage = spec.get("voltage")
        self.air = spec.get("air")
        inverse = spec.get("inverse", {})
        self.tolerance = [inverse.get("thrust_tolerance_n", 0.01), inverse.get("torque_tolerance_nm", 1e-4)]
        allocation = spec.get("allocation", {})
        self.airmode = allocation.get("airmode", "disabled")
        self.power_bias = allocation.get("power_bias_nm_per_n", 0.0)
        self.axes = [axis in allocation.get("axes", AXES) for axis in AXES]
        self.channels, columns_f, columns_q = [], [], []
        for unit in spec.get("unit") or regular(spec["layout"], pairs[0]["upper_spin"]):
            pair = named[unit.get("pair")] if len(pairs) > 1 else pairs[0]
            pair = rotors[unit["rotor"]] if "rotor" in unit else pair
            self.pairs.append(pair)
            self.maps.append([list(zip(pair[key], TERMS[pair["basis"]])) for key in ("thrust_n", "torque_nm")])
            (x, y, z), (ax, ay, az) = unit["position_m"], unit.get("axis", [0.0, 0.0, -1.0])
            length = math.sqrt(ax * ax + ay * ay + az * az)
            ax, ay, az = ax / length, ay / length, az / length
            sign = 1.0 if unit["upper_spin"] == pair["upper_spin"] else -1.0
            # Torque of the force about the centre of gravity, and thrust along -z; reaction about the axis.
            columns_f.append([y * az - z * ay, z * ax - x * az, x * ay - y * ax, -az])
            columns_q.append([-sign * ax, -sign * ay, -sign * az, 0.0])
            self.channels.append(unit["channels"])
        self.units = len(self.channels)
        is_vertical = all(column[2] == 0.0 for column in columns_f)
        self.kappa = [self.torque_per_thrust(unit) for unit in range(self.units)]
        self.rotors = sum(map(len, self.channels))
        self.is_general = len(pairs) > 1 or bool(rotors) or self.units > 4 or not is_vertical or self.airmode == "roll-pitch-yaw"
        columns = columns_f + columns_q
        self.m = [[column[row] for column in columns] for row in range(4)]
        self.size = [self.largest(unit) for unit in range(self.units)]
        self.m_plus = self.pseudo_inverse()

    def pseudo_inverse(self):
        """D (M D)+ = D^2 M^T (M D^2 M^T)^-1 over the served rows, zero columns elsewhere (eq. (7)): of least norm in shares
        of a unit's largest thrust and torque, D."""
        served = [row for row in range(4) if self.axes[row]]
        squares = [size[k] * size[k] for k in (0, 1) for size in self.size]
        # A single rotor has one column, of its thrust with kappa times as much torque.
        n, m = self.units, [list(row) for row in self.m]
        for unit, kappa in enumerate(self.kappa):
            if kappa is not None:
                for row in m:
                    row[unit] += kappa * row[n + unit]
                    row[n + unit] = 0.0
        gram = [[sum(a * d * b for a, d, b in zip(m[i], squares, m[j])) for j in served] for i in served]
        inverse = invert(gram)
        result = [[0.0] * 4 for _ in range(2 * n)]
        for k in range(2 * n):
            for j, column in enumerate(served):
                result[k][column] = squares[k] * sum(m[i][k] * inverse[a][j] for a, i in enumerate(served))
        for unit, kappa in enumerate(self.kappa):
            if kappa is not None:
                result[n + unit] = [kappa * share for share in result[unit]]
        return result

    def torque_per_thrust(self, unit):
        """Of a single rotor at half of its largest thrust; None of a pair."""
        if len(self.channels[unit]) > 1:
            return None
        f, q = self.efforts(unit, self.throttle_of(unit, 0.5 * self.efforts(unit, self.high, 0.0)[0]), 0.0)
        return q / f

    def throttle_of(self, unit, thrust):
        """The throttle of a single rotor's thrust, by bisection, limited to the range."""
        low, high = self.low, self.high
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.efforts(unit, middle, 0.0)[0] < thrust else (low, middle)
        return low

    def least_norm(self, request, k):
        """The efforts of least norm, those of single rotors with their own torques."""
        n, asked = self.units, list(request)
        for _ in range(40):
            wanted = [sum(m * r for m, r in zip(row, asked)) for row in self.m_plus]
            singles = [unit for unit, kappa in enumerate(self.kappa) if kappa is not None]
            if not singles:
                return wanted
            asked = list(request)
            for unit in singles:
                torque = k[1] * self.efforts(unit, self.throttle_of(unit, wanted[unit] / k[0]), 0.0)[1]
                for axis in range(4):
                    asked[axis] -= self.m[axis][n + unit] * (torque - wanted[n + unit])
                wanted[n + unit] = torque
        return wanted

    def room(self, unit):
        """How far efforts may be from those of least norm."""
        near = 0.02 if any(kappa is not None for kappa in self.kappa) else 0.0
        return [max(1.001 * tolerance, near * size) for tolerance, size in zip(self.tolerance, self.size[unit])]

    def largest(self, unit):
        """The largest thrust and torque of a unit, which lie on the border of the box of throttles."""
        ends, along = (self.low, self.high), [self.low + (self.high - self.low) * k / 32 for k in range(33)]
        border = [self.efforts(unit, *at) for a in along for end in ends for at in ((a, end), (end, a))]
        return [max(abs(efforts[k]) for efforts in border) for k in (0, 1)]

    def efforts(self, unit, u, l):
        return [sum(c * u**i * l**j for c, (i, j) in terms) for terms in self.maps[unit]]

    def span(self, unit):
        """The largest torque of one rotor at full throttle, the other at idle."""
        return max(abs(self.efforts(unit, *at)[1]) for at in ((self.low, self.high), (self.high, self.low)))

    def full(self, unit):
        return abs(self.efforts(unit, self.high, self.high)[0])

    def given(self, unit, throttles, failed):
        """What a unit gives with the rotors of some channels out."""
        at = [throttles[channel] for channel in self.channels[unit]]
        out = [channel in failed for channel in self.channels[unit]]
        if len(at) == 1:
            return self.efforts(unit, *at, 0.0)
        if out[0] != out[1]:
            rotor = 0 if out[1] else 1
            # Of the rotor alone: a1 x + a2 x^2 + a3 x^3.
            alone = self.pairs[unit].get("upper_out" if rotor else "lower_out")
            if alone:
                keys = ("thrust_n", "torque_nm")
                return [sum(c * at[rotor] ** (k + 1) for k, c in enumerate(alone[key])) for key in keys]
        return self.efforts(unit, *at)

    def jacobian(self, unit, u, l):
        rows = []
        for terms in self.maps[unit]:
            by_u = sum(c * i * u ** (i - 1) * l**j for c, (i, j) in terms if i)
            by_l = sum(c * j * u**i * l ** (j - 1) for c, (i, j) in terms if j)
            rows.append((by_u, by_l))
        return rows

    def factors(self, volts, density=None):
        k = [1.0, 1.0]
        if self.voltage is not None:
            low, high = self.voltage["range_v"]
            volts = min(max(volts, low), high)
            k = [self.factor(quantity, volts) for quantity in ("thrust", "torque")]
        # A density that is none is the bench's.
        if self.air is not None and density is not None and 0.0 < density < math.inf:
            low, high = self.air["range_kg_m3"]
            ratio = min(max(density, low), high) / self.air["reference_density_kg_m3"]
            k = [factor * ratio ** self.exponent_of_density(q) for factor, q in zip(k, ("thrust", "torque"))]
        return k

    def exponent_of_density(self, quantity):
        """Thin air acts like a lower voltage: the exponent of the voltage less 1, where the file has none."""
        key = quantity + "_exponent"
        return self.air[key] if key in self.air else self.voltage[key] - 1.0

    def factor(self, quantity, volts):
        ratio = volts / self.voltage["reference_v"]
        if quantity + "_exponent" in self.voltage:
            return ratio ** self.voltage[quantity + "_exponent"]
        points = self.voltage[quantity + "_points"]
        for (v0, k0), (v1, k1) in zip(points, points[1:]):
            if volts <= v1:
                break
        return k0 + (k1 - k0) * (volts - v0) / (v1 - v0)

    def attains(self, unit, efforts):
        """True if some throttles within range give a unit these efforts at the reference voltage: damped Newton steps,
        projected on the box, from its middle and its corners."""
        if self.kappa[unit] is not None:
            return self.efforts(unit, self.low, 0.0)[0] <= efforts[0] <= self.efforts(unit, self.high, 0.0)[0]
        middle = 0.5 * (self.low + self.high)
        starts = [(middle, middle)] + [(u, l) for u in (self.low, self.high) for l in (self.low, self.high)]
        scale = self.size[unit]
        for u, l in starts:
            for _ in range(60):
                given = self.efforts(unit, u, l)
                missing = [want - got for want, got in zip(efforts, given)]
                size = max(abs(miss) / s for miss, s in zip(missing, scale))
                if size < 1e-11:
                    return True
                (a, b), (c, d) = self.jacobian(unit, u, l)
                det = a * d - b * c
                if det <= 0:
                    break
                du, dl = (missing[0] * d - missing[1] * b) / det, (missing[1] * a - missing[0] * c) / det
                step = min(1.0, 0.3 / max(abs(du), abs(dl), 1e-300))
                before = (u, l)
                u = min(max(u + step * du, self.low), self.high)
                l = min(max(l + step * dl, self.low), self.high)
                if (u, l) == before:  # a fixed point, at the border
                    break
        return False

    def bias(self, wanted, k):
        """What the torques c f (at the reference voltage) add to least-norm efforts: less what M+ makes of their wrench."""
        n = self.units
        wish = [0.0] * n + [k[1] * self.power_bias * wanted[i] / k[0] for i in range(n)]
        wrench = self.wrench(wish)
        return [w - sum(m * x for m, x in zip(row, wrench)) for w, row in zip(wish, self.m_plus)]

    def isolated_throttle(self, thrust):
        """d with f(d, 0) = thrust of the mean unit, by bisection, limited to the range."""
        pairs = [of for of, kappa in zip(self.maps, self.kappa) if kappa is None]
        alone = [(c / len(pairs), i) for thrust, _ in pairs for c, (i, j) in thrust if j == 0]
        low, high = self.low, self.high
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if sum(c * middle**i for c, i in alone) < thrust else (low, middle)
        return low

    def mean(self, throttle):
        """What the upper rotor of the mean unit gives alone."""
        each = [self.efforts(unit, throttle, 0.0) for unit in range(self.units) if self.kappa[unit] is None]
        return [sum(efforts[k] for efforts in each) / len(each) for k in (0, 1)]

    def wrench(self, efforts):
        return [sum(m * effort for m, effort in zip(row, efforts)) for row in self.m]


def invert(matrix):
    """Gauss-Jordan with partial pivoting."""
    n = len(matrix)
    rows = [list(row) + [float(i == j) for j in range(n)] for i, row in enumerate(matrix)]
    for column in range(n):
        pivot = max(range(column, n), key=lambda r: abs(rows[r][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        rows[column] = [value / rows[column][column] for value in rows[column]]
        for r in range(n):
            if r != column:
                factor = rows[r][column]
                rows[r] = [value - factor * above for value, above in zip(rows[r], rows[column])]
    return [row[n:] for row in rows]


def draw(airframe, count, seed):
    """A third wrenches of random throttles, a third ordinary ones about hover, a third far out."""
    source = random.Random(seed)
    low, high = airframe.voltage["range_v"] if airframe.voltage else (14.0, 14.0)
    n = airframe.units
    full, span = [airframe.full(i) for i in range(n)], [airframe.span(i) for i in range(n)]
    size = [sum(abs(row[i]) * full[i] + abs(row[n + i]) * span[i] for i in range(n)) for row in airframe.m]
    yield COLUMNS + ["voltage_v"]
    for index in range(count):
        volts = source.uniform(low - 0.5, high + 0.5)
        k_f, k_q = airframe.factors(volts)
        if index % 3 == 0:
            throttles = [[source.uniform(airframe.low, airframe.high) for _ in "ul"] for _ in range(n)]
            efforts = [airframe.efforts(unit, u, l) for unit, (u, l) in enumerate(throttles)]
            wrench = airframe.wrench([k_f * f for f, _ in efforts] + [k_q * q for _, q in efforts])
        elif index % 3 == 1:
            wrench = [source.gauss(0.0, 0.08) * s for s in size[:3]] + [source.uniform(0.05, 0.9) * size[3] * k_f]
        else:
            wrench = [source.uniform(-1.5, 1.5) * s for s in size[:3]] + [source.uniform(-0.3, 1.6) * size[3]]
        wrench = [value if served else 0.0 for value, served in zip(wrench, airframe.axes)]
        yield [repr(value) for value in wrench + [volts]]


def rounding(airframe, k):
    """What f32 arithmetic may add to each axis of the achieved wrench."""
    n = airframe.units
    full, torque = [airframe.full(i) * k[0] for i in range(n)], [airframe.span(i) * k[1] for i in range(n)]
    return [2e-6 * sum(abs(row[i]) * full[i] + abs(row[n + i]) * torque[i] for i in range(n)) + 1e-9 for row in airframe.m]


def has_room(airframe, wanted, shift, k):
    """Whether every unit could move by twice the largest shift of all either way, and by a little more of torque."""
    n = airframe.units
    torque = max(airframe.span(i) for i in range(n))
    by_q = 2.0 * max(map(abs, shift[n:])) / k[1] + 0.05 * torque
    by_f = 2.0 * max(map(abs, shift[:n])) / k[0]
    at = [[wanted[i] / k[0], wanted[n + i] / k[1]] for i in range(n)]
    return all(
        airframe.attains(i, [f + a * by_f, q + b * by_q]) for i, (f, q) in enumerate(at) for a in (-1, 1) for b in (-1, 1)
    )


def judge_row(airframe, request, conditions, throttles, achieved, saturation, failed):
    """Faults of one row, and whether its least-norm efforts are attainable. `conditions` are volts and density."""
    n = airframe.units
    k = airframe.factors(*conditions)
    faults = []
    if any(t != 0.0 if c in failed else not airframe.low <= t <= airframe.high for c, t in enumerate(throttles)):
        faults.append(f"a throttle leaves [{airframe.low}, {airframe.high}], or 0 where a rotor is out: {throttles}")
    given = [airframe.given(unit, throttles, failed) for unit in range(n)]
    efforts = [k[0] * f for f, _ in given] + [k[1] * q for _, q in given]
    truth = airframe.wrench(efforts)
    # Each fitted law, of the voltage and of the density, may be a millionth off.
    fitted = 2e-6 * max(1, (airframe.voltage is not None) + (airframe.air is not None))
    noise = [a + fitted * sum(abs(m * e) for m, e in zip(row, efforts)) for a, row in zip(rounding(airframe, k), airframe.m)]
    for axis, was, said, allowed in zip(AXES, truth, achieved, noise):
        if abs(was - said) > allowed:
            faults.append(f"achieved {axis} is {was!r}, the mixer says {said!r}")

    wanted = airframe.least_norm(request, k)
    attainable = not failed and all(airframe.attains(i, [wanted[i] / k[0], wanted[n + i] / k[1]]) for i in range(n))
    budget = [
        sum(abs(row[i]) * airframe.tolerance[0] + abs(row[n + i]) * airframe.tolerance[1] for i in range(n)) + 4 * allowed
        for row, allowed in zip(airframe.m, noise)
    ]
    if attainable:
        if airframe.power_bias != 0.0:
            shift = airframe.bias(wanted, k)
            # The share of the way by the torques alone: the thrusts of a tilted frame move by less than they are known.
            size = sum(part * part for part in shift[n:])
            way = sum((e - w) * part for e, w, part in zip(efforts[n:], wanted[n:], shift[n:]))
            share = min(max(way / size, 0.0), 1.0) if size > 0 else 0.0
            if share < 1.0 and size > 0 and has_room(airframe, wanted, shift, k):
                short = (1.0 - share) * max(map(abs, shift[n:]))
                if short > 1.001 * airframe.tolerance[1]:
                    faults.append(f"only {share:.3f} of the power bias though there is room for all")
            wanted = [w + share * part for w, part in zip(wanted, shift)]
        for i in range(n):
            off = [abs(efforts[i] - wanted[i]), abs(efforts[n + i] - wanted[n + i])]
            if any(miss > room for miss, room in zip(off, airframe.room(i))):
                faults.append(f"unit {i} is {off[0]:.3g} N, {off[1]:.3g} N m off its attainable least-norm efforts")
        for axis, asked, got, allowed in zip(AXES, request, truth, budget):
            if airframe.axes[AXES.index(axis)] and abs(asked - got) > allowed:
                faults.append(f"{axis} is {got!r}, attainable by least norm and asked {asked!r}")
        # A torque asked on an axis that the airframe does not serve is missed and flagged, whatever is delivered.
        served = sum(3 << 2 * axis for axis in range(4) if airframe.axes[axis])
        if saturation & served:
            faults.append(f"saturation {saturation} though the request was delivered")
    elif not failed:
        # What the general path gives of one axis for another, as a share of what all units have.
        share = 3e-3 if airframe.is_general else 0.0
        most = [
            sum(abs(row[i]) * airframe.size[i][0] + abs(row[n + i]) * airframe.size[i][1] for i in range(n)) for row in airframe.m
        ]
        room = [allowed + share * size for allowed, size in zip(budget, most)]
        for axis in range(3):
            if not airframe.axes[axis]:
                continue
            asked, got = request[axis], truth[axis]
            if got * math.copysign(1.0, asked) < -room[axis]:
                faults.append(f"{AXES[axis]} reverses: {asked!r} asked, {got!r} given")
            if abs(got) > abs(asked) + room[axis]:
                faults.append(f"{AXES[axis]} overshoots: {asked!r} asked, {got!r} given")
        if airframe.axes[0] and airframe.axes[1]:
            length = math.hypot(request[0], request[1])
            if length > 0:
                turned = abs(truth[0] * request[1] - truth[1] * request[0]) / length
                if turned > room[0] + room[1]:
                    faults.append(f"(roll, pitch) turns by {turned!r} N m: {request[:2]} asked, {truth[:2]} given")
        floor = k[0] * sum(airframe.efforts(i, airframe.low, airframe.low)[0] for i in range(n))
        # Room for the torque at idle, which must be balanced before the thrust counts as least.
        if airframe.airmode == "disabled" and truth[3] > max(request[3], 1.25 * floor) + room[3]:
            faults.append(f"thrust is raised from {request[3]!r} to {truth[3]!r}")
    for axis in range(4):
        missing = request[axis] - truth[axis]
        for bit, missed in ((1 << 2 * axis, missing), (2 << 2 * axis, -missing)):
            if missed > 1.1 * budget[axis] and not saturation & bit:
                faults.append(f"{AXES[axis]} misses {missed!r} without a flag")
            # The bound that is proven, from which on misses are flagged, is not in the file: below the tolerance.
            if missed < 0.05 * budget[axis] - 8 * noise[axis] and saturation & bit:
                faults.append(f"{AXES[axis]} misses {missed!r} only and is flagged")
    laws = (airframe.voltage, "range_v", 256), (airframe.air, "range_kg_m3", 512)
    for value, (law, key, flag) in zip(conditions, laws):
        if law and value is not None:
            low, high = law[key]
            is_at_an_end = min(abs(value - low), abs(value - high)) <= 1e-5
            if not is_at_an_end and (not low <= value <= high) != bool(saturation & flag):
                faults.append(f"{key}: {value} and saturation {saturation} do not agree")
    return faults, attainable


def judge(airframe, setpoints_path, mixed_path, failed=()):
    with open(setpoints_path, newline="") as file:
        setpoints = list(csv.DictReader(file))
    with open(mixed_path, newline="") as file:
        mixed = list(csv.DictReader(file))
    faults, delivered = [], 0
    if len(setpoints) != len(mixed):
        faults.append(f"{len(setpoints)} setpoints, {len(mixed)} answers")
    for index, (asked, row) in enumerate(zip(setpoints, mixed)):
        request = [float(asked[column]) for column in COLUMNS]
        conditions = float(asked["voltage_v"]), float(asked["density_kg_m3"]) if "density_kg_m3" in asked else None
        throttles = [float(row[f"throttle_{channel}"]) for channel in range(airframe.rotors)]
        achieved = [float(row["achieved_" + column]) for column in COLUMNS]
        found, attainable = judge_row(airframe, request, conditions, throttles, achieved, int(row["saturation"]), failed)
        delivered += attainable
        faults += [f"row {index + 2}: {fault}" for fault in found]
    print(f"{len(mixed)} rows, {delivered} with attainable least-norm efforts, {len(faults)} faults")
    for fault in faults[:40]:
        print(fault)
    return 1 if faults else 0


class Isolated:
    """A frame of isolated rotors, all upper ones first: each with the upper one's f(d, 0), torque Q = kappa f of
    either sign, least norm over the 2n thrusts."""

    def __init__(self, airframe):
        self.airframe = airframe
        n = airframe.units
        grid = [airframe.low + (airframe.high - airframe.low) * i / 50 for i in range(51)]
        alone = [airframe.mean(d) for d in grid]
        kappa = sum(abs(q) * f for f, q in alone) / sum(f * f for f, _ in alone)
        # Rotor columns: a unit's upper rotor turns against its lower one.
        self.columns = []
        for layer in (-1.0, 1.0):
            for i in range(n):
                thrust, torque = [row[i] for row in airframe.m], [row[n + i] for row in airframe.m]
                is_there = layer < 0.0 or airframe.kappa[i] is None
                self.columns.append([is_there * (f + layer * kappa * q) for f, q in zip(thrust, torque)])
        served = [row for row in range(4) if airframe.axes[row]]
        gram = [[sum(c[i] * c[j] for c in self.columns) for j in served] for i in served]
        inverse = invert(gram)
        self.rows = [[0.0] * 4 for _ in self.columns]
        for row, column in zip(self.rows, self.columns):
            for a, axis in enumerate(served):
                row[axis] = sum(column[i] * inverse[b][a] for b, i in enumerate(served))
        self.bounds = [airframe.mean(airframe.low)[0], airframe.mean(airframe.high)[0]]

    def thrusts(self, request):
        return [sum(share * value for share, value in zip(row, request)) for row in self.rows]

    def vector(self, axis):
        """PX4's normalised column of the mix matrix (ControlAllocationPseudoInverse)."""

        def column(index):
            return [row[index] for row in self.rows]

        def rms(values):
            shares = [v for v in values if abs(v) > 1e-9]
            return math.sqrt(sum(v * v for v in shares) / (len(shares) / 2)) if shares else 0.0

        if axis < 2:
            scale = max(rms(column(0)), rms(column(1)))
        elif axis == 2:
            scale = max(map(abs, column(2)))
        else:
            shares = [abs(v) for v in column(3) if abs(v) > 1e-9]
            scale = sum(shares) / len(shares)
        return [v / scale if scale > 0 else 0.0 for v in column(axis)]

    def slide(self, thrusts, axis, bounds, only_down=False):
        """ControlAllocationSequentialDesaturation::desaturateActuators."""
        vector = self.vector(axis)
        for factor in (1.0, 0.5):
            gains = [0.0]
            for value, share in zip(thrusts, vector):
                if abs(share) >= 0.2:
                    gains += [(bounds[0] - value) / share] if value < bounds[0] else []
                    gains += [(bounds[1] - value) / share] if value > bounds[1] else []
            gain = factor * (min(gains) + max(gains))
            if factor == 1.0 and only_down and gain > 0:
                return thrusts
            thrusts = [value + gain * share for value, share in zip(thrusts, vector)]
        return thrusts

    def sequential(self, request, airmode):
        """mixAirmodeDisabled, mixAirmodeRP, mixAirmodeRPY and mixYaw."""
        roll, pitch, yaw, thrust = request
        if airmode == "roll-pitch-yaw":
            thrusts = self.slide(self.thrusts(request), 3, self.bounds)
            return self.slide(thrusts, 2, self.bounds)
        thrusts = self.slide(self.thrusts([roll, pitch, 0.0, thrust]), 3, self.bounds, airmode == "disabled")
        if airmode == "disabled":
            thrusts = self.slide(self.slide(thrusts, 0, self.bounds), 1, self.bounds)
        thrusts = [a + b for a, b in zip(thrusts, self.thrusts([0.0, 0.0, yaw, 0.0]))]
        low, high = self.bounds
        thrusts = self.slide(thrusts, 2, [low, high + 0.15 * (high - low)])
        return self.slide(thrusts, 3, self.bounds, True)


def setpoints(airframe, path):
    """Requests of a CSV file with the voltage's [k_f, k_Q]."""
    with open(path, newline="") as file:
        for asked in csv.DictReader(file):
            volts = float(asked.get("voltage_v") or (airframe.voltage or {"reference_v": 0.0})["reference_v"])
            yield [float(asked[column]) for column in COLUMNS], airframe.factors(volts)


def isolated_throttles(airframe, method, setpoints_path):
    """Throttle per channel of a mixer that takes all rotors as isolated: `conventional` or, desaturated after PX4,
    an airmode."""
    n = airframe.units
    isolated = Isolated(airframe)
    rotors = [(k * n + i, of[k]) for k in (0, 1) for i, of in enumerate(airframe.channels) if k < len(of)]
    yield [f"throttle_{channel}" for channel in range(airframe.rotors)]
    for request, k in setpoints(airframe, setpoints_path):
        request = [value / k[0] for value in request]
        thrusts = isolated.thrusts(request) if method == "conventional" else isolated.sequential(request, method)
        row = [0.0] * airframe.rotors
        for rotor, channel in rotors:
            row[channel] = airframe.isolated_throttle(thrusts[rotor])
        yield [f"{throttle:.7f}" for throttle in row]


def main(arguments):
    match arguments:
        case ["isolated", path, method, setpoints_path]:
            rows = isolated_throttles(Airframe(path), method, setpoints_path)
            csv.writer(sys.stdout, lineterminator="\n").writerows(rows)
            return 0
        case ["draw", path, count, seed]:
            csv.writer(sys.stdout, lineterminator="\n").writerows(draw(Airframe(path), int(count), int(seed)))
            return 0
        case ["judge", path, setpoints_path, mixed_path]:
            return judge(Airframe(path), setpoints_path, mixed_path)
        case ["judge", path, setpoints_path, mixed_path, failed]:
            return judge(Airframe(path), setpoints_path, mixed_path, {int(channel) for channel in failed.split(",")})
        case _:
            print(__doc__, file=sys.stderr)
            return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
