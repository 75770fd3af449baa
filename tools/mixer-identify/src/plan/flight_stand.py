#!/usr/bin/env python3
"""Throttle pairs of a coaxial pair of rotors, by cargo mixer plan @VERSION@.

For the Flight Stand software, which stays open. Needs grpcio, protobuf and, on PYTHONPATH, languages/python of
https://gitlab.com/TytoRobotics/flightstand-api. Without arguments it lists the boards. Then, for example:

    python3 plan.py --upper /boards/COM3 --lower /boards/COM4 -o map.csv

where several boards of one rotor (force, power) stand behind commas. Set the software's own limits first. Check that both
rotors turn the right way and that the stand is clear. The log goes to cargo mixer identify.
"""
import argparse
import csv
import sys
import time

import flight_stand_api_v1_pb2 as fs
import flight_stand_api_v1_pb2_grpc as fs_grpc
import grpc
from google.protobuf.field_mask_pb2 import FieldMask

PAIRS = [                      # throttles: upper, lower
@PAIRS@
]
LOW, HIGH = @LOW@, @HIGH@          # output values of throttle 0, at rest, and 1
RAMP_S = 1.0                   # from one pair to the next
SETTLE_S = 2.0                 # before each measurement
SAMPLES, SAMPLE_S = 40, 0.05   # averaged per pair

QUANTITIES = {                 # column, and what the software calls it
    "thrust_n": fs.FORCE_FZ,
    "torque_nm": fs.TORQUE_MZ,
    "voltage_v": fs.VOLTAGE_HV_INPUT,
    "current_a": fs.CURRENT_HALL_CURRENT,
}


class Rotor:
    """The boards of one rotor."""

    def __init__(self, stub, name, boards):
        self.stub, self.throttle = stub, 0.0

        def of(items):
            return [item for item in items if item.name.startswith(tuple(board + "/" for board in boards))]

        escs = [o for o in of(stub.ListOutputs(fs.ListOutputsRequest()).outputs) if o.output_type == fs.ESC]
        if len(escs) != 1:
            sys.exit(f"--{name}: {len(escs)} ESC outputs on {', '.join(boards)}, not one")
        self.output = escs[0].name
        inputs = of(stub.ListInputs(fs.ListInputsRequest()).inputs)
        self.signals = {}
        for column, kind in QUANTITIES.items():
            names = [i.signal_name for i in inputs if i.input_type == kind]
            if not names and kind in (fs.FORCE_FZ, fs.TORQUE_MZ):
                sys.exit(f"--{name}: no input for {column} on {', '.join(boards)}")
            self.signals[column] = names[0] if names else None

    def set(self, throttle, active=True):
        target = fs.OutputTarget(active=active, target_value=LOW + throttle * (HIGH - LOW))
        output = fs.Output(name=self.output, output_target=target)
        self.stub.UpdateOutput(fs.UpdateOutputRequest(output=output, mask=FieldMask(paths=["output_target"])))
        self.throttle = throttle


def ramp(rotors, throttles):
    begin = [rotor.throttle for rotor in rotors]
    for step in range(1, 21):
        for rotor, a, b in zip(rotors, begin, throttles):
            rotor.set(a + (b - a) * step / 20)
        time.sleep(RAMP_S / 20)


def measure(stub, rotors):
    """Means of every signal; None where nothing was measured."""
    names = [[rotor.signals[column] for rotor in rotors] for column in QUANTITIES]
    sums = {name: [0.0, 0] for both in names for name in both if name}
    for _ in range(SAMPLES):
        for sample in stub.ListSamples(fs.ListSamplesRequest()).sample_group.samples:
            if sample.signal_name in sums and sample.active:
                sums[sample.signal_name][0] += sample.value
                sums[sample.signal_name][1] += 1
        time.sleep(SAMPLE_S)
    means = {name: total / count for name, (total, count) in sums.items() if count}
    return [means.get(name) for both in names for name in both]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--upper", metavar="BOARD[,BOARD]")
    parser.add_argument("--lower", metavar="BOARD[,BOARD]")
    parser.add_argument("-o", "--output", metavar="CSV")
    parser.add_argument("--address", default="localhost:50051", help="where the software listens [%(default)s]")
    args = parser.parse_args()
    stub = fs_grpc.FlightStandStub(grpc.insecure_channel(args.address))
    if not (args.upper and args.lower and args.output):
        for board in stub.ListBoards(fs.ListBoardsRequest()).boards:
            print(board.name, board.display_name)
        sys.exit("name the boards by --upper and --lower, and the log by -o")
    rotors = [Rotor(stub, name, boards.split(",")) for name, boards in [("upper", args.upper), ("lower", args.lower)]]
    with open(args.output, "x", newline="") as file:
        log = csv.writer(file)
        sides = [f"{side}_{column}" for column in QUANTITIES for side in ("upper", "lower")]
        log.writerow(["upper", "lower", *sides])
        stub.TareInputs(fs.TareInputsRequest())
        try:
            for rotor in rotors:
                rotor.set(0.0)
            time.sleep(4.0)
            for number, pair in enumerate(PAIRS, 1):
                print(f"pair {number} of {len(PAIRS)}: {pair}")
                ramp(rotors, pair)
                time.sleep(SETTLE_S)
                log.writerow([*pair, *measure(stub, rotors)])
                file.flush()
            ramp(rotors, [0.0, 0.0])
        finally:
            # Also where it is interrupted: no signal, no thrust.
            for rotor in rotors:
                rotor.set(0.0, active=False)


main()
