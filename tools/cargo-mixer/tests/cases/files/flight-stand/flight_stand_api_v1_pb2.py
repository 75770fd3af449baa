"""The Flight Stand software as the script of `cargo mixer plan` sees it: a board per rotor, the lower one mounted
upside down, and the paper's pair behind them."""
import time
from types import SimpleNamespace as Any

clock = 0.0
def sleep(seconds):
    global clock
    clock += seconds
time.sleep = sleep

FORCE_FZ, TORQUE_MZ, VOLTAGE_HV_INPUT, CURRENT_HALL_CURRENT, ESC = 11, 14, 6, 8, 1
OutputTarget = Output = UpdateOutputRequest = Any
ListOutputsRequest = ListInputsRequest = ListSamplesRequest = ListBoardsRequest = TareInputsRequest = Any
NAMES = ["/boards/A", "/boards/B"]
pulses = {name: None for name in NAMES}

class FlightStandStub:
    def __init__(self, channel):
        pass

    def ListBoards(self, _):
        return Any(boards=[Any(name=name, display_name="simulated") for name in NAMES])

    def ListOutputs(self, _):
        return Any(outputs=[Any(name=name + "/outputs/0", output_type=ESC) for name in NAMES])

    def ListInputs(self, _):
        kinds = [FORCE_FZ, TORQUE_MZ, VOLTAGE_HV_INPUT, CURRENT_HALL_CURRENT]
        return Any(inputs=[
            Any(name=f"{name}/inputs/{kind}", input_type=kind, signal_name=f"{name}:{kind}")
            for name in NAMES for kind in kinds])

    def TareInputs(self, _):
        assert all(pulse is None for pulse in pulses.values())

    def UpdateOutput(self, request):
        assert request.mask.paths == ["output_target"]
        target = request.output.output_target
        board = request.output.name.removesuffix("/outputs/0")
        now, last = target.target_value, pulses[board]
        assert 1100 <= now <= 1900 and (last is None or abs(now - last) < 41), (last, now)
        pulses[board] = now if target.active else None
        if not target.active:
            print("stopped", board, now)

    def ListSamples(self, _):
        u, l = [(pulses[name] - 1100) / 800 for name in NAMES]
        powers = [u*u*l*l, u*u*l, u*u, u*l*l, u*l, u, l*l, l]
        f, q = [sum(c * x for c, x in zip(of, powers)) for of in ([5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.764, 12.2092, 0.2363], [-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.072])]
        values = [
            (f / 2, q - 0.1 * l, 14.8, 20 * u**3),
            (-f / 2, 0.1 * l, 14.6, 18 * l**3)]
        kinds = [FORCE_FZ, TORQUE_MZ, VOLTAGE_HV_INPUT, CURRENT_HALL_CURRENT]
        return Any(sample_group=Any(samples=[
            Any(signal_name=f"{name}:{kind}", value=value, active=True)
            for name, of in zip(NAMES, values) for kind, value in zip(kinds, of)]))
